// Templates at work in a flow, as they lie on the device (src/pass/slices/slices_templates.c): for each
// slice those of all groups one after the other, and four rows of these.
//
//   0  middle (cells), half of its side (cells; 0: nothing is drawn), what its picture is times
//   1  cos and sin of its turn, what its alpha is times, its tile; -1 - tile: velocity
//   2  age and lifetime (s), number of its life (0: it has had none), side (widths of a slice)
//   3  turn as it was put there (radians), middle (cells), 1: it has been put somewhere
#ifndef PASS_SLICES_TEMPLATES_GLSL
#define PASS_SLICES_TEMPLATES_GLSL

// Which of them reach into a tile of the slice, as bits: written by the shaders of the groups, read
// in the same step, and cleared in the next one, in which the other half is written.
//
// TEMPLATES_TOTAL: of a slice. TEMPLATES_TILE: cells along a side of a tile, a multiple of 16.
layout(std430) TEMPLATES_USE buffer Templates { vec4 templates[]; };
layout(std430) buffer TemplateMasks { uint template_masks[]; };
uniform uint parity; // of the masks, that this step writes and reads

const int TEMPLATES_WORDS = (TEMPLATES_TOTAL + 31) / 32;
const ivec2 TEMPLATES_TILES = (ivec2(FLOW_NX, FLOW_NY) + TEMPLATES_TILE - 1) / TEMPLATES_TILE;

uint template_at(uint row, int slice, uint which) {
    return (row * uint(FLOW_SLICES) + uint(slice)) * uint(TEMPLATES_TOTAL) + which;
}

// The first word of a tile.
uint template_mask_at(uint which_half, int slice, ivec2 tile) {
    int tiles = TEMPLATES_TILES.x * TEMPLATES_TILES.y;
    int at = (int(which_half) * FLOW_SLICES + slice) * tiles + tile.y * TEMPLATES_TILES.x + tile.x;
    return uint(at * TEMPLATES_WORDS);
}
#endif
