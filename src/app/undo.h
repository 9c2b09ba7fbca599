// What hands have done in the live window, step by step, to be undone and done again. Needs no
// window. A step holds the values that one gesture set, or what was written into files.
#pragma once
#include "app/file_change.h"
#include "roil.h"

enum { UNDO_STEPS = 10000 }; // that are kept; the oldest are forgotten

typedef struct undo_value {
    char *name;
    char *before, *after; // as roil_set takes them; NULL: the script's own value
} undo_value;

typedef struct undo_step {
    char label[96]; // "density", "camera", "preset warm"
    undo_value *values;
    size_t count, capacity;
    roil_edits *written; // and put into files; NULL: nothing was
    file_change *file;   // that was made: a preset, a template; NULL: none was
} undo_step;

typedef struct undo { // zero at first
    undo_step *steps;
    size_t count, capacity; // steps that are kept
    size_t done;            // of these, the first ones that hold; the others were undone
    bool open;              // what comes next belongs to the last step
    double last_note;       // clock_seconds
} undo;

// Call it once a frame: what comes next belongs to the last step while a button or key is held.
void undo_frame(undo *u, bool held);
// Notes that a value was set. Steps that were undone are forgotten, and so is a step whose values
// are all as before.
void undo_note(undo *u, const char *name, const char *before, const char *after, double now);
// Gives the last step a label of its own.
void undo_label(undo *u, const char *format, ...) __attribute__((format(printf, 2, 3)));
// Adds a step: `written`, which belongs to it from now on, was written, and the values that are in
// it became the script's own.
void undo_note_written(undo *u, roil_edits *written, const char *label);
void undo_add_value(undo *u, const char *name, const char *before); // that is in it
// Adds a step: a file, which belongs to it from now on, was made or replaced.
void undo_note_file(undo *u, file_change *file, const char *label);
undo_step *undo_back(undo *u);  // the step to be undone now; NULL: there is none
undo_step *undo_again(undo *u); // the step to be done again now; NULL: there is none
void undo_free(undo *u);
