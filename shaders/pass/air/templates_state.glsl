// Templates at work in simulated air, as they lie on the device (lib/templates.glsl): one set, and seven rows
// of these. They are put into an image over the air (src/pass/air/air_templates.c) whose texels are
// AIR_COARSER cells of the air a side.
//
//   0  middle (texels), half of its side (texels; 0: nothing is drawn)
//   1  the picture's right, a unit vector; what the picture is times
//   2  the picture's up; 4 times its tile, and 1 if it is velocity, and 2 if it is extruded
//   3  age and lifetime (s), number of its life (0: it has had none), side (m)
//   4  middle as it was put there (cells), 1: it has been put somewhere
//   5  its right, as it was put there
//   6  its up
#ifndef PASS_AIR_TEMPLATES_STATE_GLSL
#define PASS_AIR_TEMPLATES_STATE_GLSL
#define TEMPLATES_SETS 1
// TEMPLATES_NX, TEMPLATES_NY, TEMPLATES_NZ: texels of the image. TEMPLATES_TILE: along a side of a tile.
const ivec3 TEMPLATES_SIZE = ivec3(TEMPLATES_NX, TEMPLATES_NY, TEMPLATES_NZ);
#define TEMPLATES_TILES ((TEMPLATES_SIZE + TEMPLATES_TILE - 1) / TEMPLATES_TILE)
#include "lib/templates.glsl"

const int TEMPLATE_PUSHES = 1, TEMPLATE_EXTRUDED = 2;
#endif
