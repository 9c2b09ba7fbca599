// Templates of a flow: pictures of pressure or velocity that are put into it for a while, again and
// again (Krueger and Westermann 2005, 3). A group is a pass of the type `slices_templates`; all
// groups of a flow, in all of its slices, are drawn by one dispatch before each step of the solver.
//
// Picture: red and green are velocity to the right and up, blue is pressure, alpha how much of it
// is put there. EXR holds them as they are; in a PNG 128 of 255 (32768 of 65535) is 0. Where alpha
// is 1 everywhere, which is a file without it, the border fades as a Gaussian, from 1 in the middle
// to 0.004.
#pragma once
#include "media/picture.h"
#include "pass/pass.h"

enum {
    SLICES_TILE = 64,                 // texels a side of a picture as it is on the device
    SLICES_TILE_LEVELS = 4,           // 64 to 8
    SLICES_TEMPLATES_GROUPS = 16,     // of a flow
    SLICES_TEMPLATES_MOST = 4096,     // of all groups, in each slice
    SLICES_TEMPLATES_SIDE_MAX = 4096, // pixels of a picture
};

// A group of `count` templates in each slice of `p`, a pass `slices`; both are declared. The
// picture lives as long as the effect.
bool slices_add_templates(pass *p, pass *group, const picture *image, uint32_t count);
// Whether there are templates of pressure, which are the solver's FlowTemplates, or of velocity,
// which add to its FlowSources, or write these where the flow has no inflow and no force.
bool slices_has_pressing(const pass *p);
bool slices_has_pushing(const pass *p);

// A picture as a tile: rows from the top, red, green and blue times alpha, alpha.
void slices_tile(const picture *from, float out[SLICES_TILE * SLICES_TILE * 4]);
// The next level of a tile, of half the size.
void slices_tile_half(const float *from, uint32_t side, float *out);

// Of the instances on the device; shaders/pass/slices/templates.glsl says how they lie there. NULL:
// not allocated.
gpu_buffer *slices_templates_buffer(const pass *p);
