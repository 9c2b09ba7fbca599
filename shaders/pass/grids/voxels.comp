// Meshes as cells of a box: a field of what is inside of them, of how far their surface is, and of
// how they move. Meshes that stand still are computed once.

// Here all but the distance, which shaders/scene/voxels/distance.comp writes.
layout(local_size_x = 16, local_size_y = 16, local_size_z = 1) in;
//@ option rule = auto {auto, solid, shell} : solid fills what is inside, even with holes; shell is every cell that a triangle touches; auto is solid where a mesh is closed, shell where it is open or thin
#include "shared.h"
layout(std430) readonly buffer VoxelIds { uint voxel_ids[]; };
layout(std430) readonly buffer VoxelMotions { voxel_motion voxel_motions[]; };
uniform vec3 box_min;
uniform vec3 box_max;
uniform vec3 size; // cells
writeonly uniform image3D inside;    //= output r8 optional : 1 where there is a mesh
writeonly uniform image3D distance_; //= output r16f optional : to the nearest surface (m), negative inside
writeonly uniform image3D velocity;  //= output rgba16f optional : of the mesh in a cell (m/s)

vec3 velocity_at(uint id, vec3 p) {
    voxel_motion m = voxel_motions[id];
    vec3 from = p - m.centre.xyz;
    return m.linear.xyz + cross(m.angular.xyz, from) + m.linear.w * from;
}

void main() {
    uvec3 first = gl_GlobalInvocationID * uvec3(4u, 1u, 1u), cells = uvec3(size);
    if (any(greaterThanEqual(first, cells))) return;
    uint at = first.x + cells.x * (first.y + cells.y * first.z);
    bool shows = imageSize(inside).x > 1, moves = imageSize(velocity).x > 1;
    for (uint i = 0u; i < 4u; i++) {
        uint id = voxel_ids[at + i];
        uvec3 cell = first + uvec3(i, 0u, 0u);
        vec3 p = mix(box_min, box_max, (vec3(cell) + 0.5) / size);
        if (shows) imageStore(inside, ivec3(cell), vec4(id == 0u ? 0.0 : 1.0));
        if (moves)
            imageStore(velocity, ivec3(cell), vec4(id == 0u ? vec3(0.0) : velocity_at(id, p), 0.0));
    }
}
