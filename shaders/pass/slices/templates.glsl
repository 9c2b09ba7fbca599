// Templates at work in a flow, as they lie on the device (lib/templates.glsl): for each slice a set, and
// four rows of these.
//
//   0  middle (cells), half of its side (cells; 0: nothing is drawn), what its picture is times
//   1  cos and sin of its turn, what its alpha is times, its tile; -1 - tile: velocity
//   2  age and lifetime (s), number of its life (0: it has had none), side (widths of a slice)
//   3  turn as it was put there (radians), middle (cells), 1: it has been put somewhere
#ifndef PASS_SLICES_TEMPLATES_GLSL
#define PASS_SLICES_TEMPLATES_GLSL
// TEMPLATES_TILE: cells along a side of a tile, a multiple of 16.
#define TEMPLATES_SETS FLOW_SLICES
#define TEMPLATES_TILES                                                                            \
    ivec3((ivec2(FLOW_NX, FLOW_NY) + TEMPLATES_TILE - 1) / TEMPLATES_TILE, FLOW_SLICES)
#include "lib/templates.glsl"
#endif
