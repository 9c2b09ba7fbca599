// How a few slices fill space: planes through an axis, between which what they hold is turned
// round it (Krueger and Westermann 2005, "GPU simulation and rendering of volumetric effects for
// computer games and virtual environments", section 5). The twin of shaders/lib/extrude.glsl.
//
// Slice k of n stands at k / n of half a turn. It is a whole plane: what lies left of the axis in
// it is met again half a turn on. So the arc between any two neighbours is 1 / n of half a turn,
// and between the last slice and the first it goes on to the first one mirrored: images of the grid
// have n + 1 layers, the last of which is that mirror. A sample is then one of the image's own,
// linear in x, in y and along the arc: the angle is what spherical interpolation goes by.
//
// Vectors lie in the images as they lie in the slice, (x, y); in space they turn with the arc.
#pragma once
#include "base/maths.h"
#include <stdint.h>

typedef struct field_extrusion {
    float3 position;     // of the middle of the slices' lower edges, metres
    float3 along;        // unit vector of the axis, which is y of a slice
    float3 across;       // unit vector of x of the first slice, square to it
    float width, height; // of a slice, metres
    uint32_t count;      // slices
    int only;            // the one whose plane goes on along its normal, as if alone; -1: all
    uint32_t vectors;    // bits of the grid's images that hold vectors in their first two channels
} field_extrusion;

// Directions from the axis alone: whichever way round the slices stand.
field_extrusion field_extrusion_make(float3 position, float3 axis, float width, float height,
                                     uint32_t count);
box3 field_extrusion_box(const field_extrusion *e); // of the cylinder

typedef struct field_extruded { // where a point comes from
    float at[3];    // in the images, 0..1; the middle of layer k is (k + 1/2) / (count + 1)
    bool inside;    // of the cylinder
    float3 outward; // what x of the slice is there
} field_extruded;
field_extruded field_extrude(const field_extrusion *e, float3 p);

enum { EXTRUSION_NUMBERS = 16 };
// As the shader reads them: rows to x and y round the axis (in widths) and along it (in heights),
// then width, height, `only` and the count.
void field_extrusion_numbers(const field_extrusion *e, float out[EXTRUSION_NUMBERS]);
