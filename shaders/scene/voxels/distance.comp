// From the nearest triangles to signed distances, of four cells at once. The shell of a body has no
// inside: only what is solid counts as that.
layout(local_size_x = 16, local_size_y = 16) in;
#include "near.glsl"
#include "inside.glsl"
layout(std430) readonly buffer VoxelSeeds { uvec4 voxel_seeds[]; };
layout(r16f) writeonly uniform image3D values;

void main() {
    uvec3 at = gl_GlobalInvocationID * uvec3(4u, 1u, 1u);
    if (any(greaterThanEqual(at, voxel.grid.xyz))) return;
    uvec4 solid = uvec4(0u);
    for (uint i = 0u; i < voxel.count.x; i++) {
        uvec3 cell = at;
        if (!voxel_enter(voxel_parts[i], cell)) continue;
        solid |= voxel_solid(voxel_find_masks(voxel_parts[i]), cell);
    }
    for (uint i = 0u; i < 4u; i++) {
        uvec3 cell = at + uvec3(i, 0u, 0u);
        uint triangle = voxel_seeds[near_index(cell)].w;
        vec3 p = near_centre(cell);
        float far = voxel.corner.w;
        if (triangle != ~0u) far = min(far, distance(p, near_point(near_get(triangle), p)));
        imageStore(values, ivec3(cell), vec4(solid[i] != 0u ? -far : far));
    }
}
