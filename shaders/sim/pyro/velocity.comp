// What the gas does to its own velocity in a step: it carries it along, and forces push. MacCormack
// (Selle et al. 2008) takes two dispatches, of which the first, with PYRO_PREDICT, traces back
// alone; semi-Lagrangian advection takes the second alone.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/trace.glsl"

#ifdef PYRO_PREDICT
layout(std430) writeonly buffer PyroVelocityHat { PYRO_FOUR velocity_hat[]; };
#else
uniform float dt;
uniform float gravity;      // m/s^2, downwards along z
uniform vec3 acceleration;  // m/s^2
uniform float confinement;  // m/s of a step, by 1 m/s of difference across a cell
uniform float max_speed;    // m/s
layout(std430) readonly buffer PyroGas { PYRO_FOUR gas[]; }; // as it is after the step
layout(std430) writeonly buffer PyroVelocityTo { PYRO_FOUR velocity_to[]; };
#if PYRO_CORRECTS
layout(std430) readonly buffer PyroVelocityHat { PYRO_FOUR velocity_hat[]; };
#endif
#if PYRO_CONFINES
layout(std430) readonly buffer PyroCurl { PYRO_FOUR curl[]; };
#endif
#endif

float pyro_back(const int axis, ivec3 c, vec3 from, out float least, out float most) {
    pyro_span s = pyro_span_at(pyro_into(from), axis);
    vec4 low, high;
    PYRO_EIGHT(velocity, axis, s, low, high)
    pyro_close(axis, s, low, high);
    vec4 a = min(low, high), b = max(low, high);
    least = min(min(a.x, a.y), min(a.z, a.w));
    most = max(max(b.x, b.y), max(b.z, b.w));
    return pyro_mix(low, high, s.t);
}

#ifdef PYRO_PREDICT
float carried(const int axis, ivec3 c) {
    float least, most;
    vec3 from = pyro_middle(axis, c) - reach * pyro_velocity_face(axis, c);
    return pyro_back(axis, c, from, least, most);
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    velocity_hat[pyro_at(c)] = pyro_store(vec4(carried(0, c), carried(1, c), carried(2, c), 0.0));
}
#else
float carried(const int axis, ivec3 c) {
    float least, most;
    vec3 p = pyro_middle(axis, c), way = reach * pyro_velocity_face(axis, c);
    float first = pyro_back(axis, c, p - way, least, most);
#if PYRO_CORRECTS
    if (pyro_is_beyond(p - way) || pyro_is_beyond(p + way)) return first;
    pyro_span s = pyro_span_at(pyro_into(p + way), axis);
    vec4 low, high;
    PYRO_EIGHT(velocity_hat, axis, s, low, high)
    pyro_close(axis, s, low, high);
    first += 0.5 * (pyro_face(axis, c) - pyro_mix(low, high, s.t));
    return clamp(first, least, most);
#else
    return first;
#endif
}

// Upwards acceleration of a cell, m/s^2: lighter gas rises, and moves what it pushes aside, too.
float buoyancy(int at) {
    float density = pyro_density(pyro_load(gas[at]));
    return gravity * 2.0 * (1.0 - density) / (1.0 + density);
}

float limit(float v) {
    return clamp(pyro_clean(v), -max_speed, max_speed);
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int at = pyro_at(c);
    vec3 v = vec3(carried(0, c), carried(1, c), carried(2, c)) + dt * acceleration;
    v.z += 0.5 * dt * (buoyancy(at) + buoyancy(pyro_at(ivec3(c.xy, pyro_into(2, c.z - 1)))));
#if PYRO_CONFINES
    vec3 here = pyro_load(curl[at]).xyz;
    for (int axis = 0; axis < 3; axis++) {
        ivec3 below = c;
        below[axis] = pyro_into(axis, c[axis] - 1);
        v[axis] += confinement * 0.5 * (here[axis] + pyro_load(curl[pyro_at(below)], axis));
    }
#endif
    for (int axis = 0; axis < 3; axis++) {
        v[axis] = limit(v[axis]);
        if (c[axis] == 0 && PYRO_LOW[axis] == PYRO_WALL) v[axis] = 0.0;
        if (c[axis] == 0 && PYRO_LOW[axis] == PYRO_INFLOW) v[axis] = inflow[axis];
    }
    velocity_to[at] = pyro_store(vec4(v, 0.0));
}
#endif
