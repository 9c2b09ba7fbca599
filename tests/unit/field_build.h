// Short ways to write expressions in tests.
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include <math.h>
#include <string.h>

static arena *build_memory(void) { // lives as long as the program
    static arena memory;
    return &memory;
}

static inline field *need_field(field *node) {
    if (!node) fail_msg("%s", err_get());
    return node;
}

static inline field *number(float v) {
    return field_constant(build_memory(), 1, (const float[4]){v});
}

static inline field *vector(float x, float y, float z) {
    return field_constant(build_memory(), 3, (const float[4]){x, y, z});
}

// make("mix", a, b, NULL, ...): arguments in the row's order; those left out are NULL.
#define make(kind, ...)                                                                            \
    need_field(                                                                                    \
        field_make(build_memory(), kind, (const field *const[FIELD_MAX_ARGS]){__VA_ARGS__}, NULL))

typedef struct named { // an argument (value) or an option (word) of a row, by name
    const char *name;
    const field *value;
    const char *word;
} named;

static inline field *build_row(const char *kind, const named *settings, size_t count) {
    const field_kind *row = field_kind_find(kind);
    if (!row) fail_msg("%s", err_get());
    const field *args[FIELD_MAX_ARGS] = {NULL};
    uint8_t options[FIELD_MAX_OPTIONS] = {0};
    for (size_t s = 0; s < count; s++) {
        bool found = false;
        for (size_t i = 0; settings[s].value && i < FIELD_MAX_ARGS && row->args[i].desc.name; i++) {
            if (strcmp(row->args[i].desc.name, settings[s].name) != 0) continue;
            args[i] = settings[s].value;
            found = true;
        }
        for (size_t i = 0; settings[s].word && i < FIELD_MAX_OPTIONS; i++) {
            const field_option *option = &row->options[i];
            if (!option->name || strcmp(option->name, settings[s].name) != 0) continue;
            for (uint8_t w = 0; w < 6 && option->words[w]; w++)
                if (strcmp(option->words[w], settings[s].word) == 0) options[i] = w, found = true;
        }
        if (!found) fail_msg("%s has no '%s'", kind, settings[s].name);
    }
    return field_make(build_memory(), kind, args, options);
}

// row("worley", SET("power", number(2)), WORD("mode", "paper"))
#define SET(NAME, VALUE)                                                                           \
    { NAME, VALUE, NULL }
#define WORD(NAME, CHOICE)                                                                         \
    { NAME, NULL, CHOICE }
#define row(kind, ...)                                                                             \
    need_field(build_row(kind, (const named[]){__VA_ARGS__},                                       \
                         sizeof((const named[]){__VA_ARGS__}) / sizeof(named)))
#define row_or_null(kind, ...)                                                                     \
    build_row(kind, (const named[]){__VA_ARGS__},                                                  \
              sizeof((const named[]){__VA_ARGS__}) / sizeof(named))

static inline float value_at(const field *node, double time, float3 p) {
    float out[4];
    if (!field_eval(node, &(field_context){.time = time}, p, out)) fail_msg("%s", err_get());
    return out[0];
}

static inline void assert_error(const char *part) {
    if (!strstr(err_get(), part)) fail_msg("\"%s\" is not in: %s", part, err_get());
}

static inline float random_float(uint32_t *state) { // 0..1
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / 16777216.0f;
}

static inline float3 random_point(uint32_t *state, float size) { // around the origin
    float x = random_float(state), y = random_float(state), z = random_float(state);
    return (float3){(x - 0.5f) * size, (y - 0.5f) * size, (z - 0.5f) * size};
}
