// The gas moves along z, the last of three sweeps (carry.comp), then burns and cools. Its expansion goes
// to the pressure's right-hand side. A thread does four cells along z.
#define PYRO_ON_GAS
#define SWEEP SWEEP_Z
layout(local_size_x = 64) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/present.glsl"
#include "sim/pyro/flux.glsl"
#include "sim/pyro/burn.glsl"
#if PYRO_PREMIXED
#include "sim/pyro/flame.glsl"
#endif

uniform float cell;     // of the velocity, m
uniform int present_to; // where the marks of the next state begin
layout(std430) writeonly buffer PyroGasTo { PYRO_FOUR gas_to[]; };
layout(std430) writeonly buffer PyroExpansion { float expands[]; }; // m/s, across a cell
#if PYRO_RATIO == 2
layout(std430) writeonly buffer PyroDensity { float densities[]; }; // by that of the surroundings
#endif

#if PYRO_SMOKE
layout(std430) writeonly buffer PyroSmokeTo { float smoke_to[]; };
#endif

#if PYRO_OUTFLOW
uniform sampler3D force; // its fourth: how much gas comes out of a place in a second, by its volume
float outflow_at(ivec3 c, vec3 size) { // m/s, across a cell of the velocity
    return cell * textureLod(force, (vec3(c) + 0.5) / size, 0.0).w;
}
#else
#define outflow_at(c, size) 0.0
#endif

const float NOTHING = 1e-5; // next to
shared uint holds;

// Half a brick in which next to nothing is left becomes clean air.
void settle(ivec3 first) {
    barrier();
    if (gl_LocalInvocationIndex == 0u) present[present_to + half_brick_at(ivec3(gl_WorkGroupID))] = holds;
    if (holds != 0u) return;
    for (int i = 0; i < 4; i++) {
        int at = pyro_at(first + ivec3(0, 0, i));
        gas_to[at] = pyro_store(vec4(0.0));
#if PYRO_SMOKE
        smoke_to[at] = 0.0;
#endif
    }
}

void keep(ivec3 c, vec4 packed) {
    if (any(greaterThan(abs(packed), vec4(NOTHING)))) holds = 1u;
    gas_to[pyro_at(c)] = pyro_store(packed);
}

#if PYRO_SMOKE
void keep_smoke(ivec3 c, float packed) {
    if (packed > NOTHING) holds = 1u;
    smoke_to[pyro_at(c)] = packed;
}

// Smoke goes by volume, too, when it is packed. Of a cell whose gas was `before`, packed, and is `gas` after
// it has burnt.
float smoke_after_burning(float smoke, vec4 before, vec4 gas) {
    vec4 was = pyro_unpack(before);
    float made = smoke_yield * (gas.PYRO_BURNT - max(was.PYRO_BURNT, 0.0));
    float by_mass = smoke_kept * (max(smoke, 0.0) * pyro_temperature(was) / ambient + made);
    return by_mass * ambient / pyro_temperature(gas);
}
#endif

#if PYRO_RATIO == 2
// ---- cells of a larger cell of the velocity ----------------------------------------------------
// Gas in one of eight that expands more than they do on average pushes the rest of it into those that
// expand less: the velocity, of which they have one, would leave it where it is.
shared vec4 cells[4][64]; // by z, then y, then x: what they hold, packed
shared float grew[4][64]; // their expansion
shared vec2 parts[2][64]; // of two cells along z each: sums of expansion and density
shared uint grows;
#if PYRO_SMOKE
shared float smokes[4][64];
#endif

uint sibling(uint thread, uint i) {
    return (thread & ~9u) + (i & 1u) + 8u * ((i >> 1) & 1u);
}

// Of the two of a thread's cells at `z` and above it.
void share_out(uint z, uint thread, inout vec4 low, inout vec4 high, inout vec2 smoke) {
    float mean = 0.0, more = 0.0;
    for (uint i = 0u; i < 8u; i++) mean += 0.125 * grew[z + (i >> 2)][sibling(thread, i)];
    vec4 given = vec4(0.0);
    float smoke_given = 0.0;
    for (uint i = 0u; i < 8u; i++) {
        uint at = sibling(thread, i), level = z + (i >> 2);
        float gives = max(grew[level][at] - mean, 0.0);
        more += gives;
        given += gives * cells[level][at];
#if PYRO_SMOKE
        smoke_given += gives * smokes[level][at];
#endif
    }
    given /= max(more, 1e-12);
    vec2 own = vec2(grew[z][thread], grew[z + 1u][thread]);
    vec2 takes = max(mean - own, 0.0), keeps = 1.0 + mean - takes; // it gives of what it is
    low = (low * keeps.x + takes.x * given) / (1.0 + mean);
    high = (high * keeps.y + takes.y * given) / (1.0 + mean);
    smoke = (smoke * keeps + takes * smoke_given / max(more, 1e-12)) / (1.0 + mean);
}

