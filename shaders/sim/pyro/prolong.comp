// Adds the pressure of a coarser level, linearly between its cells, to the cells of colour 1: those
// of colour 0 come first in the sweep that follows, and are computed from these alone.
layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/levels.glsl"

uniform vec3 coarse_size, coarser;
uniform int coarse_first;
layout(std430) buffer PyroPressure { float pressure[]; };
layout(std430) readonly buffer PyroCoarsePressure { float coarse_pressure[]; };

// A coarse level finds a little less than it should, since its differences are wider: a cycle leaves
// 0.17 of smooth divergence with 1, 0.10 to 0.15 with 1.06, and 0.3 in a closed box with 1.2.
const float OVER = 1.06;

// Beyond an open face pressure has the other sign, so that it is 0 there; at a wall it is the same.
float coarse(ivec3 c) {
    ivec3 size = ivec3(coarse_size), last = size - 1;
    bvec3 low = lessThan(c, ivec3(0)), high = greaterThan(c, last);
    vec3 turn = 1.0 - 2.0 * (LEVEL_OPEN_LOW * vec3(low) + LEVEL_OPEN_HIGH * vec3(high));
    ivec3 into = mix(clamp(c, ivec3(0), last), mix(mix(c, last, low), ivec3(0), high), PYRO_AROUND);
    return turn.x * turn.y * turn.z * coarse_pressure[coarse_first + into.x + size.x * (into.y + size.y * into.z)];
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    c.x = 2 * c.x + ((c.y + c.z + 1) & 1);
    if (any(greaterThanEqual(c, LEVEL_SIZE))) return; // a group has 16 cells along x
    // The neighbour on the side where the cell lies, along axes that are halved.
    ivec3 halved = ivec3(coarser) - 1, a = c / ivec3(coarser), b = a + halved * (2 * (c & 1) - 1);
    float sum = 0.421875 * coarse(a) +
                0.140625 * (coarse(ivec3(b.x, a.yz)) + coarse(ivec3(a.x, b.y, a.z)) + coarse(ivec3(a.xy, b.z))) +
                0.046875 * (coarse(ivec3(b.xy, a.z)) + coarse(ivec3(b.x, a.y, b.z)) + coarse(ivec3(a.x, b.yz))) +
                0.015625 * coarse(b);
    pressure[level_at(c)] += OVER * sum;
}
