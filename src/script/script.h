// Effect files: Lua 5.4 in a sandbox. Only this layer uses Lua.
//
// A script can compute, declare, and return values for a time. It reads only modules and data
// inside of the effect's folder and the program's library, has no access to the system, and is
// stopped when it takes too much memory or time.
#pragma once
#include "effect/effect.h"
#include <stddef.h>
#include <stdint.h>

typedef struct script_limits {
    size_t memory;  // bytes of the whole script state; 0: 256 MiB
    uint64_t load;  // instructions while the file runs; 0: 200 million
    uint64_t frame; // instructions of one function of time or `update`; 0: 20 million
} script_limits;

// Runs effect_get_facts(e)->file and fills the effect. `prelude_folder` has the program's scripts,
// prelude.lua and lib/. The effect owns the state of the script from then on (effect_set_hooks).
// False with "file:line: message" and its callers on the lines below; the effect can then only be
// destroyed.
bool script_load(effect *e, const char *prelude_folder);
bool script_load_limited(effect *e, const char *prelude_folder, const script_limits *limits);
