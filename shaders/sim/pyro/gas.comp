// What the gas carries in a step, warmth, fuel, what has burnt, and soot: it moves, burns and cools.
// Its expansion goes to the pressure's right-hand side. As velocity.comp, in one dispatch or two.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#define PYRO_ON_GAS
#include "sim/pyro/state.glsl"
#include "sim/pyro/trace.glsl"

layout(std430) readonly buffer PyroGas { PYRO_FOUR gas[]; };
#ifdef PYRO_PREDICT
layout(std430) writeonly buffer PyroGasHat { PYRO_FOUR gas_hat[]; };
#else
#include "sim/pyro/burn.glsl"
uniform float cell; // of the velocity, m
layout(std430) writeonly buffer PyroGasTo { PYRO_FOUR gas_to[]; };
layout(std430) writeonly buffer PyroRight { float right[]; }; // m/s: expansion across a cell
#if PYRO_CORRECTS
layout(std430) readonly buffer PyroGasHat { PYRO_FOUR gas_hat[]; };
#endif
#endif

// ---- where there is gas -------------------------------------------------------------------------

// Half bricks, as many cells as a group has, that hold more than clean air. Another one, and all within
// eight cells around it, is left as it is: nothing comes farther in a step.
uniform int everywhere; // 1: it is not known where
uniform int present_from, present_to; // where the marks of this state, and of the next one, begin
layout(std430) buffer PyroActive { uint present[]; };
shared uint busy;

const ivec3 HALF_BRICKS = PYRO_SIZE / ivec3(8, 8, 4);

bool is_near_gas() {
    uint i = gl_LocalInvocationIndex;
    if (i == 0u) busy = uint(everywhere);
    barrier();
    if (i < 45u) {
        ivec3 to = ivec3(gl_WorkGroupID) + ivec3(i % 3u, i / 3u % 3u, i / 9u) - ivec3(1, 1, 2);
        to = mix(clamp(to, ivec3(0), HALF_BRICKS - 1), (to + HALF_BRICKS) % HALF_BRICKS, PYRO_AROUND);
        if (present[present_from + to.x + HALF_BRICKS.x * (to.y + HALF_BRICKS.y * to.z)] != 0u) busy = 1u;
    }
    barrier();
    return busy != 0u;
}

#ifndef PYRO_PREDICT
shared uint holds;

