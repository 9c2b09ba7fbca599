// What solids do to a step before the projection: faces that they close move as they do, and cells
// within them hold what the gas around them does, so that none of it is lost where gas is traced back
// into them.
layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;
#include "shared.h"
#include "sim/pyro/state.glsl"

uniform vec3 box_min;
uniform float cell; // m
layout(std430) readonly buffer PyroOpenings { uint openings[]; };
layout(std430) readonly buffer SolidIds { uint ids[]; };
layout(std430) readonly buffer SolidMotions { voxel_motion motions[]; }; // by id
layout(std430) buffer PyroVelocityTo { PYRO_FOUR velocity_to[]; };
layout(std430) buffer PyroGasTo { PYRO_FOUR gas_to[]; };

uint body_at(ivec3 c) {
    return ids[c.x + PYRO_NX * (c.y + PYRO_NY * c.z)];
}

// Of the solid on either side of a face, and 1 for each that there is.
vec4 motion_of(ivec3 c, vec3 face) {
    uint body = body_at(c);
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

vec4 around(ivec3 c) {
    vec4 sum = vec4(0.0);
    float count = 0.0;
    for (int i = 0; i < 6; i++) {
        ivec3 step_ = ivec3(i >> 1 == 0, i >> 1 == 1, i >> 1 == 2) * (2 * (i & 1) - 1);
        ivec3 other = pyro_into(c + step_);
        if (body_at(other) != 0u) continue;
        sum += pyro_load(gas_to[pyro_at(other)]);
        count++;
    }
    return sum / max(count, 1.0);
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int at = pyro_at(c);
    vec4 open_ = unpackUnorm4x8(openings[at]);
    if (open_ == vec4(1.0)) return;
    vec4 v = pyro_load(velocity_to[at]);
    if (open_.x == 0.0) v.x = motion_between(c, ivec3(1, 0, 0)).x;
    if (open_.y == 0.0) v.y = motion_between(c, ivec3(0, 1, 0)).y;
    if (open_.z == 0.0) v.z = motion_between(c, ivec3(0, 0, 1)).z;
    velocity_to[at] = pyro_store(v);
    if (open_.w == 0.0) gas_to[at] = pyro_store(around(c));
}
