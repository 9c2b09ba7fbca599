// What a state comes to, for the host to read some frames later. Twice: each group its tile, and,
// with LAST, one group all of that and what is known of the solves.
layout(local_size_x = FLOW_GROUP) in;
#define FLOW_STATE
#include "sim/flow/state.glsl"
#include "sim/flow/solve.glsl"

#ifdef LAST
uniform int iterations; // that were recorded
layout(std430) readonly buffer FlowReport { vec4 report[]; };
layout(r32ui) writeonly uniform uimage2D result;
#else
layout(std430) writeonly buffer FlowReport { vec4 report[]; };
#endif

// Sums of the scalars and the greatest speed squared; the greatest scalars.
struct Record {
    vec4 sum, most;
};

shared vec4 shares[64];

Record merge(Record a, Record b) {
    return Record(vec4(a.sum.xyz + b.sum.xyz, max(a.sum.w, b.sum.w)), max(a.most, b.most));
}

Record over_group(Record r) {
    vec4 sum = flow_group_sum(vec4(r.sum.xyz, 0.0));
    vec4 most = subgroupMax(vec4(r.most.xyz, r.sum.w));
    if (subgroupElect()) shares[gl_SubgroupID] = most;
    barrier();
    for (uint i = 0u; i < gl_NumSubgroups; i++) most = max(most, shares[i]);
    return Record(vec4(sum.xyz, most.w), vec4(most.xyz, 0.0));
}

#ifdef LAST
// Of all slices: the most iterations, the greatest residual of what it was measured against.
vec2 solves() {
    vec2 worst = vec2(0.0);
    for (int slice = 0; slice < FLOW_SLICES; slice++) {
        uint at = uint(slice * FLOW_KNOWN);
        bool done = flow_known[at + FLOW_STOPPED] > 0.0;
        float taken = done ? flow_known[at + FLOW_ITERATIONS] : float(iterations);
        vec2 left = vec2(flow_known[at + FLOW_RESIDUAL], flow_known[at + FLOW_REFERENCE]);
        vec4 pq = flow_total(slice, FLOW_PARTS_PQ);
        if (!done) left = flow_remains(slice, iterations, flow_stride(slice, iterations, pq), pq);
        worst = max(worst, vec2(taken, left.y > 0.0 ? sqrt(left.x / left.y) : 0.0));
    }
    return worst;
}

void main() {
    Record r = Record(vec4(0.0), vec4(-3.0e38));
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILES * FLOW_SLICES; i += FLOW_GROUP)
        r = merge(r, Record(report[2 * i], report[2 * i + 1]));
    r = over_group(r);
    vec2 solve = solves();
    if (gl_LocalInvocationIndex > 0u) return;
    const float words[9] = float[9](solve.x, solve.y, sqrt(r.sum.w), r.sum.x, r.sum.y, r.sum.z,
                                    r.most.x, r.most.y, r.most.z);
    for (int i = 0; i < 9; i++) imageStore(result, ivec2(i, 0), uvec4(floatBitsToUint(words[i])));
}
#else
void main() {
    int slice = int(gl_WorkGroupID.z);
    Record r = Record(vec4(0.0), vec4(-3.0e38));
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE * FLOW_TILE; i += FLOW_GROUP) {
        ivec2 cell = ivec2(gl_WorkGroupID.xy) * FLOW_TILE + ivec2(i % FLOW_TILE, i / FLOW_TILE);
        if (!flow_inside(cell)) continue;
        vec2 v = flow_velocity_of(cell, slice);
        vec4 s = flow_scalars_of(cell, slice);
        r = merge(r, Record(vec4(s.xyz, dot(v, v)), s));
    }
    r = over_group(r);
    uint at = uint(slice * FLOW_TILES) + gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (gl_LocalInvocationIndex > 0u) return;
    report[2u * at] = r.sum;
    report[2u * at + 1u] = r.most;
}
#endif
