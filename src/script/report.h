// Reports: a Lua program of the library makes an HTML page from a tree of JSON. Its texts change
// often, so they are not in C. The tree may be a stranger's, so the program runs in the sandbox of
// effects.
#pragma once
#include "base/str.h"
#include <jansson.h>

// Runs `folder`/page.lua, which returns a function, and calls it with `data`. Objects and arrays
// become tables, null is left out; the names of an object are also in it at 1, 2, 3 ... Appends the
// function's result to `out`. False with a message.
bool script_report(const char *folder, const json_t *data, strbuf *out);
