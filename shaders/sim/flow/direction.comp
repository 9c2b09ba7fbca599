// Conjugate gradients (Hestenes and Stiefel 1952; on the GPU: Krueger and Westermann 2003): the
// next direction, and its image under the pressure's equation. With FLOW_PLAIN without a
// preconditioner: z is the residual itself, and here it is seen whether the solve is done.
layout(local_size_x = 256) in;
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"

uniform int iteration;
uniform float tolerance;
layout(std430) readonly buffer FlowCoefficients { uvec2 flow_coefficients[]; };
layout(std430) readonly buffer FlowZ { float z[]; };
layout(std430) readonly buffer FlowBefore { float before[]; };
layout(std430) writeonly buffer FlowDirection { float direction[]; };
layout(std430) writeonly buffer FlowImage { float image[]; };

#ifdef FLOW_PLAIN
bool is_done(int slice) {
    uint at = uint(slice * FLOW_KNOWN);
    float residual = flow_total(slice, FLOW_PARTS_R).x;
    float reference = flow_total(slice, FLOW_PARTS_BUILD).x;
    bool done = !(residual > tolerance * tolerance * reference);
    if (gl_LocalInvocationIndex == 0u && gl_WorkGroupID.xy == uvec2(0u)) {
        flow_known[at + FLOW_DONE] = done ? 1.0 : 0.0;
        flow_known[at + FLOW_REFERENCE] = reference;
        flow_known[at + FLOW_RESIDUAL] = residual;
        flow_known[at + FLOW_ITERATIONS] = float(iteration);
    }
    return done;
}
#endif

// Along the way: beta, of the last direction.
float direction_of(ivec2 cell, int slice, float beta) {
    cell = flow_around(cell, FLOW_SIZE);
    if (!flow_inside(cell)) return 0.0;
    uint at = flow_cell(cell, slice);
    return beta == 0.0 ? z[at] : z[at] + beta * before[at];
}

float follow(ivec2 cell, int slice, float beta) {
    uint at = flow_cell(cell, slice);
    uvec2 c = flow_coefficients[at];
    vec4 faces = flow_faces_of(c.x);
    float own = direction_of(cell, slice, beta);
    vec4 others = vec4(direction_of(cell - ivec2(1, 0), slice, beta),
                       direction_of(cell + ivec2(1, 0), slice, beta),
                       direction_of(cell - ivec2(0, 1), slice, beta),
                       direction_of(cell + ivec2(0, 1), slice, beta));
    float q = dot(faces, own - others) + uintBitsToFloat(c.y) * own;
    direction[at] = own;
    image[at] = q;
    return own * q;
}

void main() {
    int slice = int(gl_WorkGroupID.z), turn = iteration & 1;
    uint known = uint(slice * FLOW_KNOWN);
#ifdef FLOW_PLAIN
    // All groups decide, and from the same numbers: what the first one says is for later.
    if (flow_known[known + FLOW_OVER] > 0.0 || is_done(slice)) return;
#else
    if (flow_known[known + FLOW_DONE] > 0.0) return;
#endif
    float rz = flow_total(slice, FLOW_PARTS_RZ).x;
    float last = flow_known[known + FLOW_RZ + 1 - turn];
    float beta = iteration > 0 && last > 0.0 ? flow_clean(rz / last) : 0.0;
    if (gl_LocalInvocationIndex == 0u && gl_WorkGroupID.xy == uvec2(0u))
        flow_known[known + FLOW_RZ + turn] = rz;
    float sum = 0.0;
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE * FLOW_TILE; i += FLOW_GROUP) {
        ivec2 cell = ivec2(gl_WorkGroupID.xy) * FLOW_TILE + ivec2(i % FLOW_TILE, i / FLOW_TILE);
        if (flow_inside(cell)) sum += follow(cell, slice, beta);
    }
    flow_leave(slice, FLOW_PARTS_PQ, vec4(sum, 0.0, 0.0, 0.0));
}
