// What flows out of each cell, less its expansion: the pressure's right-hand side.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/faces.glsl"

uniform float reach; // cells in a step, by 1 m/s
layout(std430) readonly buffer PyroVelocityTo { PYRO_FOUR velocity_to[]; };
layout(std430) readonly buffer PyroExpansion { float expands[]; }; // may be PyroRight itself
layout(std430) writeonly buffer PyroRight { float right[]; };

// Air that is drawn in through an open face comes from rest: its pressure there is below that of the
// surroundings by rho u^2 / 2, which keeps it from coming ever faster (as FDS does). Where it flows out
// pressure is that of the surroundings, which the levels take it to be.
float drawn(ivec3 c, vec3 low, vec3 high) {
    bvec3 first = both(equal(c, ivec3(0)), equal(PYRO_LOW, ivec3(PYRO_OPEN)));
    bvec3 last = both(equal(c, PYRO_SIZE - 1), equal(PYRO_HIGH, ivec3(PYRO_OPEN)));
    vec3 in_ = mix(vec3(0.0), max(low, 0.0), first) + mix(vec3(0.0), max(-high, 0.0), last);
    return reach * dot(in_, in_);
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    pyro_near n = pyro_near_of(c);
    int at = n.cell.x + n.cell.y + n.cell.z;
    vec3 low, high;
    PYRO_FACES(velocity_to, n, low, high)
    right[at] = dot(high - low, vec3(1.0)) - expands[at] + drawn(c, low, high);
}
