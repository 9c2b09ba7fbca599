// The constructors of effect files, except for those in the table of kinds: a row for each. The
// bindings check and read keys by these rows, and `roil info fields` prints them, so the two cannot
// differ.
#pragma once
#include "scene/scene.h"
#include <stddef.h>

typedef struct script_object {
    const char *name;
    const char *group;   // as those of kinds, or "scene", "effect"
    const char *form;    // how it is written
    const char *summary; // the first sentence stands alone
    // By place; by name; of what it gives. Each list ends with a NULL name; NULL: none.
    const value_desc *args, *keys, *members;
    const scene_value *values; // of a scene object: the fields that are keys, too, or NULL,
    unsigned takes;            // and what these may need (scene_need)
    bool module;               // by `require`, and no global
} script_object;

const script_object *script_object_at(size_t index);       // NULL: there are no more
const script_object *script_object_find(const char *name); // NULL when unknown
const value_desc *script_key_find(const value_desc *keys, const char *name); // NULL: not there
// One of all that it takes by name, the fields first; NULL: there are no more.
const value_desc *script_object_key(const script_object *object, size_t index);
// The field after `last`, or the first after NULL, that the object takes; NULL: none.
const scene_value *script_object_value(const script_object *object, const scene_value *last);

// Returns whether Lua has a constructor of the kind, made from its row. Other kinds are made from
// objects, numbers and functions.
bool script_has_kind(const field_kind *kind);
