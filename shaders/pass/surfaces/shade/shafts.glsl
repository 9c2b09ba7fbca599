// What may stand between a tile of the picture and a light: a list of leaves of the trees of
// lib/bvh.glsl for each, made by shade_shafts.comp. Rays from the tile to the light need not look at
// anything else (Haines and Wallace, "Shaft culling for efficient ray-traced radiosity", 1991).
#define SHAFT_TILE 16    // pixels
#define SHAFT_LEAVES 15  // in a list; SHAFT_LEAVES + 1: there are more, and rays walk the trees
layout(std430) buffer Shafts { uint shaft_words[]; }; // a count, then leaves
uniform int shaft_lights; // lights that have lists: the first so many

// Where the list of a light is, for the tile of this work group.
uint shaft_start(int light) {
    uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return (tile * uint(shaft_lights) + uint(light)) * uint(SHAFT_LEAVES + 1);
}

// A leaf in a word: the instance in 8 bits, its triangles less one in 2, its first triangle in 22.
bool shaft_can_hold(uint instance, uint leaf) {
    return instance < 256u && (leaf & 0x0fffffffu) < 1u << 22;
}

uint shaft_pack(uint instance, uint leaf) {
    return instance << 24 | (leaf >> 28) - 1u << 22 | leaf & 0x3fffffu;
}
