// Writing back: what was set becomes what the script's files say. A value is put where the script
// writes it out, or, where it leaves it open, at the end of the table. Comments and everything else
// in the files stay. What a script computes is not replaced. Part of roil.h, which includes it; its
// rules on errors, threads and memory hold here too.
#pragma once
#include "roil.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct roil_edit {      // strings live as long as the edits
    const char *controls;       // "march.steps, march.jitter"
    const char *file;           // path; NULL: it cannot be written
    int line;                   // from 1: the first of the lines that change
    const char *before, *after; // these lines
    const char *refusal;        // why it cannot be written; NULL: it can
} roil_edit;
typedef struct roil_edits roil_edits;
// Finds what to write for a control, or, for NULL, for every control that was changed. Reads the
// files. Free it with roil_edits_free. NULL with a message: there is no such control.
roil_edits *roil_edits_create(roil_effect *e, const char *control);
// The same for one that becomes a parameter of the script, with its value, range, unit and help:
// steps = param { "march_steps", 64, min = 1, max = 4096 }. NULL with a message also for what can
// be none.
roil_edits *roil_edits_create_parameter(roil_effect *e, const char *control);

typedef struct roil_layers { // of noise, that one call of the script lists: layers { {2, 1}, ... }
    const char *name;        // the group of their controls, "lumps"; as long as the effect
    size_t count;
} roil_layers;
typedef enum roil_layer_change {
    ROIL_LAYER_ADD,       // after the last: twice as fine, and half as strong
    ROIL_LAYER_DUPLICATE, // before it
    ROIL_LAYER_REMOVE,
} roil_layer_change;
size_t roil_list_layers(const roil_effect *e, roil_layers *out, size_t capacity);
// Finds what to write for a list of layers, by its name, to have one more or one less; `layer`,
// from 1, does not matter for ROIL_LAYER_ADD. What was set of its layers is written with it, since
// they are counted anew then. NULL with a message: there is no such layer.
roil_edits *roil_edits_create_layer(roil_effect *e, const char *layers, size_t layer,
                                    roil_layer_change how);

size_t roil_edits_list(const roil_edits *x, roil_edit *out, size_t capacity);
// Write the files, and write them as they were before. False with a message: a file is not what it
// is supposed to be, and none was written; or one cannot be written.
bool roil_edits_write(const roil_edits *x);
bool roil_edits_undo(const roil_edits *x);
void roil_edits_free(roil_edits *x); // NULL is allowed

#ifdef __cplusplus
}
#endif
