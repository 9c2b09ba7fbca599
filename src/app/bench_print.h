// The output of `roil bench` on the terminal.
#pragma once
#include "bench/sweep.h"

int bench_label_width(const sweep_row *rows, size_t count);
void bench_print_line(const bench_row *row, int width); // a row that was just measured
void bench_print_table(const bench_results *r);
// Prints the ratio of every row's time, and of the passes that changed by more than noise. Returns
// how many rows became slower.
size_t bench_print_changes(const bench_results *before, const bench_results *now, double margin);
