// Whether cells lie in a part: from its masks.
#ifndef VOXELS_INSIDE_GLSL
#define VOXELS_INSIDE_GLSL
#include "state.glsl"
layout(std430) readonly buffer VoxelMasks { uvec4 voxel_masks4[]; };

// Bits up to that of a cell, of its word.
uint voxel_until(uint cell) {
    return (2u << (cell & 31u)) - 1u;
}

// Of the four cells from `cell` on, x a multiple of 4, in the part's box: 1 where the number of
// crossings before is odd.
uvec4 voxel_odd_x(voxel_masks m, uvec3 cell) {
    uint last = m.first[0] + voxel_word_x(m, cell), before = 0u;
    for (uint i = last - (cell.x >> 5); i < last; i++) before ^= voxel_masks4[i / 4u][i & 3u];
    uint word = voxel_masks4[last / 4u][last & 3u];
    uvec4 until = uvec4(voxel_until(cell.x), voxel_until(cell.x + 1u), voxel_until(cell.x + 2u),
                        voxel_until(cell.x + 3u));
    return uvec4(bitCount(uvec4(before) ^ (word & until))) & 1u;
}

uvec4 voxel_odd_y(voxel_masks m, uvec3 cell) {
    uvec4 all = uvec4(0u);
    uint word = voxel_word_y(m, uvec3(cell.x, 0u, cell.z)) / 4u, apart = m.size.x * m.size.z / 4u;
    for (uint i = 0u; i < cell.y >> 5; i++, word += apart) all ^= voxel_masks4[word];
    return uvec4(bitCount(all ^ (voxel_masks4[word] & voxel_until(cell.y)))) & 1u;
}

uvec4 voxel_odd_z(voxel_masks m, uvec3 cell) {
    uvec4 all = uvec4(0u);
    uint word = voxel_word_z(m, uvec3(cell.xy, 0u)) / 4u, apart = m.size.x * m.size.y / 4u;
    for (uint i = 0u; i < cell.z >> 5; i++, word += apart) all ^= voxel_masks4[word];
    return uvec4(bitCount(all ^ (voxel_masks4[word] & voxel_until(cell.z)))) & 1u;
}

// 1 where the cell is solid: two of the axes say so.
uvec4 voxel_solid(voxel_masks m, uvec3 cell) {
    uvec4 x = voxel_odd_x(m, cell), y = voxel_odd_y(m, cell), z = voxel_odd_z(m, cell);
    return (x & y) | (y & z) | (z & x);
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
