// Keys over time with an interpolation between them: how a number, vector or colour moves.
#pragma once
#include "base/arena.h"
#include "base/str.h"
#include <stdbool.h>
#include <stddef.h>

typedef enum curve_shape {
    CURVE_STEP,
    CURVE_LINEAR,
    CURVE_CUBIC, // cubic: monotone Hermite (Fritsch and Carlson 1980)
    CURVE_EASE_IN,
    CURVE_EASE_OUT,
    CURVE_EASE_IN_OUT, // cubic easing between neighbouring keys
    CURVE_SHAPE_COUNT
} curve_shape;

typedef struct curve_key {
    float time; // seconds
    float value[4];
} curve_key;

typedef struct curve {
    curve_shape shape;
    int components;        // 1..4
    const curve_key *keys; // strictly rising in time
    size_t count;
    float period; // seconds after which it starts again; 0: holds its first and last value
} curve;

const char *curve_shape_name(curve_shape shape); // "step", "linear", "cubic", "ease_in", ...
// Copies and checks the keys: at least one, finite, strictly rising.
curve *curve_create(arena *memory, const curve *desc);
enum { CURVE_MAX_KEYS = 64 }; // of a curve made from text
// Makes a curve of curve_create another one of as many components. Memory is taken once at most:
// there may be as many keys as it had when it was made, or CURVE_MAX_KEYS. False leaves it as it
// was. `desc` must not point to the keys of an earlier curve_replace.
bool curve_replace(curve *c, const curve *desc);
// "cubic 0 1; 2.5 0,1,0": shape, then time and value of each key. `keys` holds CURVE_MAX_KEYS; the
// period is left 0. Checks the form; curve_replace checks the values.
bool curve_parse(const char *text, curve_key *keys, curve *out);
void curve_print(const curve *c, strbuf *out);
void curve_eval(const curve *c, double time, float out[4]);
