// The vocabulary of effect files beside the table of kinds: a row for each constructor. The
// bindings check and read keys by these rows, and `roil info fields` prints them, so neither can
// say what the other does not.
#pragma once
#include "field/field.h"
#include <stddef.h>

typedef struct script_key {
    const char *name;
    const char *value; // default with range and unit, else the form that is accepted, or NULL
    const char *help;
    const char *words[8]; // of a choice; `value` is the default among them
    int components;       // of a scene object's value,
    size_t offset;        // and where its structure holds the field
} script_key;

typedef struct script_object {
    const char *name;
    const char *group;   // as those of kinds, or "scene", "effect"
    const char *form;    // how it is written
    const char *summary; // the first sentence stands alone
    // By place; by name; of what it gives. Each list ends with a NULL name; NULL: none.
    const script_key *args, *keys, *members;
} script_object;

const script_object *script_object_at(size_t index);       // NULL: there are no more
const script_object *script_object_find(const char *name); // NULL when unknown
const script_key *script_key_find(const script_key *keys, const char *name);

// Whether Lua has the kind under its own name, made from its row. The others are what objects,
// numbers and functions become.
bool script_has_kind(const field_kind *kind);
