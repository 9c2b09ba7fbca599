// Where what is at a face, or in a cell, was a step before: along its own velocity (Stam 1999).
#ifndef SIM_PYRO_TRACE_GLSL
#define SIM_PYRO_TRACE_GLSL
#include "sim/pyro/sample.glsl"

uniform float reach; // cells in a step, by 1 m/s
layout(std430) readonly buffer PyroVelocity { PYRO_FOUR velocity[]; };
PYRO_FACE(pyro_face, velocity)

// In the middle of a cell, m/s.
vec3 pyro_velocity_cell(ivec3 c) {
    return 0.5 * vec3(pyro_face(0, c) + pyro_face(0, c + ivec3(1, 0, 0)),
                      pyro_face(1, c) + pyro_face(1, c + ivec3(0, 1, 0)),
                      pyro_face(2, c) + pyro_face(2, c + ivec3(0, 0, 1)));
}

// At the face of a cell: its own component, and the mean of the four of each other one around it.
vec3 pyro_velocity_face(const int axis, ivec3 c) {
    vec3 v;
    ivec3 below = c;
    below[axis] = pyro_into(axis, c[axis] - 1);
    for (int other = 0; other < 3; other++) {
        ivec3 step_ = ivec3(other == 0, other == 1, other == 2);
        v[other] = other == axis
                       ? pyro_face(axis, c)
                       : 0.25 * (pyro_face(other, c) + pyro_face(other, c + step_) +
                                 pyro_face(other, below) + pyro_face(other, below + step_));
    }
    return v;
}

vec3 pyro_middle(const int axis, ivec3 c) { // of a face; 3: of a cell
    vec3 p = vec3(c) + 0.5;
    if (axis < 3) p[axis] -= 0.5;
    return p;
}
#endif
