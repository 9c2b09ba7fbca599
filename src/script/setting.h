// Converts values of a script to the texts of settings, for presets and sweeps.
#pragma once
#include "base/str.h"
#include <lua.h>

typedef struct setting_text {
    const char *who, *key; // name the value in messages
    strbuf *text;          // owned by the caller, so that Lua errors do not lose it
} setting_text;

// Appends the text of the value at the top of the stack: a number, true or false, a word, numbers,
// stops of a palette or keys of a curve. Raises an error for anything else.
void setting_add_text(lua_State *L, const setting_text *to);
bool setting_is_name(const char *text); // it can be the name of a control, and be shown in messages
