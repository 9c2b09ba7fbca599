// Values of a script as the texts that settings are: of presets and of sweeps.
#pragma once
#include "base/str.h"
#include <lua.h>

typedef struct setting_text {
    const char *who, *key; // how messages name the value
    strbuf *text;          // owned by the caller, who outlives Lua's errors
} setting_text;

// Adds the text of the value at the top of the stack: a number, true or false, a word, numbers,
// stops of a palette or keys of a curve. Raises for anything else.
void setting_add_text(lua_State *L, const setting_text *to);
bool setting_is_name(const char *text); // can be that of a control; messages repeat it
