// Sweeps: Lua files that say what to measure. They run in a sandbox without effects.
//
//   return sweep {
//     name = "paper", effect = "../../effects/paper.lua", size = {1920, 1080}, frames = "28-34",
//     set  = { opacity = 20 },
//     axes = { axis { "steps", 16, 32 }, axis { "march.resolution", 0.25, 0.5, label = "resolution"
//     } }, reference = { steps = 1024 },
//   }
//
// Reading a sweep expands it to a list of complete rows.
#pragma once
#include "base/arena.h"
#include "base/file.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    SWEEP_MAX_ROWS = 4096,
    SWEEP_MAX_AXES = 16,
    SWEEP_MAX_VALUES = 256,
    SWEEP_MAX_SETTINGS = 256,
    SWEEP_MAX_FRAMES = 100000,
};
#define SWEEP_NO_REFERENCE SIZE_MAX

typedef struct sweep_pair { // a setting and its text, or an axis and its value
    const char *name, *text;
} sweep_pair;

typedef struct sweep_number {
    const char *name;
    double value;
} sweep_number;

typedef struct sweep_axis {
    const char *name, *label;
    const char **values;
    size_t value_count;
} sweep_axis;

typedef struct sweep_row {
    const char *label;
    const char *effect; // path, allowed by the rule below
    const char *inside; // the folder that allows it
    uint32_t width, height;
    double *frames; // NULL: by `first` and `last`, which are seconds
    size_t frame_count;
    double first, last;
    uint32_t warmup, repeats;
    double limit; // seconds; 0: none
    sweep_pair *axes, *settings;
    size_t axis_count, setting_count;
    size_t reference; // in sweep.references, or SWEEP_NO_REFERENCE
    sweep_number *published;
    size_t published_count;
    const char **edits; // of measure "reload": a text, then the texts that replace it
    size_t edit_count;
    const char *command; // of measure "start": "check", "render"
    bool empty_cache;
} sweep_row;

typedef enum sweep_measure { SWEEP_FRAMES, SWEEP_RELOAD, SWEEP_START } sweep_measure;

typedef struct sweep { // lives in the arena
    const char *name, *title, *file;
    const char **notes;
    size_t note_count;
    sweep_measure measure;
    bool counters;
    double settle;
    uint32_t compared;
    sweep_axis *axes;
    size_t axis_count;
    sweep_row *rows;
    size_t row_count;
    uint32_t samples;      // above 0: references are path traced
    sweep_pair *reference; // settings of the reference in the file
    size_t reference_setting_count;
    sweep_row *references; // each different one once
    size_t reference_count;
} sweep;

typedef struct sweep_options { // options of the command line, which replace those of the file
    uint32_t width, height; // 0: the file's. Sizes of an axis are scaled: the largest becomes this
    const double *frames;   // NULL: the file's. An axis of frames is not replaced
    size_t frame_count;
    int warmup, repeats; // below 0: the file's
    double limit;        // below 0: the file's
    double settle;       // below 0: the file's
    bool no_reference;   // pictures are not compared
    // Effect files must lie in the sweep's own folder, in the current folder, or in this one (the
    // program's home), or below them. NULL: not in the latter.
    const char *home;
} sweep_options;

// Reads a sweep into `memory`. False with "file:line: message".
bool sweep_read(const char *file, const sweep_options *options, arena *memory, sweep *out);
