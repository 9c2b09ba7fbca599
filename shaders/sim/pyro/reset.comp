// Air at rest, or as fast as the wind: the gas, or, with FLOW, its velocity and pressure.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#ifndef FLOW
#define PYRO_ON_GAS
#endif
#include "sim/pyro/state.glsl"

#ifndef FLOW
layout(std430) writeonly buffer PyroGasTo { PYRO_FOUR gas_to[]; };

#if PYRO_SMOKE
layout(std430) writeonly buffer PyroSmokeTo { float smoke_to[]; };
#endif

void main() {
    int at = pyro_at(ivec3(gl_GlobalInvocationID));
    gas_to[at] = pyro_store(vec4(0.0));
#if PYRO_SMOKE
    smoke_to[at] = 0.0;
#endif
}
#else
uniform vec3 inflow; // m/s
layout(std430) writeonly buffer PyroVelocityTo { PYRO_FOUR velocity_to[]; };
layout(std430) writeonly buffer PyroPressure { float pressure[]; };
layout(std430) writeonly buffer PyroRight { float right[]; };

void main() {
    int at = pyro_at(ivec3(gl_GlobalInvocationID));
    pressure[at] = right[at] = 0.0;
    vec3 v = inflow;
    for (int axis = 0; axis < 3; axis++)
        if (PYRO_LOW[axis] == PYRO_WALL || PYRO_HIGH[axis] == PYRO_WALL) v[axis] = 0.0;
    velocity_to[at] = pyro_store(vec4(v, 0.0));
}
#endif
