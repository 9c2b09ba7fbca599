// Collects measured values by name, and summarises them.
#include "base/memory.h"
#include "base/statistics.h"
#include "base/str.h"
#include "bench/run_parts.h"
#include <string.h>

enum { MAX_KEPT = 256 }; // values that a file keeps: enough for a rank test

void bench_collect(bench_collection *c, const char *name, double value) {
    size_t i = 0;
    while (i < c->count && strcmp(c->items[i].name, name) != 0) i++;
    if (i == c->count) {
        MEM_RESERVE(c->items, c->count + 1, c->capacity);
        c->items[c->count] = (bench_series){0};
        str_copy(c->items[c->count++].name, sizeof c->items->name, name);
    }
    bench_series *s = &c->items[i];
    *MEM_ADD(s->values, s->count, s->capacity) = value;
}

bench_times bench_summarise(const bench_collection *c, arena *memory) {
    bench_times t = {arena_alloc(memory, c->count * sizeof *t.items), c->count};
    for (size_t i = 0; i < c->count; i++) {
        const bench_series *s = &c->items[i];
        const double *values = arena_copy(memory, s->values, s->count * sizeof *values);
        double *sorted = mem_copy(s->values, s->count * sizeof *sorted);
        stats_summary m = stats_summarise(sorted, s->count);
        mem_free(sorted);
        t.items[i] =
            (bench_time){arena_string(memory, s->name),
                         {m.median, m.p5, m.p95, s->count, s->count <= MAX_KEPT ? values : NULL}};
    }
    return t;
}

void bench_collection_free(bench_collection *c) {
    for (size_t i = 0; i < c->count; i++) mem_free(c->items[i].values);
    mem_free(c->items);
    *c = (bench_collection){0};
}
