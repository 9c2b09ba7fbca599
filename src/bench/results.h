// Results of a sweep: what was measured, row by row, in memory and as files.
//
// results.json is what everything else is made of (CSV, reports, comparisons, further rows), and
// strangers may have written it: whatever a file contains, reading gives sound results or a
// message.
#pragma once
#include "base/arena.h"
#include "roil.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { BENCH_MAX_ROWS = 4096, BENCH_MAX_AXES = 16, BENCH_MAX_VALUES = 4096 };

typedef struct bench_figure {
    double median, p5, p95; // percentiles by nearest rank
    size_t count;
    const double *values; // as they were measured, in order; NULL: not kept
} bench_figure;

typedef struct bench_time {
    const char *name;
    bench_figure ms;
} bench_time;

typedef struct bench_times {
    bench_time *items;
    size_t count;
} bench_times;

typedef struct bench_number {
    const char *name;
    double value;
} bench_number;

typedef struct bench_numbers {
    bench_number *items;
    size_t count;
} bench_numbers;

typedef struct bench_settings {
    roil_setting *items;
    size_t count;
} bench_settings;

typedef enum bench_state {
    BENCH_PLANNED, // not measured; never stands in a file
    BENCH_DONE,
    BENCH_FAILED,
    BENCH_LIMIT, // stopped because it took longer than it may; what was measured is there
} bench_state;

typedef struct bench_row {
    // What is measured.
    size_t index; // in the whole sweep
    const char *label;
    bench_settings axes; // by name; values as text
    const char *effect;  // file
    const char *inside;  // of a sweep: the folder that it must lie in when it is opened, else NULL
    uint32_t width, height;
    double *frames;
    size_t frame_count;
    uint32_t warmup, repeats;
    double limit; // seconds; 0: none
    bench_settings settings;
    // What came out.
    bench_state state;
    const char *message; // of BENCH_FAILED, BENCH_LIMIT; else ""
    bench_times gpu;     // by pass, "all" last
    // Of a frame: until it is "submit"ted and drawn ("frame"), by the clock; processor time of the
    // thread that submits it ("host") and of all threads until it is drawn ("process").
    bench_times cpu;
    bench_times times; // of other measures: "reload", "take_over", "start"
    bench_numbers counters;
    uint64_t device_bytes, reserved_bytes, host_bytes;
    bool compared;           // the three below are there, of the worst frame
    double psnr, ssim, flip; // psnr INFINITY: equal
    const char *thumbnail;   // PNG, relative to the folder of the results; NULL: none
    bench_numbers published; // what others report for this row, milliseconds
} bench_row;

typedef struct bench_axis {
    const char *name, *label;
    const char **values;
    size_t value_count;
} bench_axis;

typedef struct bench_reference { // what pictures are compared with
    bool traced;                 // path traced; else a row with other settings
    uint32_t samples;            // a pixel, when it is traced
    bench_settings settings;
} bench_reference;

typedef struct bench_results {
    arena memory;                 // holds all that the rest points to
    const char *version, *commit; // of roil; "" when it is not known
    const char *sweep, *title, *file;
    const char *content; // hash of what is to be measured: equal for parts of one sweep
    const char **notes;
    size_t note_count;
    const char *device, *driver;
    const char *cpu, *os; // of the machine
    uint32_t cores;
    const char *date; // ISO 8601, of the start
    bench_axis *axes;
    size_t axis_count;
    bool has_reference;
    bench_reference reference;
    bool tuned;            // of a search (tune.h), these are two of its rows:
    size_t before, chosen; // their indices
    bool by_process;       // which went by processor time: the device is the processor
    bench_row *rows;       // by rising index; only those that were measured
    size_t row_count, row_capacity;
} bench_results;

void bench_results_free(bench_results *r); // zero is fine

// `folder`/results.json. False with a message that names the file and what is wrong in it; `out` is
// then empty.
bool bench_read(const char *folder, bench_results *out);
bool bench_read_file(const char *file, bench_results *out);
// Writes results.json and results.csv, each at once: a reader sees the old or the new one.
bool bench_write(const bench_results *r, const char *folder);

bench_row *bench_find(const bench_results *r, size_t index); // NULL: not measured
// Adds a copy of what `row` points to; a row of that index is replaced.
void bench_add(bench_results *r, const bench_row *row);

const bench_figure *bench_get_time(const bench_times *t, const char *name); // NULL: none
// What a row is judged by: GPU time of all passes, else its first other time. NULL: nothing.
const bench_time *bench_main_time(const bench_row *row);
const char *bench_axis_value(const bench_row *row, const char *name); // NULL: has no such axis
const char *bench_state_name(bench_state state);
