// Shared by the files that find what is to be written into a script: edits.c (values) and
// edits_layers.c (layers of noise that come and go).
#pragma once
#include "roil/roil_impl.h"
#include "script/source.h"

typedef struct edits_replacement {
    const char *control;
    source_range at;
    const char *text;
} edits_replacement;

typedef struct edited_file {
    const char *path;
    char *before;
    strbuf after;
    edits_replacement *list; // in the order of the text
    size_t count, capacity;
} edited_file;

struct roil_edits {
    arena memory;
    const char *root; // the effect's folder, which files must lie in
    bool pins;        // values become parameters
    edited_file *files;
    size_t file_count, file_capacity;
    roil_edit *list;
    size_t count, capacity;
};

roil_edits *edits_begin(const roil_effect *e); // of nothing yet; NULL with a message
void edits_end(roil_edits *x);                 // lists what was replaced, line by line
// Reads a file of the effect, once. NULL with a message.
edited_file *edits_open_file(roil_edits *x, const char *path);
// False with a message: something else there is replaced.
bool edits_replace(roil_edits *x, edited_file *f, edits_replacement r);
// Adds a row of the list: of what cannot be written, else of lines.
roil_edit *edits_add(roil_edits *x);
// Replaces the value of a control, or adds a row that says why that cannot be.
void edits_add_control(roil_edits *x, roil_effect *e, const effect_control *c);
bool edits_same_place(const effect_place *a, const effect_place *b);
bool edits_text_is(const char *text, source_range at, const char *word);
enum { EDITS_SHOWN = 48 };
// Copies what is written there, shortened, for messages.
void edits_show(const char *text, source_range at, char out[EDITS_SHOWN]);
