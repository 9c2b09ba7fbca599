// First of three dispatches: of each part that moved, the masks are cleared and its points placed:
// in steps of 1 / VOXEL_UNIT of a cell, from the corner of the box. A point of several triangles is
// placed once, so that they meet exactly.
#include "state.glsl"
layout(local_size_x = VOXEL_GROUP) in;
layout(std430) readonly buffer VoxelPoints { vec4 voxel_points[]; };
layout(std430) writeonly buffer VoxelPlaced { ivec4 voxel_placed[]; };
layout(std430) writeonly buffer VoxelMasks { uvec4 voxel_masks4[]; };

// Farther out, corners are moved: nothing near the box changes by that.
const float farthest = float(1 << 22);

void main() {
    uint group = voxel_group();
    if (group >= voxel.count.z) return;
    uvec4 work = voxel_find_work(group, 1u);
    voxel_part p = voxel_parts[work.x];
    uint threads = uint(VOXEL_GROUP) * work.w;
    uint thread = uint(VOXEL_GROUP) * (group - work.y) + gl_LocalInvocationID.x;
    for (uint i = thread; i < p.place.z; i += threads) voxel_masks4[p.place.y + i] = uvec4(0u);
    for (uint i = thread; i < p.mesh.y; i += threads) {
        vec4 point = vec4(voxel_points[p.mesh.x + i].xyz, 1.0);
        precise vec3 cell = vec3(dot(p.rows[0], point), dot(p.rows[1], point), dot(p.rows[2], point));
        vec3 steps = clamp(round(cell * float(VOXEL_UNIT)), -farthest, farthest);
        voxel_placed[p.place.x + i] = ivec4(steps, 0);
    }
}
