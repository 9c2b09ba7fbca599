// Adds the pressure of a coarser level, linearly between its cells, to the cells of colour 1: those
// of colour 0 come first in the sweep that follows, and are computed from these alone.
layout(local_size_x = 4, local_size_y = 8, local_size_z = 8) in;
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
    float sign_ = 1.0;
    ivec3 size = ivec3(coarse_size);
    for (int axis = 0; axis < 3; axis++) {
        bool low = c[axis] < 0, high = c[axis] >= size[axis];
        if (!low && !high) continue;
        int face = low ? PYRO_LOW[axis] : PYRO_HIGH[axis];
        if (face == PYRO_OPEN) sign_ = -sign_;
        c[axis] = face == PYRO_PERIODIC ? (low ? size[axis] - 1 : 0) : (low ? 0 : size[axis] - 1);
    }
    return sign_ * coarse_pressure[coarse_first + c.x + size.x * (c.y + size.y * c.z)];
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    c.x = 2 * c.x + ((c.y + c.z + 1) & 1);
    if (any(greaterThanEqual(c, LEVEL_SIZE))) return;
    ivec3 near = c / ivec3(coarser), other = ivec3(0);
    for (int axis = 0; axis < 3; axis++) // the neighbour on the side where the cell lies
        if (coarser[axis] > 1.0) other[axis] = (c[axis] & 1) == 0 ? -1 : 1;
    float sum = 0.0;
    for (int i = 0; i < 8; i++) {
        ivec3 far = ivec3(i & 1, i >> 1 & 1, i >> 2);
        vec3 w = mix(vec3(0.75), vec3(0.25), vec3(far));
        sum += w.x * w.y * w.z * coarse(near + far * other);
    }
    pressure[level_at(c)] += OVER * sum;
}
