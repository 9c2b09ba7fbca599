// Where a thread of a part of the slices stands (src/pass/slices/slices.h says how places are counted).
#include "sim/flow/state.glsl"
uniform float now;       // of the step (s)
uniform float duration;  // of it (s)
uniform uint is_first;   // nothing of its kind has been written in this step
uniform uint variety;    // of what is random

vec3 slices_place(vec2 cell) {
    return vec3(cell / float(FLOW_NX), 0.0);
}

// Shares of the middle of the cell that a function of places covers: of its four quarters.
#define SLICES_COVER(FUNCTION, cell)                                                               \
    0.25 * (clamp(FUNCTION(slices_place(vec2(cell) + vec2(0.25, 0.25))), 0.0, 1.0) +               \
            clamp(FUNCTION(slices_place(vec2(cell) + vec2(0.75, 0.25))), 0.0, 1.0) +               \
            clamp(FUNCTION(slices_place(vec2(cell) + vec2(0.25, 0.75))), 0.0, 1.0) +               \
            clamp(FUNCTION(slices_place(vec2(cell) + vec2(0.75, 0.75))), 0.0, 1.0))
