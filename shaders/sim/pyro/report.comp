// What a state comes to, for the host to read some frames later: each group its cells of the gas, or,
// with FLOW, of its velocity; then, with LAST, one group all of that.
#ifdef LAST
layout(local_size_x = 256) in;
#else
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#ifndef FLOW
#define PYRO_ON_GAS
#endif
#endif
#include "sim/pyro/state.glsl"
#ifdef LAST
uniform int groups; // that found something
layout(std430) readonly buffer PyroReport { vec4 report[]; };
layout(r32ui) writeonly uniform uimage2D result;
#else
layout(std430) writeonly buffer PyroReport { vec4 report[]; };
uniform int first; // of its records
#ifdef FLOW
#define PYRO_FINEST
#include "sim/pyro/levels.glsl"
#include "sim/pyro/velocity.glsl"
layout(std430) readonly buffer PyroPressure { float pressure[]; };
layout(std430) readonly buffer PyroRight { float right[]; };
#else
#include "sim/pyro/burn.glsl"
uniform float mass; // kg of the air of a cell, times its temperature
layout(std430) readonly buffer PyroGas { PYRO_FOUR gas[]; };

// The progress that a flame brings in a step: by its slope.
float brought_to(ivec3 c, vec4 g) {
#if PYRO_PREMIXED
    vec3 slope;
    for (int axis = 0; axis < 3; axis++) {
        ivec3 step_ = ivec3(axis == 0, axis == 1, axis == 2);
        slope[axis] = pyro_progress(pyro_load(gas[pyro_at(pyro_into(c + step_))])) -
                      pyro_progress(pyro_load(gas[pyro_at(pyro_into(c - step_))]));
    }
    return 0.5 * length(slope) * flame_reach * pyro_temperature(g) / ambient;
#else
    return 0.0;
#endif
}
#endif
#endif

// The greatest speed squared, divergence that is not wanted, temperature, and 0; sums of fuel, what
// has burnt, soot (kg) and power (W); how many cells are no numbers.
struct Record {
    vec4 most, sum;
    float bad;
};

shared vec4 most_of[256], sum_of[256];
shared float bad_of[256];

Record over_group(Record r) {
    uint i = gl_LocalInvocationIndex;
    most_of[i] = r.most, sum_of[i] = r.sum, bad_of[i] = r.bad;
    for (uint step_ = 128u; step_ > 0u; step_ >>= 1) {
        barrier();
        if (i >= step_) continue;
        most_of[i] = max(most_of[i], most_of[i + step_]);
        sum_of[i] += sum_of[i + step_];
        bad_of[i] += bad_of[i + step_];
    }
    return Record(most_of[0], sum_of[0], bad_of[0]);
}

#ifdef LAST
void main() {
    Record r = Record(vec4(0.0), vec4(0.0), 0.0);
    for (int i = int(gl_LocalInvocationIndex); i < groups; i += 256) {
        vec4 most = report[2 * i];
        r = Record(max(r.most, vec4(most.xyz, 0.0)), r.sum + report[2 * i + 1], r.bad + most.w);
    }
    r = over_group(r);
    if (gl_LocalInvocationIndex > 0u) return;
    const float words[8] = float[8](r.bad, sqrt(r.most.x), r.most.y, r.most.z, r.sum.x, r.sum.y,
                                    r.sum.z, r.sum.w);
    for (int i = 0; i < 8; i++) imageStore(result, ivec2(i, 0), uvec4(floatBitsToUint(words[i])));
}
#else
#ifdef FLOW
Record record_of(ivec3 c) {
    int at = pyro_at(c);
    vec3 v = pyro_velocity_cell(pyro_near_of(c));
#if PYRO_WEIGHED // conjugate gradients have it
    float left = abs(right[at]);
#else
    level_near n = level_near_of(c);
    float around;
    LEVEL_SUM(pressure, n, around)
    float left = abs(right[at] - (around - n.all * pressure[at]));
#endif
    float square = dot(v, v);
    if (pyro_clean(square) != square || pyro_clean(left) != left) return Record(vec4(0.0), vec4(0.0), 1.0);
    return Record(vec4(square, left, 0.0, 0.0), vec4(0.0), 0.0);
}
#else
Record record_of(ivec3 c) {
    vec4 packed = pyro_load(gas[pyro_at(c)]), g = pyro_unpack(packed);
    if (packed != pyro_clean(packed)) return Record(vec4(0.0), vec4(0.0), 1.0);
    float air = mass / pyro_temperature(g); // kg
    return Record(vec4(0.0, 0.0, pyro_temperature(g), 0.0), air * vec4(g.yzw, pyro_burning(g, brought_to(c, g))), 0.0);
}
#endif

void main() {
    Record r = over_group(record_of(ivec3(gl_GlobalInvocationID)));
    uint group = (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (gl_LocalInvocationIndex > 0u) return;
    report[2u * (uint(first) + group)] = vec4(r.most.xyz, r.bad);
    report[2u * (uint(first) + group) + 1u] = r.sum;
}
#endif
