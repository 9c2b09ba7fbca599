// Half a sweep of red-black Gauss-Seidel on one level: all cells of one colour.
layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/levels.glsl"

uniform int colour;
layout(std430) buffer PyroPressure { float pressure[]; };
layout(std430) readonly buffer PyroRight { float right[]; };
LEVEL_COEFFICIENTS

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    c.x = 2 * c.x + ((c.y + c.z + colour) & 1);
    if (any(greaterThanEqual(c, LEVEL_SIZE))) return; // a group has 16 cells along x
    level_near n = level_near_of(c);
    LEVEL_WEIGH(n)
    float sum;
    LEVEL_SUM(pressure, n, sum)
    int at = level_at(n);
    pressure[at] = n.all > 0.0 ? (sum - right[at]) / n.all : 0.0;
}
