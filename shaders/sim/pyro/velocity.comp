// What the gas does to its own velocity in a step: it carries it along, in three sweeps (stir.glsl), of which
// those along x, and, with CARRY_Y, along y, do nothing else; after that along z forces push.
#ifdef CARRY_X
#define SWEEP SWEEP_X
#elif defined(CARRY_Y)
#define SWEEP SWEEP_Y
#else
#define SWEEP SWEEP_Z
#define PUSHES
#endif
#if PYRO_SIDE_BY_SIDE && defined(CARRY_X)
layout(local_size_x = 96) in;
#else
layout(local_size_x = 64) in; // of a half brick of 8 x 8 x 4 cells
#endif
#include "sim/pyro/state.glsl"
#include "sim/pyro/stir.glsl"

layout(std430) writeonly buffer PyroFlowInto { PYRO_FOUR flow_into[]; }; // after the sweep
#ifdef PUSHES
uniform float dt;
uniform float gravity;      // m/s^2, downwards along z
uniform vec3 acceleration;  // m/s^2
uniform float confinement;  // m/s of a step, by 1 m/s of difference across a cell
uniform float max_speed;    // m/s
#include "sim/pyro/density.glsl"
#if PYRO_FORCE
uniform sampler3D force; // m/s^2
#endif
#if PYRO_GUIDED
uniform sampler3D pull;   // m/s, in its first texels, as many as
uniform vec3 guide_cells; // in the box along each axis
vec3 pull_at(vec3 p) { // linear between its cells; `p` in cells of the velocity
    vec3 at = clamp(p / vec3(PYRO_SIZE) * guide_cells, vec3(0.5), guide_cells - 0.5);
    return textureLod(pull, at / vec3(textureSize(pull, 0)), 0.0).xyz;
}
#endif
#if PYRO_TURBULENT
layout(std430) readonly buffer PyroPotential { PYRO_FOUR potential[]; }; // turbulence.comp writes it
vec3 turbulence_at(pyro_near n) { // its curl at the lower faces of a cell
    vec3 own = pyro_load(potential[n.cell.x + n.cell.y + n.cell.z]).xyz;
    vec3 x = pyro_load(potential[n.next.x + n.cell.y + n.cell.z]).xyz - own;
    vec3 y = pyro_load(potential[n.cell.x + n.next.y + n.cell.z]).xyz - own;
    vec3 z = pyro_load(potential[n.cell.x + n.cell.y + n.next.z]).xyz - own;
    return vec3(y.z - z.y, z.x - x.z, x.y - y.x);
}
#endif
#if PYRO_CONFINES
layout(std430) readonly buffer PyroCurl { PYRO_FOUR curl[]; };
#endif

// Upwards acceleration between two cells, m/s^2. Where pressure does not know of densities, lighter gas moves
// what it pushes aside as if that were as light.
float buoyancy(int low, int high) {
    float a = pyro_density_of(low), b = pyro_density_of(high);
#if PYRO_VARIABLE
    return gravity * (2.0 - a - b) / (a + b);
#else
    return gravity * ((1.0 - a) / (1.0 + a) + (1.0 - b) / (1.0 + b));
#endif
}

vec3 limit(vec3 v) {
    return clamp(pyro_clean(vec4(v, 0.0)).xyz, -max_speed, max_speed);
}

// The velocity at the lower faces of a cell, when it has been carried there.
vec3 pushed(ivec3 c, vec3 v) {
    pyro_near n = pyro_near_of(c);
    int at = n.cell.x + n.cell.y + n.cell.z;
    v += dt * acceleration;
    v.z += dt * buoyancy(n.cell.x + n.cell.y + n.below.z, at);
#if PYRO_FORCE
    v += dt * textureLod(force, (vec3(c) + 0.25) / vec3(PYRO_SIZE), 0.0).xyz; // amid the three faces
#endif
#if PYRO_TURBULENT
    v += turbulence_at(n);
#endif
#if PYRO_GUIDED
    v += vec3(pull_at(vec3(c) + vec3(0.0, 0.5, 0.5)).x, pull_at(vec3(c) + vec3(0.5, 0.0, 0.5)).y,
              pull_at(vec3(c) + vec3(0.5, 0.5, 0.0)).z);
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
    return v;
}
#endif

#if PYRO_SIDE_BY_SIDE && defined(CARRY_X)
#include "sim/pyro/lines.glsl"
shared vec3 crossing[LINE_FACES], ways[LINE_FACES];

void main() {
    ivec3 first = ivec3(gl_WorkGroupID) * ivec3(8, 8, 4);
    for (int k = int(gl_LocalInvocationIndex); k < LINE_FACES; k += int(gl_WorkGroupSize.x)) {
        ivec3 c = first + line_face(k);
        ways[k] = ways_at(c, c.x);
        crossing[k] = fluxes_at(c, c.x, ways[k], volumes_at(c, c.x - 1), volumes_at(c, c.x));
    }
    barrier();
    for (int k = int(gl_LocalInvocationIndex); k < LINE_CELLS; k += int(gl_WorkGroupSize.x)) {
        ivec3 c = first + line_cell(k);
        int face = line_face_below(k);
        vec3 v = after_stir(c, volumes_at(c, c.x), ways[face], crossing[face], ways[face + 1], crossing[face + 1]);
        flow_into[pyro_at(c)] = pyro_store(vec4(v, 0.0));
    }
}
#else
void main() {
    ivec3 c = ivec3(gl_WorkGroupID) * ivec3(8, 8, 4);
    int i = int(gl_LocalInvocationIndex);
#if SWEEP == SWEEP_X
    c += ivec3(4 * (i & 1), (i >> 1) & 7, i >> 4);
#elif SWEEP == SWEEP_Y
    c += ivec3(i & 7, 4 * ((i >> 3) & 1), i >> 4);
#else
    c += ivec3(i & 7, i >> 3, 0);
#endif
    stir_state s = stir_begin(c);
    for (int k = 0; k < 4; k++) {
        vec3 v = stir_next(s, c);
#ifdef PUSHES
        v = pushed(c, v);
#endif
        flow_into[pyro_at(c)] = pyro_store(vec4(v, 0.0));
        c.ALONG++;
    }
}
#endif
