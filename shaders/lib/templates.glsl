// Templates at work, as they lie on the device (src/pass/templates.h), row by row: what is in each is said by
// those who write it (pass/slices/templates.glsl, pass/air/templates.glsl). A set has TEMPLATES_TOTAL of
// them, all groups one after the other; there are TEMPLATES_SETS.
#ifndef LIB_TEMPLATES_GLSL
#define LIB_TEMPLATES_GLSL

// Which of them reach into a tile, as bits: written by the shaders of the groups, read in the same step, and
// cleared in the next one, in which the other half is written. TEMPLATES_TILES: along each axis, an ivec3; z
// of slices is the slice.
layout(std430) TEMPLATES_USE buffer Templates { vec4 templates[]; };
layout(std430) buffer TemplateMasks { uint template_masks[]; };
uniform uint parity; // of the masks, that this step writes and reads

const int TEMPLATES_WORDS = (TEMPLATES_TOTAL + 31) / 32;

uint template_at(uint row, int set_, uint which) {
    return (row * uint(TEMPLATES_SETS) + uint(set_)) * uint(TEMPLATES_TOTAL) + which;
}

// The first word of a tile.
uint template_mask_at(uint which_half, ivec3 tile) {
    const ivec3 n = TEMPLATES_TILES;
    int at = ((int(which_half) * n.z + tile.z) * n.y + tile.y) * n.x + tile.x;
    return uint(at * TEMPLATES_WORDS);
}

// For the next step.
void template_clear(ivec3 tile) {
    uint at = template_mask_at(1u - parity, tile);
    for (int w = 0; w < TEMPLATES_WORDS; w++) template_masks[at + uint(w)] = 0u;
}

void template_mark(ivec3 low, ivec3 high, uint which) { // tiles
    low = max(low, ivec3(0));
    high = min(high, TEMPLATES_TILES - 1);
    for (int z = low.z; z <= high.z; z++)
        for (int y = low.y; y <= high.y; y++)
            for (int x = low.x; x <= high.x; x++)
                atomicOr(template_masks[template_mask_at(parity, ivec3(x, y, z)) + (which >> 5)], 1u << (which & 31u));
}
#endif
