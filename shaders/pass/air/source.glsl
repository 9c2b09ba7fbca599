// What a source holds of simulated air's cells, for the shaders that give it to the air. AIR_NX and
// AIR_NY are the cells of the air along x and y; MESHES says whether the source has some.
#ifndef PASS_AIR_SOURCE_GLSL
#define PASS_AIR_SOURCE_GLSL
#include "shared.h"
uniform vec3 box_min;          // corner of the air's box (m)
uniform float cell_size;       // m
uniform float share;           // of the values that the air takes on in this step
uniform float velocity_factor; // of a mesh's own motion
uniform vec3 first;            // cells of the source's box: of the first corner,
uniform vec3 count;            // and how many
layout(std430) readonly buffer SourceValues { uvec4 source_values[]; };

#if MESHES
layout(std430) readonly buffer SourceIds { uint source_ids[]; }; // of its own meshes
layout(std430) readonly buffer SourceMotions { voxel_motion source_motions[]; };

uint body_at(uvec3 cell) {
    return source_ids[cell.x + AIR_NX * (cell.y + AIR_NY * cell.z)];
}

vec3 motion_at(uvec3 cell) {
    voxel_motion body = source_motions[body_at(cell)];
    vec3 r = box_min + (vec3(cell) + 0.5) * cell_size - body.centre.xyz;
    return velocity_factor * (body.linear.xyz + cross(body.angular.xyz, r) + body.linear.w * r);
}
#endif

// A cell's values; nothing outside of the box.
uvec4 values_at(uvec3 cell) {
    uvec3 at = cell - uvec3(first), n = uvec3(count);
    if (any(lessThan(cell, uvec3(first))) || any(greaterThanEqual(at, n))) return uvec4(0u);
#if MESHES
    if (body_at(cell) == 0u) return uvec4(0u);
#endif
    return source_values[at.x + n.x * (at.y + n.y * at.z)];
}
#endif
