// Conversion of results to and from JSON and CSV.
#pragma once
#include "bench/results.h"
#include <jansson.h>

json_t *bench_to_tree(const bench_results *r); // json_decref()
char *bench_to_json(const bench_results *r);   // mem_free(); NULL: a text cannot be written in JSON
// Reads results from a tree. False with a message that names `file` when anything differs from what
// bench_to_tree writes. `out` must be empty; on failure it is filled in part.
bool bench_from_json(const json_t *root, const char *file, bench_results *out);
bool bench_write_csv(const bench_results *r, const char *folder);
