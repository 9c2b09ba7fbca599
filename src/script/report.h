// Reports: an HTML page that a Lua program of ours makes of a tree of JSON. Its words are a matter
// of taste and change often, so they are not in C; the tree may be a stranger's, so the program
// runs in the sandbox of effects.
#pragma once
#include "base/str.h"
#include <jansson.h>

// Runs `folder`/page.lua, which returns a function, and calls that with `data`: objects and arrays
// become tables, null is left out; an object's names also stand in it at 1, 2, 3 ... What the
// function returns is added to `out`. False with a message.
bool script_report(const char *folder, const json_t *data, strbuf *out);
