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
#if PYRO_RATIO == 2
layout(std430) readonly buffer PyroDensity { float densities[]; }; // by that of the surroundings
#else
layout(std430) readonly buffer PyroGas { PYRO_FOUR gas[]; }; // as it is after the step
#endif
layout(std430) writeonly buffer PyroVelocityTo { PYRO_FOUR velocity_to[]; };
#if PYRO_CORRECTS
layout(std430) readonly buffer PyroVelocityHat { PYRO_FOUR velocity_hat[]; };
#endif
#if PYRO_FORCE
uniform sampler3D force; // m/s^2
#endif
#if PYRO_CONFINES
layout(std430) readonly buffer PyroCurl { PYRO_FOUR curl[]; };
#endif
#endif

// What a component was where the gas was, with the least and the most of what is around.
#define BACK(name, component, face)                                                                \
    vec3 name(vec3 from) {                                                                         \
        pyro_span s = pyro_span_at(pyro_into(from), face);                                         \
        vec4 low, high;                                                                            \
        PYRO_EIGHT(velocity, component, s, low, high)                                              \
        vec4 a = min(low, high), b = max(low, high);                                               \
        return vec3(pyro_mix(low, high, s.t), min(min(a.x, a.y), min(a.z, a.w)),                   \
                    max(max(b.x, b.y), max(b.z, b.w)));                                            \
    }
BACK(back_x, X, ivec3(1, 0, 0))
BACK(back_y, Y, ivec3(0, 1, 0))
BACK(back_z, Z, ivec3(0, 0, 1))

#ifdef PYRO_PREDICT
void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    pyro_near n = pyro_near_of(c);
    vec3 p = vec3(c) + 0.5, v;
    v.x = back_x(p - vec3(0.5, 0.0, 0.0) - reach * pyro_velocity_x(n)).x;
    v.y = back_y(p - vec3(0.0, 0.5, 0.0) - reach * pyro_velocity_y(n)).x;
    v.z = back_z(p - vec3(0.0, 0.0, 0.5) - reach * pyro_velocity_z(n)).x;
    velocity_hat[pyro_at(c)] = pyro_store(vec4(v, 0.0));
}
#else
#if PYRO_CORRECTS
// Half of what tracing there and back changes is taken away, within what is around.
#define CARRIED(name, component, face, back, own)                                                  \
    float name(vec3 p, vec3 way, float own) {                                                      \
        vec3 first = back(p - way);                                                                \
        vec4 low, high;                                                                            \
        pyro_span s = pyro_span_at(pyro_into(p + way), face);                                      \
        PYRO_EIGHT(velocity_hat, component, s, low, high)                                          \
        float value = clamp(first.x + 0.5 * (own - pyro_mix(low, high, s.t)), first.y, first.z);   \
        return pyro_is_beyond(p - way) || pyro_is_beyond(p + way) ? first.x : value;               \
    }
#else
#define CARRIED(name, component, face, back, own)                                                  \
    float name(vec3 p, vec3 way, float own) {                                                      \
        return back(p - way).x;                                                                    \
    }
#endif
CARRIED(carried_x, X, ivec3(1, 0, 0), back_x, own)
CARRIED(carried_y, Y, ivec3(0, 1, 0), back_y, own)
CARRIED(carried_z, Z, ivec3(0, 0, 1), back_z, own)

vec3 carried(ivec3 c, pyro_near n) {
    vec3 p = vec3(c) + 0.5, x = pyro_velocity_x(n), y = pyro_velocity_y(n), z = pyro_velocity_z(n);
    return vec3(carried_x(p - vec3(0.5, 0.0, 0.0), reach * x, x.x),
                carried_y(p - vec3(0.0, 0.5, 0.0), reach * y, y.y),
                carried_z(p - vec3(0.0, 0.0, 0.5), reach * z, z.z));
}

// Upwards acceleration of a cell, m/s^2: lighter gas rises, and moves what it pushes aside, too.
float buoyancy(int at) {
#if PYRO_RATIO == 2
    float density = densities[at];
#else
    float density = pyro_density(pyro_unpack(pyro_load(gas[at])));
#endif
    return gravity * 2.0 * (1.0 - density) / (1.0 + density);
}

vec3 limit(vec3 v) {
    return clamp(pyro_clean(vec4(v, 0.0)).xyz, -max_speed, max_speed);
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    pyro_near n = pyro_near_of(c);
    int at = n.cell.x + n.cell.y + n.cell.z;
    vec3 v = carried(c, n) + dt * acceleration;
    v.z += 0.5 * dt * (buoyancy(at) + buoyancy(n.cell.x + n.cell.y + n.below.z));
#if PYRO_FORCE
    v += dt * textureLod(force, (vec3(c) + 0.25) / vec3(PYRO_SIZE), 0.0).xyz; // amid the three faces
#endif
#if PYRO_CONFINES
    vec3 below = vec3(PYRO_X(curl[n.below.x + n.cell.y + n.cell.z]),
                      PYRO_Y(curl[n.cell.x + n.below.y + n.cell.z]),
                      PYRO_Z(curl[n.cell.x + n.cell.y + n.below.z]));
    v += confinement * 0.5 * (pyro_load(curl[at]).xyz + below);
#endif
    v = limit(v);
    bvec3 first = equal(c, ivec3(0));
    v = mix(v, vec3(0.0), both(first, equal(PYRO_LOW, ivec3(PYRO_WALL))));
    v = mix(v, inflow, both(first, equal(PYRO_LOW, ivec3(PYRO_INFLOW))));
    velocity_to[at] = pyro_store(vec4(v, 0.0));
}
#endif
