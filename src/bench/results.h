// Results of a sweep, row by row, in memory and as files.
//
// Everything else is made from results.json (CSV, reports, comparisons, further rows). Strangers
// may have written it: whatever a file contains, reading it gives valid results or a message.
#pragma once
#include "base/arena.h"
#include "roil.h"
#include "script/sweep.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { BENCH_MAX_ROWS = 4096, BENCH_MAX_AXES = 16, BENCH_MAX_VALUES = 4096 };

typedef struct bench_figure {
    double median, p5, p95; // percentiles by nearest rank
    size_t count;
    const double *values; // single measurements in their order; NULL: not kept
} bench_figure;

typedef struct bench_time {
    const char *name;
    bench_figure ms;
} bench_time;

typedef struct bench_times {
    bench_time *items;
    size_t count;
} bench_times;

typedef struct bench_numbers {
    sweep_number *items;
    size_t count;
} bench_numbers;

typedef struct bench_settings {
    roil_setting *items;
    size_t count;
} bench_settings;

typedef enum bench_state {
    BENCH_PLANNED, // not measured; never in a file
    BENCH_DONE,
    BENCH_FAILED,
    BENCH_LIMIT, // stopped at its time limit; measurements until then are kept
} bench_state;

typedef struct bench_row {
    // The input.
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
    // The result.
    bench_state state;
    const char *message; // of BENCH_FAILED, BENCH_LIMIT; else ""
    bench_times gpu;     // by pass, "all" last
    // Of a frame: until it is "submit"ted and drawn ("frame"), by the clock; processor time of the
    // thread that submits it ("host") and of all threads until it is drawn ("process").
    bench_times cpu;
    bench_times times; // of other measures: "reload", "take_over", "start"
    bench_numbers counters;
    uint64_t device_bytes, reserved_bytes, host_bytes;
    bool compared;           // the three below are valid, for the worst frame
    double psnr, ssim, flip; // psnr INFINITY: equal
    const char *thumbnail;   // PNG, relative to the folder of the results; NULL: none
    const char *inputs;      // hash of all files that the effect had read; NULL or "": unknown
    // "NAME (DRIVER)" of the device that measured it, where others measured most of the rows; NULL
    // or
    // "": that of the results.
    const char *device;
    bench_numbers published; // times that others report for this row, milliseconds
} bench_row;

typedef struct bench_reference { // the reference that pictures are compared with
    bool traced;                 // path traced; else a row with other settings
    uint32_t samples;            // per pixel, when it is traced
    bench_settings settings;
} bench_reference;

typedef struct bench_results {
    arena memory;                 // holds everything that the other members point to
    const char *version, *commit; // of roil; "" when unknown
    const char *sweep, *title, *file;
    const char *content; // hash of the sweep's input, equal for all parts of one sweep
    const char **notes;
    size_t note_count;
    const char *device, *driver;
    const char *cpu, *os; // of the machine
    uint32_t cores;
    const char *date; // ISO 8601, of the start
    sweep_axis *axes;
    size_t axis_count;
    bool has_reference;
    bench_reference reference;
    bool tuned;            // from a search (tune.h):
    size_t before, chosen; // indices of two of its rows
    bool by_process;       // it used processor time, since the device is the processor
    bench_row *rows;       // measured rows, by rising index
    size_t row_count, row_capacity;
} bench_results;

void bench_results_free(bench_results *r); // zeroed results are allowed

// Reads `folder`/results.json. False with a message that names the file and the fault; `out` is
// then empty.
bool bench_read(const char *folder, bench_results *out);
bool bench_read_file(const char *file, bench_results *out);
// Writes results.json and results.csv, each atomically: a reader sees the old or the new file.
bool bench_write(const bench_results *r, const char *folder);

bench_row *bench_find(const bench_results *r, size_t index); // NULL: not measured
// Adds a deep copy of `row`, or replaces the row of that index.
void bench_add(bench_results *r, const bench_row *row);

// Adds a deep copy; `axes` has room.
void bench_add_axis(bench_results *r, const sweep_axis *axis);
// Takes the rows and the date of results in `folder`, if there are any, as of an earlier run that
// was interrupted. False with a message when these are of something else, for which `other` says
// what it is, or of another device; and where `exactly`, of another driver or commit.
bool bench_take_earlier(bench_results *r, const char *folder, const char *other, bool exactly);

const bench_figure *bench_get_time(const bench_times *t, const char *name); // NULL: none
// Returns the time by which rows are compared: GPU time of all passes, else its first other time.
// NULL: there is none.
const bench_time *bench_main_time(const bench_row *row);
const char *bench_axis_value(const bench_row *row, const char *name); // NULL: no such axis
const char *bench_state_name(bench_state state);
