// One round of jump flooding: each cell takes the nearest of the points that its neighbours `apart`
// cells away know. Rong and Tan, "Jump flooding in GPU with applications to Voronoi diagram and
// distance transform", 2006.
layout(local_size_x = 16, local_size_y = 16) in;
#include "near.glsl"
uniform int apart;
layout(std430) readonly buffer VoxelSeeds { uvec4 voxel_seeds[]; };
layout(std430) writeonly buffer VoxelNextSeeds { uvec4 voxel_next[]; };

void main() {
    ivec3 cell = ivec3(gl_GlobalInvocationID), size = ivec3(voxel.grid.xyz);
    if (any(greaterThanEqual(cell, size))) return;
    vec3 p = near_centre(uvec3(cell));
    uvec4 best = uvec4(0u, 0u, 0u, ~0u);
    float nearest = 1e30;
    for (int i = 0; i < 27; i++) {
        ivec3 other = cell + apart * (ivec3(i % 3, i / 3 % 3, i / 9) - 1);
        if (any(lessThan(other, ivec3(0))) || any(greaterThanEqual(other, size))) continue;
        uvec4 seed = voxel_seeds[near_index(uvec3(other))];
        vec3 to = uintBitsToFloat(seed.xyz) - p;
        float squared = seed.w == ~0u ? 1e30 : dot(to, to);
        if (squared >= nearest) continue;
        nearest = squared;
        best = seed;
    }
    voxel_next[near_index(uvec3(cell))] = best;
}
