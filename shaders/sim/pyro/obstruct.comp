// What solids do to a step before the projection: faces that they close move as they do.
layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;
#include "shared.h"
#include "sim/pyro/state.glsl"
#include "sim/pyro/bodies.glsl"

uniform vec3 box_min;
uniform float cell; // of the velocity, m
layout(std430) readonly buffer PyroCoefficients { PYRO_COEFFICIENTS coefficients[]; };
layout(std430) readonly buffer SolidMotions { voxel_motion motions[]; }; // by id
layout(std430) buffer PyroVelocityTo { PYRO_FOUR velocity_to[]; };

// Of the solid on either side of a face, and 1 for each that there is.
vec4 motion_of(ivec3 c, vec3 face) {
    uint body = pyro_body_at(c);
    if (body == 0u) return vec4(0.0);
    voxel_motion m = motions[body];
    vec3 r = box_min + face * cell - m.centre.xyz;
    return vec4(m.linear.xyz + cross(m.angular.xyz, r) + m.linear.w * r, 1.0);
}

vec3 motion_between(ivec3 c, ivec3 step_) {
    vec3 face = vec3(c) + 0.5 - 0.5 * vec3(step_);
    vec4 sum = motion_of(c, face) + motion_of(pyro_into(c - step_), face);
    return sum.xyz / max(sum.w, 1.0);
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int at = pyro_at(c);
    vec4 open_ = pyro_coefficients(coefficients[at]);
    if (all(greaterThan(open_, vec4(0.0)))) return;
    vec4 v = pyro_load(velocity_to[at]);
    if (open_.x == 0.0) v.x = motion_between(c, ivec3(1, 0, 0)).x;
    if (open_.y == 0.0) v.y = motion_between(c, ivec3(0, 1, 0)).y;
    if (open_.z == 0.0) v.z = motion_between(c, ivec3(0, 0, 1)).z;
    velocity_to[at] = pyro_store(v);
}
