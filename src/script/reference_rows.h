// Macros for rows of the tables of constructors. For reference*.c only.
#pragma once
#include "script/reference.h"

// Tables, each ending with a row without a name: reference_source.c, reference_scene.c.
extern const script_object reference_sources[], reference_scene[];

// clang-format off
#define KEYS(...) (const value_desc[]){__VA_ARGS__, {.name = NULL}}
// No number: `FORM` says how it is written.
#define KEY(NAME, FORM, HELP) {.name = NAME, .type = VALUE_OTHER, .form = FORM, .help = HELP}
#define WORDS(...) (const char *const[]){__VA_ARGS__}
#define CHOICE(NAME, CHOSEN, HELP, ...)                                                            \
    {.name = NAME, .type = VALUE_WORD, .components = 1, .value = {CHOSEN}, .help = HELP,           \
     .words = WORDS(__VA_ARGS__), .word_count = sizeof(WORDS(__VA_ARGS__)) / sizeof(char *)}
// clang-format on
