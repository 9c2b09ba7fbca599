// The end of a step: velocities less the differences of pressure.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"

layout(std430) readonly buffer PyroPressure { float pressure[]; };
layout(std430) buffer PyroVelocityTo { PYRO_FOUR velocity_to[]; };

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int at = pyro_at(c);
    float own = pressure[at];
    vec3 push = vec3(0.0);
    for (int axis = 0; axis < 3; axis++) {
        ivec3 below = c;
        below[axis] = pyro_into(axis, c[axis] - 1);
        bool stays = c[axis] == 0 && PYRO_LOW[axis] != PYRO_PERIODIC;
        push[axis] = stays ? 0.0 : own - pressure[pyro_at(below)];
    }
    velocity_to[at] = pyro_store(pyro_load(velocity_to[at]) - vec4(push, 0.0));
}
