// Conjugate gradients (Hestenes and Stiefel 1952; on the GPU: Krueger and Westermann 2003): the
// next direction, and its image under the pressure's equation. Without a preconditioner z is the
// residual itself.
layout(local_size_x = FLOW_GROUP) in;
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"

uniform int iteration;
layout(std430) readonly buffer FlowCoefficients { uvec2 flow_coefficients[]; };
layout(std430) readonly buffer FlowZ { float z[]; };
layout(std430) readonly buffer FlowResidual { float r[]; };
layout(std430) readonly buffer FlowBefore { float before[]; };
layout(std430) writeonly buffer FlowDirection { float direction[]; }; // of all cells, then its image

// Along the way: beta, of the last direction.
float direction_of(ivec2 cell, int slice, float beta) {
    cell = flow_around(cell, FLOW_SIZE);
    if (!flow_inside(cell)) return 0.0;
    uint at = flow_cell(cell, slice);
    return beta == 0.0 ? z[at] : z[at] + beta * before[at];
}

// Of FLOW_PARTS_PQ.
vec4 follow(ivec2 cell, int slice, float beta) {
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
    direction[flow_cell_behind(cell, slice)] = q;
    float d = dot(faces, vec4(1.0)) + uintBitsToFloat(c.y), weight = d > 0.0 ? 4.0 / d : 0.0;
    float scaled = weight * weight * q;
    return vec4(own * q, scaled * r[at], scaled * q, weight * weight * r[at] * r[at]);
}

void main() {
    int slice = int(gl_WorkGroupID.z), turn = iteration & 1;
    uint known = uint(slice * FLOW_KNOWN);
    if (flow_stopped(slice)) return;
    float rz = flow_total(slice, FLOW_PARTS_RZ).x;
    float last = flow_known[known + FLOW_RZ + 1 - turn];
    float beta = iteration > 0 && last > 0.0 ? flow_clean(rz / last) : 0.0;
    if (gl_LocalInvocationIndex == 0u && gl_WorkGroupID.xy == uvec2(0u))
        flow_known[known + FLOW_RZ + turn] = rz;
    vec4 sum = vec4(0.0);
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE * FLOW_TILE; i += FLOW_GROUP) {
        ivec2 cell = ivec2(gl_WorkGroupID.xy) * FLOW_TILE + ivec2(i % FLOW_TILE, i / FLOW_TILE);
        if (flow_inside(cell)) sum += follow(cell, slice, beta);
    }
    flow_leave(slice, FLOW_PARTS_PQ, sum);
}
