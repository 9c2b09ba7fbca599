// 1 where there is a body.
layout(local_size_x = 16, local_size_y = 16) in;
#include "ids.glsl"
layout(r8) writeonly uniform image3D inside;

void main() {
    uvec3 cell = gl_GlobalInvocationID * uvec3(4u, 1u, 1u);
    if (any(greaterThanEqual(cell, voxel.grid.xyz))) return;
    uvec4 ids = voxel_get_ids(cell);
    for (int i = 0; i < 4; i++)
        imageStore(inside, ivec3(cell) + ivec3(i, 0, 0), vec4(ids[i] != 0u ? 1.0 : 0.0));
}
