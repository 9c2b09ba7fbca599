// The velocity in the middle of a cell.
#ifndef SIM_PYRO_VELOCITY_GLSL
#define SIM_PYRO_VELOCITY_GLSL
#include "sim/pyro/faces.glsl"

layout(std430) readonly buffer PyroVelocity { PYRO_FOUR velocity[]; };

vec3 pyro_velocity_cell(pyro_near n) { // m/s
    vec3 low, high;
    PYRO_FACES(velocity, n, low, high)
    return 0.5 * (low + high);
}
#endif