// What a group's cells hold, or clean air where that is next to nothing in all of them.
vec4 settle(vec4 packed) {
    if (gl_LocalInvocationIndex == 0u) holds = 0u;
    barrier();
    if (any(greaterThan(abs(packed), vec4(1e-5)))) holds = 1u;
    barrier();
    uint group = uint(present_to) + (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (gl_LocalInvocationIndex == 0u) present[group] = holds;
    return holds != 0u ? packed : vec4(0.0);
}
#endif

// ---- where gas comes from ---------------------------------------------------------------------

#if PYRO_RATIO == 2
uniform sampler3D carrier; // velocity in the middle of its own cells, m/s

const bvec3 WALL_LOW = equal(PYRO_LOW, ivec3(PYRO_WALL)), WALL_HIGH = equal(PYRO_HIGH, ivec3(PYRO_WALL));

// Before the first middle at a wall, what flows across it falls to 0.
vec3 velocity_at(vec3 p) {
    vec3 low = mix(vec3(1.0), clamp(p, 0.0, 1.0), WALL_LOW);
    vec3 high = mix(vec3(1.0), clamp(vec3(PYRO_SIZE) - p, 0.0, 1.0), WALL_HIGH);
    return low * high * textureLod(carrier, p / vec3(PYRO_SIZE), 0.0).xyz;
}

// By the velocity in the middle of the way (Runge and Kutta's second order), since it may be several
// cells long.
vec3 step_of(ivec3 c, float turn) {
    vec3 p = vec3(c) + 0.5;
    return reach * velocity_at(p - 0.5 * turn * reach * velocity_at(p));
}
#else
vec3 step_of(ivec3 c, float turn) {
    return reach * pyro_velocity_cell(pyro_near_of(c));
}
#endif

// The way of a step that ends, or, with -1, begins in the middle of a cell, in cells.
vec3 way_of(ivec3 c, float turn) {
    return clamp(step_of(c, turn), -7.0, 7.0); // is_near_gas looks so far
}

// The eight values around a place.
#define GAS_EIGHT(from, s, v)                                                                      \
    {                                                                                              \
        int a_ = s.low.y + s.low.z, b_ = s.high.y + s.low.z;                                       \
        int c_ = s.low.y + s.high.z, d_ = s.high.y + s.high.z;                                     \
        v[0] = pyro_load(from[a_ + s.low.x]), v[1] = pyro_load(from[a_ + s.high.x]);               \
        v[2] = pyro_load(from[b_ + s.low.x]), v[3] = pyro_load(from[b_ + s.high.x]);               \
        v[4] = pyro_load(from[c_ + s.low.x]), v[5] = pyro_load(from[c_ + s.high.x]);               \
        v[6] = pyro_load(from[d_ + s.low.x]), v[7] = pyro_load(from[d_ + s.high.x]);               \
    }

vec4 gas_mix(vec4 v[8], vec3 t) {
    vec4 low = mix(mix(v[0], v[1], t.x), mix(v[2], v[3], t.x), t.y);
    return mix(low, mix(mix(v[4], v[5], t.x), mix(v[6], v[7], t.x), t.y), t.z);
}

// What comes through a face is clean air.
vec4 gas_back(vec3 from, out vec4 least, out vec4 most) {
    vec4 v[8];
    pyro_span s = pyro_span_at(pyro_into(from), ivec3(0));
    GAS_EIGHT(gas, s, v)
    least = min(min(min(v[0], v[1]), min(v[2], v[3])), min(min(v[4], v[5]), min(v[6], v[7])));
    most = max(max(max(v[0], v[1]), max(v[2], v[3])), max(max(v[4], v[5]), max(v[6], v[7])));
    return pyro_is_beyond(from) ? vec4(0.0) : gas_mix(v, s.t);
}

#ifdef PYRO_PREDICT
void main() {
    vec4 least, most, value = vec4(0.0);
    ivec3 c = ivec3(gl_GlobalInvocationID);
    if (is_near_gas()) value = gas_back(vec3(c) + 0.5 - way_of(c, 1.0), least, most);
    gas_hat[pyro_at(c)] = pyro_store(value);
}
#else
#if PYRO_CORRECTS
// MacCormack's corrections take from some cells what they add to others. Clamps spoil that: edges lag
// behind the flow, and a plume that draws air in had three times the heat that it was given. So what is
// more of them is scaled by what was less in the last step, over all cells.
uniform int balances; // 0: there is no last step
layout(std430) readonly buffer PyroSums { vec4 sums[]; }; // from 4: of what is added, of what is taken
layout(std430) writeonly buffer PyroReport { vec4 report[]; };
shared vec4 added[256], taken[256];

vec4 correction = vec4(0.0); // of this cell, before it is scaled

vec4 balance(vec4 own) {
    vec4 more = sums[4], less = sums[5];
    vec4 up = mix(vec4(1.0), less / max(more, 1e-30), greaterThan(more, less));
    vec4 down = mix(vec4(1.0), more / max(less, 1e-30), greaterThan(less, more));
    correction = own;
    return balances == 0 ? own : own * mix(down, up, greaterThan(own, vec4(0.0)));
}

void add_up_corrections() {
    uint i = gl_LocalInvocationIndex;
    added[i] = max(correction, 0.0);
    taken[i] = max(-correction, 0.0);
    // In few rounds, since each barrier is dear in software.
    for (uint n = 16u; n > 0u; n /= 16u) {
        barrier();
        vec4 more = vec4(0.0), less = vec4(0.0);
        for (uint k = 0u; k < 16u && i < n; k++) more += added[i + k * n], less += taken[i + k * n];
        barrier();
        if (i < n) added[i] = more, taken[i] = less;
    }
    uint group = (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (i == 0u) report[2u * group] = added[0], report[2u * group + 1u] = taken[0];
}
#endif

// What a cell at a wall keeps. Traces take it that gas comes through the wall or rests there: by half of
// what flows through the cell's other end more comes out of it than it had. Cells further in balance.
float kept_at_wall(ivec3 c, vec3 way) {
    bvec3 low = both(equal(c, ivec3(0)), equal(PYRO_LOW, ivec3(PYRO_WALL)));
    bvec3 high = both(equal(c, PYRO_SIZE - 1), equal(PYRO_HIGH, ivec3(PYRO_WALL)));
    return max(1.0 - dot(abs(way), vec3(low) + vec3(high)), 0.0);
}

vec4 carried(ivec3 c, int at) {
    vec4 least, most;
    vec3 p = vec3(c) + 0.5, way = way_of(c, 1.0);
    vec4 first = gas_back(p - way, least, most);
    float kept = kept_at_wall(c, way);
    if (kept < 1.0) return kept * first;
#if PYRO_CORRECTS
    vec4 v[8];
    vec3 on = p + (PYRO_RATIO == 2 ? way_of(c, -1.0) : way);
    pyro_span s = pyro_span_at(pyro_into(on), ivec3(0));
    GAS_EIGHT(gas_hat, s, v)
    if (pyro_is_beyond(p - way) || pyro_is_beyond(on)) return first;
    return first + balance(clamp(first + 0.5 * (pyro_load(gas[at]) - gas_mix(v, s.t)), least, most) - first);
#else
    return first;
#endif
}

#if PYRO_PREMIXED
float progress_mix(float v[8], vec3 t) {
    vec4 x = mix(vec4(v[0], v[2], v[4], v[6]), vec4(v[1], v[3], v[5], v[7]), t.x);
    vec2 y = mix(x.xz, x.yw, t.y);
    return mix(y.x, y.y, t.z);
}

#define PROGRESS_EIGHT(p, name, part)                                                              \
    float name[8];                                                                                 \
    vec3 part;                                                                                     \
    {                                                                                              \
        vec4 v_[8];                                                                                \
        pyro_span s_ = pyro_span_at(pyro_into(p), ivec3(0));                                       \
        GAS_EIGHT(gas, s_, v_)                                                                     \
        part = s_.t;                                                                               \
        name[0] = pyro_progress(v_[0]), name[1] = pyro_progress(v_[1]);                            \
        name[2] = pyro_progress(v_[2]), name[3] = pyro_progress(v_[3]);                            \
        name[4] = pyro_progress(v_[4]), name[5] = pyro_progress(v_[5]);                            \
        name[6] = pyro_progress(v_[6]), name[7] = pyro_progress(v_[7]);                            \
    }

// The progress that the flame brings in this step: that of gas behind, less that of gas here. Gas that is
// `lighter` than the mixture before the flame flows away behind it: through such gas it moves faster, and as
// much air passes it.
float flame(ivec3 c, float lighter) {
    vec3 from = vec3(c) + 0.5 - way_of(c, 1.0);
    PROGRESS_EIGHT(from, here, t)
    vec3 slope;
    slope.x = here[1] - here[0] + here[3] - here[2] + here[5] - here[4] + here[7] - here[6];
    slope.y = here[2] - here[0] + here[3] - here[1] + here[6] - here[4] + here[7] - here[5];
    slope.z = here[4] - here[0] + here[5] - here[1] + here[6] - here[2] + here[7] - here[3];
    float steep = length(slope);
    if (steep < 1e-4) return 0.0;
    PROGRESS_EIGHT(from + slope / steep * (flame_reach * lighter), behind, u)
    return progress_mix(behind, u) - progress_mix(here, t);
}
#endif

#if PYRO_RATIO == 2
layout(std430) writeonly buffer PyroDensity { float densities[]; }; // by that of the surroundings
shared vec2 parts[256];

// Expansion and density of a cell of the velocity: the mean of eight. The group has 4 x 4 x 2 of them.
void hand_on(float grown, float density) {
    uint i = gl_LocalInvocationIndex;
    parts[i] = vec2(cell * pyro_clean(grown), density);
    barrier();
    if (i >= 32u) return;
    uint first = 2u * (i & 3u) + 16u * ((i >> 2) & 3u) + 128u * (i >> 4); // of the eight
    vec2 sum = parts[first] + parts[first + 1u] + parts[first + 8u] + parts[first + 9u];
    sum += parts[first + 64u] + parts[first + 65u] + parts[first + 72u] + parts[first + 73u];
    ivec3 to = ivec3(gl_WorkGroupID) * ivec3(4, 4, 2) + ivec3(i & 3u, (i >> 2) & 3u, i >> 4);
    int at = pyro_flow_at(to);
    right[at] = 0.125 * sum.x;
    densities[at] = 0.125 * sum.y;
}
#endif

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int at = pyro_at(c);
    vec4 g = vec4(0.0);
    float grown = 0.0, brought = 0.0; // expansion, 1/s
    if (is_near_gas()) {
        g = pyro_unpack(pyro_clean(carried(c, at)));
#if PYRO_PREMIXED
        brought = flame(c, pyro_temperature(g) / ambient);
#endif
        grown = pyro_burn(g, brought);
    }
    gas_to[at] = pyro_store(settle(pyro_pack(g)));
#if PYRO_CORRECTS
    add_up_corrections();
#endif
#if PYRO_RATIO == 2
    hand_on(grown, pyro_density(g));
#else
    right[at] = cell * pyro_clean(grown);
#endif
}
#endif
