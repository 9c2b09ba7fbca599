// What the dispatches of a pressure solve share: sums over a slice, and what is known of it.
//
// FLOW_GROUP threads make a group of most of them. Sums are made without atomics, always in the same
// order: each group leaves its part, and each group of a later dispatch that wants the sum adds all
// parts up.
#ifndef SIM_FLOW_SOLVE_GLSL
#define SIM_FLOW_SOLVE_GLSL
#extension GL_KHR_shader_subgroup_arithmetic : require

// Of each slice.
#define FLOW_STOPPED 0    // 1 + the iteration before which it was seen that the solve is done
#define FLOW_REFERENCE 1  // square of what the residual is measured against
#define FLOW_ITERATIONS 2 // that were taken, once it is done
#define FLOW_RESIDUAL 3   // square of the residual, newest
#define FLOW_RZ 4         // and 5, by turns: r * z
#define FLOW_KNOWN 8
layout(std430) buffer FlowKnown { float flow_known[]; };

// Parts of sums, of all kinds of a slice one after the other.
#define FLOW_PARTS_BUILD 0 // squares: reference, residual; cells of air; those that something holds
#define FLOW_PARTS_MEAN 1  // residual; pressure before the step
#define FLOW_PARTS_RZ 2
#define FLOW_PARTS_PQ 3 // p q; and, weighed as the residual is, r q, q q, r r
#define FLOW_PARTS 4
layout(std430) buffer FlowParts { vec4 flow_parts[]; };

// Tiles of level 0: of FLOW_TILE cells, and of 32 in build.comp.
const int FLOW_TILES =
    ((FLOW_NX + FLOW_TILE - 1) / FLOW_TILE) * ((FLOW_NY + FLOW_TILE - 1) / FLOW_TILE);
const int FLOW_BUILDS = ((FLOW_NX + 31) / 32) * ((FLOW_NY + 31) / 32);
const int FLOW_MOST_PARTS = max(FLOW_TILES, FLOW_BUILDS);

const int FLOW_THREADS = int(gl_WorkGroupSize.x * gl_WorkGroupSize.y);
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
    for (int i = int(gl_LocalInvocationIndex); i < count; i += FLOW_THREADS)
        v += flow_parts[at + i];
    return flow_group_sum(v);
}

// Where nothing holds the pressure no flow can fill the space or leave it, and a pressure that is
// the same everywhere changes nothing: of the residual, and of the pressure before the step, what
// differs from the mean is all that counts. Both means.
vec2 flow_means(int slice) {
    const bool open = FLOW_FACE_LEFT == FLOW_OPEN || FLOW_FACE_RIGHT == FLOW_OPEN ||
                      FLOW_FACE_BOTTOM == FLOW_OPEN || FLOW_FACE_TOP == FLOW_OPEN;
    if (open) return vec2(0.0);
    vec4 sum = flow_total(slice, FLOW_PARTS_BUILD);
    if (sum.w > 0.0 || sum.z == 0.0) return vec2(0.0);
    return flow_total(slice, FLOW_PARTS_MEAN).xy / sum.z;
}

// ---- what an iteration begins with ------------------------------------------------------------

struct flow_way {
    bool done;    // nothing more is to be computed
    bool leads;   // the last direction is still to be followed
    float stride; // as far as this
};

// Squares of the residual (after the last direction was followed) and of what it is measured
// against. It is known from the sums beforehand, so that no dispatch is begun in vain.
vec2 flow_remains(int slice, int iteration, float stride, vec4 pq) {
    uint at = uint(slice * FLOW_KNOWN);
    if (iteration == 0) return flow_total(slice, FLOW_PARTS_BUILD).yx;
    float left = pq.w + stride * (stride * pq.z - 2.0 * pq.y);
    return vec2(max(left, 0.0), flow_known[at + FLOW_REFERENCE]);
}

// How far the solution goes along the direction that the iteration before this one led to.
float flow_stride(int slice, int iteration, vec4 pq) {
    float rz = flow_known[slice * FLOW_KNOWN + FLOW_RZ + 1 - (iteration & 1)];
    return pq.x > 0.0 ? flow_clean(rz / pq.x) : 0.0;
}

bool flow_stopped(int slice) { // in an earlier dispatch
    return flow_known[slice * FLOW_KNOWN + FLOW_STOPPED] > 0.0;
}

// By all threads of all groups of the dispatch that an iteration begins with. All decide, from the
// same numbers; what the first one notes they must not see yet.
flow_way flow_begin(int slice, int iteration, float tolerance) {
    uint at = uint(slice * FLOW_KNOWN);
    float stopped = flow_known[at + FLOW_STOPPED];
    if (stopped > 0.0 && stopped < float(iteration + 1)) return flow_way(true, false, 0.0);
    vec4 pq = iteration == 0 ? vec4(0.0) : flow_total(slice, FLOW_PARTS_PQ);
    float stride = iteration == 0 ? 0.0 : flow_stride(slice, iteration, pq);
    vec2 left = flow_remains(slice, iteration, stride, pq);
    bool done = !(left.x > tolerance * tolerance * left.y);
    if (gl_LocalInvocationIndex == 0u && gl_WorkGroupID.xy == uvec2(0u)) {
        flow_known[at + FLOW_RESIDUAL] = left.x;
        flow_known[at + FLOW_REFERENCE] = left.y;
        flow_known[at + FLOW_ITERATIONS] = float(iteration);
        if (done) flow_known[at + FLOW_STOPPED] = float(iteration + 1);
    }
    return flow_way(done, iteration > 0, stride);
}
#endif
