// Where what is at a face, or in a cell, was a step before: along its own velocity (Stam 1999).
#ifndef SIM_PYRO_TRACE_GLSL
#define SIM_PYRO_TRACE_GLSL
#include "sim/pyro/sample.glsl"

uniform float reach; // cells in a step, by 1 m/s
layout(std430) readonly buffer PyroVelocity { PYRO_FOUR velocity[]; };

// In the middle of a cell, m/s.
vec3 pyro_velocity_cell(pyro_near n) {
    vec3 low, high;
    PYRO_FACES(velocity, n, low, high)
    return 0.5 * (low + high);
}

// The mean of four velocities along y, at the lower and the higher face of two cells; and so on.
float mean_y(int a, int b, pyro_near n) {
    vec2 high = vec2(PYRO_Y(velocity[a + n.next.y]), PYRO_Y(velocity[b + n.next.y]));
    if (n.ends.y) high = vec2(inflow.y * PYRO_END_FLOWS.y);
    return 0.25 * (PYRO_Y(velocity[a + n.face.y]) + PYRO_Y(velocity[b + n.face.y]) + high.x + high.y);
}
float mean_x(int a, int b, pyro_near n) {
    vec2 high = vec2(PYRO_X(velocity[a + n.next.x]), PYRO_X(velocity[b + n.next.x]));
    if (n.ends.x) high = vec2(inflow.x * PYRO_END_FLOWS.x);
    return 0.25 * (PYRO_X(velocity[a + n.face.x]) + PYRO_X(velocity[b + n.face.x]) + high.x + high.y);
}
float mean_z(int a, int b, pyro_near n) {
    vec2 high = vec2(PYRO_Z(velocity[a + n.next.z]), PYRO_Z(velocity[b + n.next.z]));
    if (n.ends.z) high = vec2(inflow.z * PYRO_END_FLOWS.z);
    return 0.25 * (PYRO_Z(velocity[a + n.face.z]) + PYRO_Z(velocity[b + n.face.z]) + high.x + high.y);
}

// At the faces of a cell at its lower ends along x, y, z.
vec3 pyro_velocity_x(pyro_near n) {
    return vec3(PYRO_X(velocity[n.face.x + n.cell.y + n.cell.z]),
                mean_y(n.cell.x + n.cell.z, n.below.x + n.cell.z, n),
                mean_z(n.cell.x + n.cell.y, n.below.x + n.cell.y, n));
}
vec3 pyro_velocity_y(pyro_near n) {
    return vec3(mean_x(n.cell.y + n.cell.z, n.below.y + n.cell.z, n),
                PYRO_Y(velocity[n.cell.x + n.face.y + n.cell.z]),
                mean_z(n.cell.x + n.cell.y, n.cell.x + n.below.y, n));
}
vec3 pyro_velocity_z(pyro_near n) {
    return vec3(mean_x(n.cell.y + n.cell.z, n.cell.y + n.below.z, n),
                mean_y(n.cell.x + n.cell.z, n.cell.x + n.below.z, n),
                PYRO_Z(velocity[n.cell.x + n.cell.y + n.face.z]));
}
#endif
