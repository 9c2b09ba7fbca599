// The bodies of four cells, x a multiple of 4.
#include "state.glsl"
layout(std430) readonly buffer VoxelIds { uint voxel_ids[]; };

uvec4 voxel_get_ids(uvec3 cell) {
    uint ids = voxel_ids[cell.x / 4u + voxel.grid.x / 4u * (cell.y + voxel.grid.y * cell.z)];
    return uvec4(ids, ids >> 8, ids >> 16, ids >> 24) & 255u;
}
