// Ranges: the least and the greatest value that a field can have in a box, by interval arithmetic.
// No value lies outside, but a range may be wider than need be. The twin of shaders/lib/range.glsl,
// which says how endless ranges and roundings are treated.
#pragma once
#include "field/field.h"

typedef struct interval { // of one component
    float low, high;
} interval;

typedef struct intervals { // of a value, as many as it has components; of a point, three
    interval c[4];
} intervals;

// Of what a kind makes of arguments in these ranges (widened as kind_arg_width says).
typedef intervals kind_ranges(const field_box *in, const intervals *args);

// Of every component in a box, which may be infinite. False when a Lua function failed.
bool field_ranges(const field *node, const field_context *context, box3 box, intervals *out);

// ---- arithmetic -------------------------------------------------------------------------------

interval range_make(float low, float high); // endless beyond what counts
interval range_wide(float low, float high); // and roundings allowed for
interval range_number(float v);
interval range_unknown(void);
interval range_union(interval a, interval b);
interval range_add(interval a, interval b);
interval range_sub(interval a, interval b);
interval range_mul(interval a, interval b);
interval range_mix(interval a, interval b, interval t);
