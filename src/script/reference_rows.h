// How rows of the tables of constructors are written. For reference*.c only.
#pragma once
#include "script/reference.h"

// Tables, each ending with a row without a name: reference_source.c, reference_scene.c.
extern const script_object reference_sources[], reference_scene[];

// clang-format off
#define KEYS(...) (const script_key[]){__VA_ARGS__, {.name = NULL}}
#define KEY(NAME, VALUE, HELP) {.name = NAME, .value = VALUE, .help = HELP}
#define CHOICE(NAME, VALUE, HELP, ...)                                                             \
    {.name = NAME, .value = VALUE, .help = HELP, .words = {__VA_ARGS__}}
#define SLOT(TYPE, NAME, COMPONENTS, VALUE, HELP)                                                  \
    {.name = #NAME, .value = VALUE, .help = HELP, .components = COMPONENTS,                        \
     .offset = offsetof(TYPE, NAME)}
// clang-format on
