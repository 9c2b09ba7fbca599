// What a path leads to that a user gives to the window, and effects that are written for them.
// Needs no window.
#pragma once
#include "base/file.h"
#include "roil.h"

typedef struct opening {
    char file[PATH_CAP]; // the effect
    roil_recipe *recipe; // of the picture that was given; NULL: none was
} opening;

// An effect is itself. A PNG picture leads to what it was made of, and a VDB file to an effect that
// shows its sequence: one of its folder, or one that is written there. False with a message.
bool opening_find(const char *home, const char *path, opening *out);
// Writes a new effect, NAME.lua in the current folder, from a template (starts.h), with what it
// reads. An existing file is never replaced.
bool opening_new(roil *r, const char *from, const char *name, opening *out);
void opening_free(opening *o);
