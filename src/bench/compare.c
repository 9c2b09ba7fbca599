// Compares two runs of a sweep: what became faster or slower by more than noise.
#include "base/memory.h"
#include "base/statistics.h"
#include "bench/sweep.h"
#include <string.h>

enum { FEWEST = 8 }; // frames that the signed-rank test can tell 1 of 100 by
static const double CHANCE = 0.01;

static bool same_frames(const bench_row *a, const bench_row *b) {
    return a->frame_count == b->frame_count && a->repeats == b->repeats && a->frame_count > 0 &&
           memcmp(a->frames, b->frames, a->frame_count * sizeof *a->frames) == 0;
}

static bool has_pairs(const bench_change *c, const bench_figure *a, const bench_figure *b) {
    return a->values && b->values && a->count == b->count && a->count >= FEWEST &&
           same_frames(c->before, c->now);
}

static double chance_of(const bench_figure *a, const bench_figure *b) {
    double *differences = mem_alloc(a->count * sizeof *differences);
    for (size_t i = 0; i < a->count; i++) differences[i] = b->values[i] - a->values[i];
    double chance = stats_signed_rank(differences, a->count);
    mem_free(differences);
    return chance;
}

static void change_judge(bench_change *c, const bench_figure *before, const bench_figure *now,
                         double margin) {
    c->ratio = before->median > 0 ? now->median / before->median : 1;
    c->chance = has_pairs(c, before, now) ? chance_of(before, now) : -1;
    bool apart =
        c->chance >= 0 ? c->chance < CHANCE : now->p5 > before->p95 || now->p95 < before->p5;
    if (apart && c->ratio > 1 + margin) c->verdict = BENCH_SLOWER;
    if (apart && c->ratio < 1 / (1 + margin)) c->verdict = BENCH_FASTER;
}

// Returns the row with the same values of the axes; numbers of rows differ when a sweep has grown.
static const bench_row *find_match(const bench_results *r, const bench_row *row) {
    for (size_t i = 0; i < r->row_count; i++) {
        const bench_row *other = &r->rows[i];
        bool same = other->axes.count == row->axes.count && other->width == row->width &&
                    other->height == row->height;
        for (size_t k = 0; same && k < row->axes.count; k++) {
            const char *value = bench_axis_value(other, row->axes.items[k].name);
            same = value && strcmp(value, row->axes.items[k].value) == 0;
        }
        if (same) return other;
    }
    return NULL;
}

typedef struct changes {
    bench_change *items;
    size_t count, capacity;
} changes;

static void add_times(changes *all, const bench_row *before, const bench_row *now,
                      const bench_times *a, const bench_times *b, double margin) {
    for (size_t i = 0; i < b->count; i++) {
        const bench_figure *old = bench_get_time(a, b->items[i].name);
        if (!old) continue;
        bench_change c = {.before = before, .now = now, .name = b->items[i].name};
        change_judge(&c, old, &b->items[i].ms, margin);
        *MEM_ADD(all->items, all->count, all->capacity) = c;
    }
}

size_t bench_compare(const bench_results *before, const bench_results *now, double margin,
                     arena *memory, bench_change **out) {
    changes all = {0};
    for (size_t i = 0; i < now->row_count; i++) {
        const bench_row *row = &now->rows[i], *old = find_match(before, row);
        if (!old || old->state != BENCH_DONE || row->state != BENCH_DONE) continue;
        add_times(&all, old, row, &old->gpu, &row->gpu, margin);
        add_times(&all, old, row, &old->times, &row->times, margin);
    }
    *out = arena_copy(memory, all.items, all.count * sizeof *all.items);
    mem_free(all.items);
    return all.count;
}
