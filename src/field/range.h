// Ranges: the least and the greatest value that a field can have in a box, by the arithmetic of
// shaders/lib/range.h.
#pragma once
#include "field/field.h"
#include "field/glsl.h"

typedef struct intervals { // of a value, as many as it has components; of a point, three
    range1 c[4];
} intervals;

// Of what a kind makes of arguments in these ranges (widened as kind_arg_width says).
typedef intervals kind_ranges(const field_box *in, const intervals *args);

// Of every component in a box, which may be infinite. False when a Lua function failed.
bool field_ranges(const field *node, const field_context *context, box3 box, intervals *out);
