// Whole sweeps: which of their rows, one after the other, with results that are written as they
// come.
#pragma once
#include "bench/run.h"
#include "script/sweep.h"

typedef struct bench_choice { // zero: all rows
    const char *rows;         // pattern of labels (*, ?, [..]); NULL: any
    const roil_setting *only; // axis (name or label) and value; of one axis any of those that are
    size_t only_count;        // named will do
    uint32_t shard, shards;   // 1 of 4; 0: all
} bench_choice;

// True for each row that is chosen, mem_free; NULL with a message on an axis or a value that the
// sweep does not have, or when nothing is left.
bool *bench_choose(const sweep *s, const bench_choice *choice);

typedef struct bench_watcher {                                  // all may be NULL
    void (*begin)(void *user, const sweep *s, size_t total);    // of rows that are to be measured
    void (*row)(void *user, const bench_row *row, size_t done); // `row` is next; `done` before it
    void (*result)(void *user, const bench_row *row, size_t done);
    bool (*stopped)(void *user);
    void (*steps)(void *user, double done, double whole); // as roil_on_progress tells of them
    void *user;
} bench_watcher;

typedef struct bench_order {
    const char *file, *folder, *device; // the sweep; where results go; as roil_desc has it
    const char *memory;                 // as roil_desc has it
    sweep_options options;
    bench_choice choice;
    bool resume; // keeps the rows that `folder` has, if they are of the same sweep and device
    bench_watcher watcher;
} bench_order;

// Fills `out`, which holds what was measured also when it ends before all is done: false then, with
// a message. bench_results_free it either way.
bool bench_run(const bench_order *order, bench_results *out);

// Reads the sweep of an order; needs no device. `memory` holds it.
bool bench_read_sweep(const bench_order *order, arena *memory, sweep *out);

// One sweep measured in parts (shards, choices), put together in `folder`.
bool bench_merge(const char *const *folders, size_t count, const char *folder, bench_results *out);

// ---- comparing two runs -------------------------------------------------------------------------

typedef enum bench_verdict {
    BENCH_SAME,   // within the noise
    BENCH_FASTER, // outside of it
    BENCH_SLOWER,
} bench_verdict;

typedef struct bench_change {
    const bench_row *before, *now;
    const char *name; // of a pass, "all", or another time
    double ratio;     // of medians, now to before
    double chance;    // of such a difference by noise alone; below 0: not known
    bench_verdict verdict;
} bench_change;

// All times of all rows that both have, matched by their axes; in `memory`.
//
// Where both kept the same frames, 8 or more, differences frame by frame are put to the signed-rank
// test (base/statistics.h): a time has changed when they arise by chance in less than 1 of 100
// cases. Else when the two bands from the 5th to the 95th percentile do not meet. And in both cases
// only when the medians are apart by more than `margin` (0.03 is 3 %): what clocks and neighbours
// shift from run to run is not in the frames of one.
size_t bench_compare(const bench_results *before, const bench_results *now, double margin,
                     arena *memory, bench_change **out);

// ---- the machine --------------------------------------------------------------------------------

void bench_describe_machine(bench_results *r); // cpu, cores, os, date
// First digits of the commit that `home` says in its file `commit` (scripts/package) or has checked
// out; "" when it does neither.
const char *bench_commit(const char *home, arena *memory);
