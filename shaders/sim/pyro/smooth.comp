// Half a sweep of red-black Gauss-Seidel on one level: all cells of one colour.
layout(local_size_x = 4, local_size_y = 8, local_size_z = 8) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/levels.glsl"

uniform int colour;
layout(std430) buffer PyroPressure { float pressure[]; };
layout(std430) readonly buffer PyroRight { float right[]; };
LEVEL_AROUND(pressure_around, pressure)

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    c.x = 2 * c.x + ((c.y + c.z + colour) & 1);
    if (any(greaterThanEqual(c, LEVEL_SIZE))) return;
    vec2 around = pressure_around(c);
    int at = level_at(c);
    pressure[at] = around.y > 0.0 ? (around.x - right[at]) / around.y : 0.0;
}
