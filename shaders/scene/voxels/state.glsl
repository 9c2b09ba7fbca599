// What a run of the voxeliser is told (src/scene/voxels.c), and where the masks of a part lie.
#ifndef VOXELS_STATE_GLSL
#define VOXELS_STATE_GLSL
#include "shared.h"
layout(std430) readonly buffer VoxelState {
    voxel_head voxel;
    voxel_part voxel_parts[];
};
// Of each part that is voxelised now: which it is, its first group of prepare.comp and of cross.comp, how many of
// the former. Then, from voxel.tiles.w on, of each tile that is composed where its list begins, and where the last
// one ends; then these lists: parts that meet the tile.
layout(std430) readonly buffer VoxelLists { uint voxel_lists[]; };

// Three masks, a bit a cell: where the number of crossings before is odd, along x, y and z; and the
// shell's where there is one. Bits of the mask of an axis follow each other along that axis, so that
// a crossing toggles few words; words follow each other along x where they can, so that four
// neighbours are a uvec4.
struct voxel_masks {
    uvec3 size;    // cells
    uvec3 words;   // along each axis
    uint first[4]; // word of each mask
};

uint voxel_round(uint words) {
    return (words + 3u) & ~3u;
}

voxel_masks voxel_find_masks(voxel_part p) {
    voxel_masks m;
    m.size = p.size.xyz;
    m.words = (m.size + 31u) / 32u;
    m.first[0] = 4u * p.place.y;
    m.first[1] = m.first[0] + voxel_round(m.words.x * m.size.y * m.size.z);
    m.first[2] = m.first[1] + m.size.x * m.size.z * m.words.y;
    m.first[3] = m.first[2] + m.size.x * m.size.y * m.words.z;
    return m;
}

// The word of a cell of the part's box, in the masks along x (and the shell's), y, z.
uint voxel_word_x(voxel_masks m, uvec3 cell) {
    return (cell.x >> 5) + m.words.x * (cell.y + m.size.y * cell.z);
}
uint voxel_word_y(voxel_masks m, uvec3 cell) {
    return m.first[1] + cell.x + m.size.x * (cell.z + m.size.z * (cell.y >> 5));
}
uint voxel_word_z(voxel_masks m, uvec3 cell) {
    return m.first[2] + cell.x + m.size.x * (cell.y + m.size.y * (cell.z >> 5));
}

uint voxel_group() {
    return gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
}

// What is voxelised by a group: the last whose first group, `column` of the list, is not beyond it.
uvec4 voxel_find_work(uint group, uint column) {
    uint low = 0u, high = voxel.count.y;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (voxel_lists[4u * middle + column] <= group) low = middle;
        else high = middle;
    }
    low *= 4u;
    return uvec4(voxel_lists[low], voxel_lists[low + 1u], voxel_lists[low + 2u], voxel_lists[low + 3u]);
}

#endif
