// What the dispatches of a pressure solve share: sums over a slice, and what is known of it.
//
// Sums are made without atomics, always in the same order: each group leaves its part, and each
// group of a later dispatch that wants the sum adds all parts up.
#ifndef SIM_FLOW_SOLVE_GLSL
#define SIM_FLOW_SOLVE_GLSL
#extension GL_KHR_shader_subgroup_arithmetic : require

#define FLOW_GROUP 256 // threads of these dispatches

// Of each slice. Whoever finds the solve done says so; later dispatches return at once.
#define FLOW_DONE 0       // 1: done
#define FLOW_REFERENCE 1  // square of what the residual is measured against
#define FLOW_RESIDUAL 2   // square of the residual, newest
#define FLOW_ITERATIONS 3 // so far
#define FLOW_RZ 4         // and 5, by turns: r * z
#define FLOW_OVER 6       // 1: was done a dispatch before
#define FLOW_KNOWN 8
layout(std430) buffer FlowKnown { float flow_known[]; };

// Parts of sums, of all kinds of a slice one after the other.
#define FLOW_PARTS_BUILD 0 // reference; residual; cells of air; cells that something holds
#define FLOW_PARTS_R 1     // square of the residual
#define FLOW_PARTS_RZ 2
#define FLOW_PARTS_PQ 3
#define FLOW_PARTS_MEAN 4 // of build.comp: pressure before the step
#define FLOW_PARTS 5
layout(std430) buffer FlowParts { vec4 flow_parts[]; };

// Tiles of level 0: of FLOW_TILE cells, and of 32 in build.comp.
const int FLOW_TILES = ((FLOW_NX + FLOW_TILE - 1) / FLOW_TILE) * ((FLOW_NY + FLOW_TILE - 1) / FLOW_TILE);
const int FLOW_BUILDS = ((FLOW_NX + 31) / 32) * ((FLOW_NY + 31) / 32);
const int FLOW_MOST_PARTS = max(FLOW_TILES, FLOW_BUILDS);

shared vec4 flow_shares[64]; // one for each subgroup: these are of 4 threads or more

// By all threads of a group.
vec4 flow_group_sum(vec4 v) {
    v = subgroupAdd(v);
    barrier();
    if (subgroupElect()) flow_shares[gl_SubgroupID] = v;
    barrier();
    vec4 sum = flow_shares[0];
    for (uint i = 1u; i < gl_NumSubgroups; i++) sum += flow_shares[i];
    return sum;
}
float flow_group_sum(float v) {
    return flow_group_sum(vec4(v, 0.0, 0.0, 0.0)).x;
}

uint flow_parts_at(int slice, int kind) {
    return uint((slice * FLOW_PARTS + kind) * FLOW_MOST_PARTS);
}

// By all threads of a group: leaves the group's part.
void flow_leave(int slice, int kind, vec4 v) {
    vec4 sum = flow_group_sum(v);
    if (gl_LocalInvocationIndex == 0u)
        flow_parts[flow_parts_at(slice, kind) + gl_WorkGroupID.y * gl_NumWorkGroups.x +
                   gl_WorkGroupID.x] = sum;
}

// By all threads of a group: the sum of all parts.
vec4 flow_total(int slice, int kind) {
    uint at = flow_parts_at(slice, kind);
    bool build = kind == FLOW_PARTS_BUILD || kind == FLOW_PARTS_MEAN;
    int count = build ? FLOW_BUILDS : FLOW_TILES;
    vec4 v = vec4(0.0);
    for (int i = int(gl_LocalInvocationIndex); i < count; i += FLOW_GROUP) v += flow_parts[at + i];
    return flow_group_sum(v);
}

// Where nothing holds the pressure no flow can fill the space or leave it, and a pressure that is
// the same everywhere changes nothing: of the residual, and of the pressure before the step, what
// differs from the mean is all that counts. `of`: FLOW_PARTS_BUILD or FLOW_PARTS_MEAN.
float flow_mean(int slice, int of) {
    const bool open = FLOW_FACE_LEFT == FLOW_OPEN || FLOW_FACE_RIGHT == FLOW_OPEN ||
                      FLOW_FACE_BOTTOM == FLOW_OPEN || FLOW_FACE_TOP == FLOW_OPEN;
    if (open) return 0.0;
    vec4 sum = flow_total(slice, FLOW_PARTS_BUILD);
    if (sum.w > 0.0 || sum.z == 0.0) return 0.0;
    return (of == FLOW_PARTS_BUILD ? sum.y : flow_total(slice, of).x) / sum.z;
}

// How far the solution goes along the direction that it was led to.
float flow_stride(int slice, int turn) {
    float pq = flow_total(slice, FLOW_PARTS_PQ).x;
    float rz = flow_known[slice * FLOW_KNOWN + FLOW_RZ + turn];
    return pq > 0.0 ? flow_clean(rz / pq) : 0.0;
}
#endif
