// What a new effect begins as, in the window and by `roil new`: one set of templates. Needs no
// window.
#pragma once
#include "app/app.h"
#include "base/file.h"

enum { STARTS = 4 };
typedef struct starts_template {
    const char *name, *label; // "burst", "A burst of noise, quick to draw"
    const char *file;         // in the home
} starts_template;
extern const starts_template starts[STARTS];

// Finds a template by its name, else an effect that comes with the program by its name or the end
// of it: "torch". False with a message.
bool starts_find(const char *home, const char *wanted, char out[PATH_CAP]);
// Writes NAME.lua into a folder, as an effect's file is, and copies all that it reads. A file that
// is there and is another one is not replaced: false with a message. `copied` receives how many
// files it reads.
bool starts_write(roil *r, const char *file, const char *folder, const char *name, size_t *copied);
bool starts_write_into(const char *folder, const char *name, const void *data, size_t size);
