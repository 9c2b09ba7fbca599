// Made-up results.
#pragma once
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include "bench/sweep.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

// A row of index `index` that took `values` milliseconds in its frames; axes: steps = 16 * index.
static inline bench_row helper_row(size_t index, const double *values, size_t count,
                                   arena *memory) {
    bench_row row = {.index = index,
                     .label = arena_format(memory, "steps %zu", 16 * index),
                     .effect = "a.lua",
                     .width = 96,
                     .height = 54,
                     .frame_count = count,
                     .frames = arena_alloc(memory, count * sizeof(double)),
                     .warmup = 1,
                     .repeats = 1,
                     .state = BENCH_DONE,
                     .message = ""};
    for (size_t i = 0; i < count; i++) row.frames[i] = (double)i;
    row.axes.items = arena_alloc(memory, sizeof *row.axes.items);
    row.axes.items[row.axes.count++] =
        (roil_setting){"steps", arena_format(memory, "%zu", 16 * index)};
    double low = INFINITY, high = 0, sum = 0;
    for (size_t i = 0; i < count; i++) {
        low = fmin(low, values[i]);
        high = fmax(high, values[i]);
        sum += values[i];
    }
    row.gpu.items = arena_alloc(memory, 2 * sizeof *row.gpu.items);
    row.gpu.count = 2;
    const double *kept = arena_copy(memory, values, count * sizeof *values);
    bench_figure figure = {sum / (double)count, low, high, count, kept};
    row.gpu.items[0] = (bench_time){"march", figure};
    row.gpu.items[1] = (bench_time){"all", figure};
    return row;
}

static inline void helper_head(bench_results *r) {
    static const char *values[] = {"0", "16", "32"};
    static const char *notes[] = {"one", "two"};
    *r = (bench_results){.version = "1",
                         .commit = "abc1234",
                         .sweep = "s",
                         .title = "A sweep",
                         .file = "s.lua",
                         .content = "c0ffee",
                         .notes = notes,
                         .note_count = 2,
                         .device = "a device",
                         .driver = "a driver",
                         .cpu = "a processor",
                         .os = "a system",
                         .cores = 2,
                         .date = "2026-11-21T18:00:00Z"};
    r->axes = arena_alloc(&r->memory, sizeof *r->axes);
    r->axes[r->axis_count++] = (sweep_axis){"steps", "steps", values, 3};
}

static char helper_folder[PATH_CAP];

static inline void helper_path(char out[PATH_CAP], const char *name) {
    assert_true(path_join(out, helper_folder, name));
}

static inline void helper_put(const char *name, const void *data, size_t size) {
    char path[PATH_CAP];
    helper_path(path, name);
    assert_true(file_make_parent_folders(path));
    assert_true(file_write(path, data, size));
}

static inline int helper_make(void **state) {
    (void)state;
    snprintf(helper_folder, sizeof helper_folder, "/tmp/roil-unit-XXXXXX");
    return mkdtemp(helper_folder) ? 0 : -1;
}

static inline int helper_remove(void **state) {
    (void)state;
    char command[PATH_CAP + 16];
    snprintf(command, sizeof command, "rm -r %s", helper_folder);
    return system(command);
}
