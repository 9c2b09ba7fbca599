// Last of three dispatches: the ids of four cells at once, of the later part where several hold one.
layout(local_size_x = 16, local_size_y = 16) in;
#include "inside.glsl"
layout(std430) writeonly buffer VoxelIds { uint voxel_ids[]; };

void main() {
    uvec3 at = gl_GlobalInvocationID * uvec3(4u, 1u, 1u);
    if (any(greaterThanEqual(at, voxel.size.xyz))) return;
    at += voxel.low.xyz;
    uvec4 ids = uvec4(0u);
    for (uint i = voxel.count.x; i-- > 0u && any(equal(ids, uvec4(0u)));) {
        uvec3 cell = at;
        if (!voxel_enter(voxel_parts[i], cell)) continue;
        voxel_masks m = voxel_find_masks(voxel_parts[i]);
        uvec4 inside = voxel_solid(m, cell);
        if (voxel_parts[i].size.w != 0u) inside |= voxel_shell(m, cell);
        ids = mix(ids, inside * voxel_parts[i].low.w, equal(ids, uvec4(0u)));
    }
    uint row = voxel.grid.x / 4u;
    voxel_ids[at.x / 4u + row * (at.y + voxel.grid.y * at.z)] =
        ids.x | ids.y << 8 | ids.z << 16 | ids.w << 24;
}