// Expansion and density of a cell of the velocity: the mean of eight. The group has 4 x 4 x 2 of them.
void hand_on() {
    uint i = gl_LocalInvocationIndex, z = i >> 4, thread = 2u * (i & 3u) + 16u * ((i >> 2) & 3u);
    if (i >= 32u) return;
    vec2 sum = vec2(0.0);
    for (uint k = 0u; k < 4u; k++) sum += parts[z][sibling(thread, k)];
    ivec3 c = ivec3(gl_WorkGroupID) * ivec3(4, 4, 2) + ivec3(i & 3u, (i >> 2) & 3u, z);
    int at = pyro_flow_at(c);
    expands[at] = cell / dt * 0.125 * sum.x + outflow_at(c, vec3(PYRO_SIZE / PYRO_RATIO));
    densities[at] = 0.125 * sum.y;
}

void keep_all(ivec3 first) {
    uint thread = gl_LocalInvocationIndex;
    barrier();
    for (uint z = 0u; z < 4u; z += 2u) {
        vec4 low = cells[z][thread], high = cells[z + 1u][thread];
        vec2 smoke = vec2(0.0);
#if PYRO_SMOKE
        smoke = vec2(smokes[z][thread], smokes[z + 1u][thread]);
#endif
        if (grows != 0u) share_out(z, thread, low, high, smoke);
        keep(first + ivec3(0, 0, z), low);
        keep(first + ivec3(0, 0, z + 1u), high);
#if PYRO_SMOKE
        keep_smoke(first + ivec3(0, 0, z), smoke.x);
        keep_smoke(first + ivec3(0, 0, z + 1u), smoke.y);
#endif
        parts[z >> 1][thread] = vec2(grew[z][thread] + grew[z + 1u][thread],
                                     pyro_density(pyro_unpack(low)) + pyro_density(pyro_unpack(high)));
    }
    settle(first);
    hand_on();
}
#endif

void main() {
    ivec3 c = first_of_half_brick() + ivec3(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3, 0);
    const ivec3 first = c;
    if (gl_LocalInvocationIndex == 0u) holds = 0u;
#if PYRO_RATIO == 2
    if (gl_LocalInvocationIndex == 0u) grows = 0u;
#endif
    bool near = is_near_gas();
    gas_sweep s;
    if (near) s = gas_begin(c);
#if PYRO_SMOKE
    smoke_sweep smokes_;
    if (near) smokes_ = smoke_begin(c);
#endif
    for (int i = 0; i < 4; i++) {
        vec4 g = vec4(0.0);
        float grown = 0.0, brought = 0.0; // expansion in this step; progress
        float smoke = 0.0;
        if (near) {
            float low_way = s.way;
            vec4 packed = gas_next(s, c);
            g = pyro_unpack(packed);
#if PYRO_PREMIXED
            vec3 mean = 0.5 * vec3(way_x(c) + way_x(c + ivec3(1, 0, 0)), way_y(c) + way_y(c + ivec3(0, 1, 0)),
                                   low_way + s.way);
            brought = flame(vec3(c) + 0.5 - mean, pyro_temperature(g) / ambient);
#endif
            grown = pyro_clean(pyro_burn(g, brought));
#if PYRO_SMOKE
            smoke = pyro_clean(smoke_after_burning(smoke_next(smokes_, c), packed, g));
#endif
        }
#if PYRO_RATIO == 2
        cells[i][gl_LocalInvocationIndex] = pyro_pack(g);
        grew[i][gl_LocalInvocationIndex] = grown;
#if PYRO_SMOKE
        smokes[i][gl_LocalInvocationIndex] = smoke;
#endif
        if (abs(grown) > 1e-6) grows = 1u;
#else
        keep(c, pyro_pack(g));
#if PYRO_SMOKE
        keep_smoke(c, smoke);
#endif
        expands[pyro_at(c)] = cell / dt * grown + outflow_at(c, vec3(PYRO_SIZE));
#endif
        c.z++;
    }
#if PYRO_RATIO == 2
    keep_all(first);
#else
    settle(first);
#endif
}
