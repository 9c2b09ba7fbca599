// The report of a sweep: report.html, one page with tables, plots and pictures. It needs no other
// file, no network and no JavaScript.
#pragma once
#include "bench/results.h"

// Writes `folder`/report.html; thumbnails are taken from `folder`. `home`: the folder that holds
// scripts/report. False with a message.
bool bench_report(const bench_results *r, const char *folder, const char *home);
