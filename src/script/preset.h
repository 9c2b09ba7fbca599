// Presets: Lua files that return a table of plain data. They run in a sandbox without effects.
//
//   return { density = 30, tint = "#ff8000", ["march.steps"] = 64,
//            fire = { {0, "#000000"}, {1, {4, 2, 0.5}, 0.8} },
//            fade = { {0, 1}, {2, 0}, shape = "cubic" } }
#pragma once
#include "effect/effect.h"

enum { PRESET_MAX_SETTINGS = 4096 };
// Reads the settings of a preset, sorted by name, into `memory`. False with a message that names
// the file and the key. `root`: as in file_open_inside.
bool preset_read(const char *root, const char *path, arena *memory, effect_setting **out,
                 size_t *count);
