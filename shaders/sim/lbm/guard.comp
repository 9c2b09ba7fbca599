// What the moments of a whole state come to, so that trouble is noticed: cells whose values are no
// numbers, the greatest speed and where it is, sums, least and greatest values. Bodies count for
// nothing. Twice: from the moments to a record for each group (src/sim/lbm_guard.c says how many),
// and, with LAST, from these to the only one.
#extension GL_KHR_shader_subgroup_arithmetic : require
layout(local_size_x = 256) in;
#include "shared.h"
uniform uint count;  // of cells, or of records with LAST
uniform uint stride; // threads of the dispatch
#ifdef LAST
uniform float spoilt_speed; // cells a step: faster air is spoilt
uniform float spoilt_drift; // of the mass, either way: air that gained or lost more of it is, too
#endif

struct Record {
    uint spoilt;       // bits LBM_SPOILT_ of shared.h; with LAST only
    uint cells, bad;   // air, and those of it whose values are no numbers
    float speed;       // greatest
    uint where;        // in which cell
    vec4 sum;          // density - 1, scalars
    vec4 least, most;  // the same
};

#ifdef LAST
layout(std430) buffer Parts { Record parts[]; }; // afterwards the first is the only one
layout(std430) readonly buffer Notes { uint notes[2]; }; // of others, for the host: LBM_NOTES
layout(r32ui) writeonly uniform uimage2D result; //= output r32ui : the record, word by word
#else
layout(std430) readonly buffer Moments { uvec4 moments[]; };
layout(std430) writeonly buffer Parts { Record parts[]; };
#endif

shared Record shares[64]; // one for each subgroup: these are of 4 threads or more

const float END = 3.0e38;

Record nothing() {
    return Record(0u, 0u, 0u, -1.0, 0u, vec4(0.0), vec4(END), vec4(-END));
}

void merge(inout Record a, Record b) {
    a.cells += b.cells;
    a.bad += b.bad;
    if (b.speed > a.speed) {
        a.speed = b.speed;
        a.where = b.where;
    }
    a.sum += b.sum;
    a.least = min(a.least, b.least);
    a.most = max(a.most, b.most);
}

#ifndef LAST
Record look(uint cell) {
    Record r = nothing();
    uvec4 packed = moments[cell];
    if (packed.w >> 16 != 0u) return r;
    vec4 flow = vec4(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y));
    vec4 values = vec4(flow.w, unpackHalf2x16(packed.z), unpackHalf2x16(packed.w).x);
    r.cells = 1u;
    // Not isnan: compilers may take it that there are none.
    uvec4 ends = (packed & 0x7c007c00u) ^ 0x7c007c00u;
    ends.w |= 0xffff0000u;
    if (any(equal(ends & 0xffffu, uvec4(0u))) || any(equal(ends >> 16, uvec4(0u)))) {
        r.bad = 1u;
        return r;
    }
    r.speed = length(flow.xyz);
    r.where = cell;
    r.sum = r.least = r.most = values;
    return r;
}
#endif

Record over_subgroup(Record r) {
    float speed = subgroupMax(r.speed);
    uint where = subgroupMin(r.speed == speed ? r.where : 0xffffffffu);
    return Record(0u, subgroupAdd(r.cells), subgroupAdd(r.bad), speed, where, subgroupAdd(r.sum),
                  subgroupMin(r.least), subgroupMax(r.most));
}

#ifdef LAST
uint judge(Record r) {
    float good = float(r.cells - r.bad);
    return (r.bad > 0u ? LBM_SPOILT_NUMBERS : 0u) |
           (abs(r.sum.x) > spoilt_drift * good ? LBM_SPOILT_MASS : 0u) |
           (r.speed > spoilt_speed ? LBM_SPOILT_SPEED : 0u);
}
#endif

void main() {
    Record r = nothing();
    for (uint i = gl_GlobalInvocationID.x; i < count; i += stride) {
#ifdef LAST
        merge(r, parts[i]);
#else
        merge(r, look(i));
#endif
    }
    r = over_subgroup(r);
    if (subgroupElect()) shares[gl_SubgroupID] = r;
    barrier();
    if (gl_LocalInvocationIndex > 0u) return;
    for (uint i = 1u; i < gl_NumSubgroups; i++) merge(r, shares[i]);
#ifdef LAST
    r.spoilt = judge(r);
    const uint words[17] = uint[17](
        r.cells, r.bad, floatBitsToUint(r.speed), r.where, floatBitsToUint(r.sum.x),
        floatBitsToUint(r.sum.y), floatBitsToUint(r.sum.z), floatBitsToUint(r.sum.w),
        floatBitsToUint(r.least.x), floatBitsToUint(r.least.y), floatBitsToUint(r.least.z),
        floatBitsToUint(r.least.w), floatBitsToUint(r.most.x), floatBitsToUint(r.most.y),
        floatBitsToUint(r.most.z), floatBitsToUint(r.most.w), r.spoilt);
    for (int i = 0; i < 17; i++) imageStore(result, ivec2(i, 0), uvec4(words[i]));
    for (int i = 0; i < 2; i++) imageStore(result, ivec2(17 + i, 0), uvec4(notes[i]));
    parts[0] = r;
#else
    parts[gl_WorkGroupID.x] = r;
#endif
}
