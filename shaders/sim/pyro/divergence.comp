// What flows out of each cell, less its expansion: the pressure's right-hand side.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/sample.glsl"

layout(std430) readonly buffer PyroVelocityTo { PYRO_FOUR velocity_to[]; };
layout(std430) buffer PyroRight { float right[]; };

void main() {
    pyro_near n = pyro_near_of(ivec3(gl_GlobalInvocationID));
    int at = n.cell.x + n.cell.y + n.cell.z;
    vec3 low, high;
    PYRO_FACES(velocity_to, n, low, high)
    right[at] = dot(high - low, vec3(1.0)) - right[at];
}
