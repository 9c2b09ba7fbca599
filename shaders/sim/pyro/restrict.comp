// What a level's pressure leaves of its right-hand side is that of the next coarser one, whose own
// pressure begins with 0. After a sweep the cells of colour 1, which came last, leave nothing.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/levels.glsl"

uniform vec3 coarse_size, coarser; // cells; of the finer level along each axis for one of them
uniform int coarse_first;
layout(std430) readonly buffer PyroPressure { float pressure[]; };
layout(std430) readonly buffer PyroRight { float right[]; };
layout(std430) buffer PyroCoarsePressure { float coarse_pressure[]; };
layout(std430) buffer PyroCoarseRight { float coarse_right[]; };
LEVEL_COEFFICIENTS

float left_of(ivec3 c) {
    level_near n = level_near_of(c);
    LEVEL_WEIGH(n)
    float around;
    LEVEL_SUM(pressure, n, around)
    int at = level_at(n);
    return right[at] - (around - n.all * pressure[at]);
}

void main() {
    ivec3 to = ivec3(gl_GlobalInvocationID), size = ivec3(coarse_size), n = ivec3(coarser);
    if (any(greaterThanEqual(to, size))) return;
    float sum = 0.0;
    for (int i = 0; i < n.x * n.y * n.z; i++) {
        ivec3 c = to * n + ivec3(i % n.x, i / n.x % n.y, i / (n.x * n.y));
        if (((c.x + c.y + c.z) & 1) == 0) sum += left_of(c);
    }
    int at = coarse_first + to.x + size.x * (to.y + size.y * to.z);
    coarse_right[at] = sum / float(n.x * n.y * n.z);
    coarse_pressure[at] = 0.0;
}
