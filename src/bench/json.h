// The parts of results as text.
#pragma once
#include "bench/results.h"
#include <jansson.h>

json_t *bench_to_tree(const bench_results *r); // json_decref()
char *bench_to_json(const bench_results *r);   // free(); NULL: cannot be said in JSON
// What is not as it is written is an error that names `file`; `out` must be empty, and is filled in
// part when it fails.
bool bench_from_json(const json_t *root, const char *file, bench_results *out);
bool bench_write_csv(const bench_results *r, const char *folder);
