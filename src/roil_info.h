// Texts for people, and JSON for programs, printed from the tables that the library itself uses.
// Part of roil.h, which includes it; its rules on errors, threads and memory hold here too. Each
// function returns NULL with a message on failure. Free what it returns with roil_free.
#pragma once
#include "roil.h"
#ifdef __cplusplus
extern "C" {
#endif

char *roil_info_devices(void);                     // any thread
char *roil_info_passes(roil *r, const char *name); // NULL: one line for each
char *roil_info_fields(const char *name);          // NULL: one line for each; any thread
char *roil_info_params(roil_effect *e); // memory; parameters; uniforms and options of passes
char *roil_info_graph(roil_effect *e);  // Graphviz dot; after roil_check or roil_prepare
char *roil_info_vdb(const char *file);  // any thread
char *roil_info_inputs(roil *r, const char *file); // whose effect it is, and what it reads
char *roil_info_effects(roil *r); // those that lie in effects/ of the home, a line for each

// The same for programs, as JSON:
// {"roil": version, "words": [...], "passes": [...]}. A word has "name", "is" ("field": a function
// that makes one; "value": a field; "object": any other function; "module": for require), "group",
// "summary", "form", and lists of values: "arguments", "keys", "members". A pass has "name",
// "constructor" (whether a word of that name makes it), "summary", "inputs", "fields", "options",
// "uniforms", "outputs", "counters". A value has "name", "type" ("number", "whole", "bool", "word",
// "color", "other"), "help", and what there is of "components", "default" (or "form": how it is
// written), "min", "max", "unit", "words", "required".
// `list`: "words" or "passes" alone, and of these the one called `name`; NULL: all.
char *roil_info_json(roil *r, const char *list, const char *name);
// {"devices": [{"index", "name", "uuid", "kind", "driver", "memory", "usable", "missing"}]}. Any
// thread.
char *roil_info_devices_json(void);
// {"effect": {"name", "fps", "first_frame", "frames"}, "controls": [...]}: values, with "value" and
// "initial" or "text", and the members of roil_control.
char *roil_info_params_json(roil_effect *e);
char *roil_info_inputs_json(roil *r, const char *file);
// {"effects": [{"name", "file", "summary", "picture"}]}; "picture" is a PNG file, if there is one.
char *roil_info_effects_json(roil *r);
char *roil_info_effects_page(roil *r); // a page of HTML that needs no other file, with the pictures
// Annotations for lua-language-server (LuaLS): every function, key, unit and word of an effect's
// vocabulary, as a file of Lua that is never run.
char *roil_info_lua_meta(roil *r);

#ifdef __cplusplus
}
#endif
