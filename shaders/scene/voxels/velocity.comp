// How the body in a cell moves there (m/s).
layout(local_size_x = 16, local_size_y = 16) in;
#include "ids.glsl"
layout(std430) readonly buffer VoxelMotions { voxel_motion voxel_motions[]; };
layout(rgba16f) writeonly uniform image3D velocity;

void main() {
    uvec3 cell = gl_GlobalInvocationID * uvec3(4u, 1u, 1u);
    if (any(greaterThanEqual(cell, voxel.grid.xyz))) return;
    uvec4 ids = voxel_get_ids(cell);
    for (int i = 0; i < 4; i++) {
        uvec3 at = cell + uvec3(i, 0, 0);
        voxel_motion m = voxel_motions[ids[i]]; // the first is that of no body: rest
        vec3 from = voxel.corner.xyz + (vec3(at) + 0.5) * voxel.cell.xyz - m.centre.xyz;
        vec3 moves = m.linear.xyz + cross(m.angular.xyz, from) + m.linear.w * from;
        imageStore(velocity, ivec3(at), vec4(ids[i] == 0u ? vec3(0.0) : moves, 0.0));
    }
}
