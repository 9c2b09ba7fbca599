// results.json of strangers: what is taken is written as a file that is taken again and says the
// same; all else has a message.
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "bench/json.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require_clean(const bench_results *r) {
    for (const char *at = r->title; *at; at++)
        if (iscntrl((unsigned char)*at) && *at != '\n') abort();
    for (size_t i = 0; i < r->row_count; i++) {
        const bench_row *row = &r->rows[i];
        if (row->index >= BENCH_MAX_ROWS || row->state == BENCH_PLANNED) abort();
        if (row->thumbnail && (strstr(row->thumbnail, "..") || row->thumbnail[0] == '/')) abort();
        bench_main_time(row);
    }
}

static char *again(const char *text) {
    bench_results r = {0};
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    if (!root || !bench_from_json(root, "again", &r)) abort();
    json_decref(root);
    char *printed = bench_to_json(&r);
    bench_results_free(&r);
    return printed;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bench_results r = {0};
    json_t *root = json_loadb((const char *)data, size, JSON_REJECT_DUPLICATES, NULL);
    if (!root) return 0;
    err_clear();
    if (bench_from_json(root, "file", &r)) {
        require_clean(&r);
        char *one = bench_to_json(&r), *two = one ? again(one) : NULL;
        if (!two || strcmp(one, two) != 0) abort();
        mem_free(one);
        mem_free(two);
    } else if (!err_get()[0]) {
        abort();
    }
    json_decref(root);
    bench_results_free(&r);
    return 0;
}
