// Gives burning gas what a source holds (pass/air/pyro_source.comp): cells that are inside take on its
// values, faces the mean of the cells on both sides that are. Meshes are where they are at the step.
// A thread does a cell and the faces at its lower ends, or, of a larger cell of velocity, the first one.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#define PYRO_ON_GAS
#include "sim/pyro/state.glsl"
#define AIR_NX uint(PYRO_NX)
#define AIR_NY uint(PYRO_NY)
#include "pass/air/source.glsl"
uniform float burns_above; // K
layout(std430) buffer PyroGas { PYRO_FOUR gas[]; };
#if PYRO_SMOKE
layout(std430) buffer PyroSmoke { float smokes[]; };
#endif
uniform int present_from; // where the marks of this state begin
layout(std430) buffer PyroActive { uint present[]; }; // half bricks that hold more than clean air
layout(std430) buffer PyroVelocity { PYRO_FOUR velocity[]; };

// The velocity that a cell is given, and 1 where it is.
vec4 push_of(uvec3 cell) {
    uvec4 values = values_at(cell);
    float inside = unpackHalf2x16(values.y).y;
    if (inside == 0.0) return vec4(0.0);
    vec3 v = vec3(unpackHalf2x16(values.z), unpackHalf2x16(values.w).x);
#if MESHES
    v += motion_at(cell);
#endif
    return vec4(v, 1.0);
}

void give_gas(uvec3 cell, int at) {
    uvec4 values = values_at(cell);
    vec2 a = unpackHalf2x16(values.x), b = unpackHalf2x16(values.y);
    if (b.y == 0.0) return;
    vec4 g = pyro_unpack(pyro_load(gas[at])), was = g;
#if HAS_TEMPERATURE
    g.PYRO_WARMTH = mix(g.PYRO_WARMTH, a.y - ambient, share);
#endif
    float air = PYRO_AIR / pyro_temperature(g); // kg/m^3
#if PYRO_SMOKE
    float smoke = smokes[at] * pyro_temperature(was) / ambient; // by mass
#if HAS_SMOKE
    smoke = mix(smoke, unpackHalf2x16(values.w).y / air, share);
#endif
    smokes[at] = smoke * ambient / pyro_temperature(g);
#endif
#if HAS_FUEL
    g.PYRO_FUEL = mix(g.PYRO_FUEL, a.x / air, share);
    g.PYRO_BURNT = mix(g.PYRO_BURNT, 0.0, share);
#endif
#if PYRO_PREMIXED && HAS_TEMPERATURE
    if (a.y > burns_above) { // a spark
        g.PYRO_BURNT += share * g.PYRO_FUEL;
        g.PYRO_FUEL -= share * g.PYRO_FUEL;
    }
#endif
#if HAS_SOOT
    g.PYRO_SOOT = mix(g.PYRO_SOOT, b.x / air, share);
#endif
    gas[at] = pyro_store(pyro_pack(g));
    uvec3 place = cell / uvec3(8, 8, 4);
    present[uint(present_from) + place.x + uint(PYRO_NX / 8) * (place.y + uint(PYRO_NY / 8) * place.z)] = 1u;
}

// A cell of the velocity: the mean of those of the gas in it that are given some.
vec4 push_on(uvec3 cell) {
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < uint(PYRO_RATIO * PYRO_RATIO * PYRO_RATIO); i++)
        sum += push_of(uint(PYRO_RATIO) * cell + uvec3(i & 1u, (i >> 1) & 1u, i >> 2));
    return sum / max(sum.w, 1.0);
}

void give_velocity(uvec3 cell) {
    int at = pyro_flow_at(ivec3(cell));
    vec4 here = push_on(cell), v = pyro_load(velocity[at]);
    for (int axis = 0; axis < 3; axis++) {
        uvec3 below = cell;
        below[axis]--; // beyond the box: of no source
        vec4 there = push_on(below);
        float sum = here.w + there.w;
        if (sum == 0.0 || (cell[axis] == 0u && PYRO_LOW[axis] != PYRO_PERIODIC)) continue;
        v[axis] = mix(v[axis], (here[axis] + there[axis]) / sum, share);
    }
    velocity[at] = pyro_store(v);
}

void main() {
    const uint n = uint(PYRO_RATIO);
    uvec3 cell = gl_GlobalInvocationID + uvec3(first) / n * n;
    if (any(greaterThanEqual(cell, uvec3(PYRO_SIZE)))) return;
    give_gas(cell, pyro_at(ivec3(cell)));
    if (HAS_VELOCITY == 0 && velocity_factor == 0.0) return;
    if (all(equal(cell % n, uvec3(0u)))) give_velocity(cell / n);
}
