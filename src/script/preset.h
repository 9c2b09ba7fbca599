// Presets: a Lua file that returns a table of plain data, run in a sandbox that knows no effects.
//
//   return { density = 30, tint = "#ff8000", ["march.steps"] = 64,
//            fire = { {0, "#000000"}, {1, {4, 2, 0.5}, 0.8} },
//            fade = { {0, 1}, {2, 0}, shape = "cubic" } }
#pragma once
#include "effect/effect.h"

enum { PRESET_MAX_SETTINGS = 4096 };
// The settings that it stands for, sorted by name, in `memory`. False with a message that names
// file and key. `root`: as file_open_inside has it.
bool preset_read(const char *root, const char *path, arena *memory, effect_setting **out,
                 size_t *count);
