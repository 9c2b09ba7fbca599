// Measures sweeps: chooses rows, measures them one after the other, and writes the results after
// each.
#pragma once
#include "bench/run.h"
#include "script/sweep.h"

typedef struct bench_choice { // zero: all rows
    const char *rows;         // pattern of labels (*, ?, [..]); NULL: any
    const roil_setting *only; // axis (name or label) and value; several values of one axis are
    size_t only_count;        // alternatives
    uint32_t shard, shards;   // 1 of 4; 0: all rows
} bench_choice;

// Returns an array that is true for each chosen row; free it with mem_free. NULL with a message for
// an axis or a value that the sweep does not have, or when no row is left.
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
    const char *file, *folder, *device; // the sweep; folder of the results; as in roil_desc
    const char *memory;                 // as in roil_desc
    sweep_options options;
    bench_choice choice;
    bool resume; // keeps the rows in `folder`, if they are of the same sweep and device
    bench_watcher watcher;
} bench_order;

// Measures a sweep. False with a message when it ends early; `out` then has the rows measured so
// far. Free it with bench_results_free in either case.
bool bench_run(const bench_order *order, bench_results *out);

// Reads the sweep of an order into `memory`. Needs no device.
bool bench_read_sweep(const bench_order *order, arena *memory, sweep *out);

// Combines results of one sweep that was measured in parts (shards, choices) in `folder`.
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
    double chance;    // probability of such a difference by noise alone; below 0: unknown
    bench_verdict verdict;
} bench_change;

// Compares all times of the rows that both have, matched by their axes. The result is in `memory`.
//
// Where both have the same 8 or more frames, the differences frame by frame are tested by the
// signed-rank test (base/statistics.h): a time has changed when they arise by chance in less than 1
// of 100 cases. Else it has changed when the ranges from the 5th to the 95th percentile do not
// overlap. In both cases the medians must differ by more than `margin` (0.03 is 3 %), since clocks
// and other programs change times from run to run, which the frames of one run do not show.
size_t bench_compare(const bench_results *before, const bench_results *now, double margin,
                     arena *memory, bench_change **out);

// ---- the machine --------------------------------------------------------------------------------

void bench_describe_machine(bench_results *r); // cpu, cores, os, date
// Returns the first digits of the commit in the file `commit` of `home` (scripts/package), or of
// the one checked out there; "" when there is neither.
const char *bench_commit(const char *home, arena *memory);
