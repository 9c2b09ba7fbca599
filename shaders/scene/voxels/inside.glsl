// Whether cells lie in a part: from its masks.
#ifndef VOXELS_INSIDE_GLSL
#define VOXELS_INSIDE_GLSL
#include "state.glsl"
layout(std430) readonly buffer VoxelMasks { uvec4 voxel_masks4[]; };

// Of the four cells from `cell` on, x a multiple of 4, in the part's box: 1 where the cell is solid,
// as two of the axes say.
uvec4 voxel_solid(voxel_masks m, uvec3 cell) {
    uint word = m.first[0] + voxel_word_x(m, cell);
    uvec4 x = uvec4(voxel_masks4[word / 4u][word & 3u] >> (cell.x & 31u)) >> uvec4(0u, 1u, 2u, 3u);
    uvec4 y = voxel_masks4[voxel_word_y(m, cell) / 4u] >> (cell.y & 31u);
    uvec4 z = voxel_masks4[voxel_word_z(m, cell) / 4u] >> (cell.z & 31u);
    return ((x & y) | (y & z) | (z & x)) & 1u;
}

// 1 where the shell is.
uvec4 voxel_shell(voxel_masks m, uvec3 cell) {
    uint word = m.first[3] + voxel_word_x(m, cell);
    return (uvec4(voxel_masks4[word / 4u][word & 3u] >> (cell.x & 31u)) >> uvec4(0u, 1u, 2u, 3u)) &
           1u;
}

// Whether a cell of the box is one of the part's; `cell` becomes that.
bool voxel_enter(voxel_part p, inout uvec3 cell) {
    cell -= p.low.xyz; // below: very large
    return all(lessThan(cell, p.size.xyz));
}

#endif
