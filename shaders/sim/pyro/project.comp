// The end of a step: velocities less the differences of pressure.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"

layout(std430) readonly buffer PyroPressure { float pressure[]; };
layout(std430) buffer PyroVelocityTo { PYRO_REAL velocity_to[]; };

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int at = pyro_at(c);
    float own = pressure[at];
    for (int axis = 0; axis < 3; axis++) {
        ivec3 below = c;
        below[axis] = pyro_into(axis, c[axis] - 1);
        if (c[axis] == 0 && PYRO_LOW[axis] != PYRO_PERIODIC) continue; // stays as advance left it
        int here = axis * PYRO_CELLS + at;
        velocity_to[here] = PYRO_REAL(float(velocity_to[here]) - (own - pressure[pyro_at(below)]));
    }
}
