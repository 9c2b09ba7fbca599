// Ranges of lib/shape.h. C compiles this text too (src/field/glsl.h).
#ifndef LIB_RANGE_SHAPE_H
#define LIB_RANGE_SHAPE_H
#include "lib/range.h"
#include "lib/shape.h"

// Of a solid: falls with the distance and, where it is above 0, with the falloff.
SHARED range1 range_density(range1 distance, range1 falloff) {
    return range1(shape_density(distance.high, falloff.high) * (1.0f - RANGE_ROUNDING),
                  min(shape_density(distance.low, falloff.low) * (1.0f + RANGE_ROUNDING), 1.0f));
}

#endif
