// Cells that know their triangle begin with the nearest point of it; w: the triangle, or none.
layout(local_size_x = 16, local_size_y = 16) in;
#include "near.glsl"
layout(std430) readonly buffer VoxelKeys { uint voxel_keys[]; };
layout(std430) writeonly buffer VoxelNextSeeds { uvec4 voxel_next[]; };

void main() {
    uvec3 cell = gl_GlobalInvocationID;
    if (any(greaterThanEqual(cell, voxel.grid.xyz))) return;
    uint index = near_index(cell), key = voxel_keys[index];
    uvec4 seed = uvec4(0u, 0u, 0u, ~0u);
    if (key != ~0u) {
        seed.w = key & ((1u << near_bits()) - 1u);
        seed.xyz = floatBitsToUint(near_point(near_get(seed.w), near_centre(cell)));
    }
    voxel_next[index] = seed;
}
