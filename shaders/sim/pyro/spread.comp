// How much volume leaves each cell along y and z together, across it: m/s (volumes.glsl).
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/faces.glsl"

layout(std430) readonly buffer PyroVelocity { PYRO_FOUR velocity[]; };
layout(std430) writeonly buffer PyroSpread { float spread[]; };

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    pyro_near n = pyro_near_of(c);
    vec3 low, high;
    PYRO_FACES(velocity, n, low, high)
    spread[n.cell.x + n.cell.y + n.cell.z] = high.y - low.y + high.z - low.z;
}
