// Conjugate gradients without a preconditioner: goes along the direction as far as is best, and
// sums what remains. (With multigrid, down.comp does this too.)
layout(local_size_x = 256) in;
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"

uniform int iteration;
layout(std430) readonly buffer FlowCoefficients { uvec2 flow_coefficients[]; };
layout(std430) readonly buffer FlowFrom { float from[]; };
layout(std430) readonly buffer FlowDirection { float direction[]; };
layout(std430) readonly buffer FlowImage { float image[]; };
layout(std430) buffer FlowPressure { float pressure[]; };
layout(std430) writeonly buffer FlowResidual { float residual[]; };

void main() {
    int slice = int(gl_WorkGroupID.z);
    if (flow_known[slice * FLOW_KNOWN + FLOW_DONE] > 0.0) {
        if (gl_LocalInvocationIndex == 0u && gl_WorkGroupID.xy == uvec2(0u))
            flow_known[slice * FLOW_KNOWN + FLOW_OVER] = 1.0;
        return;
    }
    float mean = iteration == 0 ? flow_mean(slice, FLOW_PARTS_BUILD) : 0.0;
    float stride = iteration > 0 ? flow_stride(slice, (iteration + 1) & 1) : 0.0;
    vec2 sum = vec2(0.0);
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE * FLOW_TILE; i += FLOW_GROUP) {
        ivec2 cell = ivec2(gl_WorkGroupID.xy) * FLOW_TILE + ivec2(i % FLOW_TILE, i / FLOW_TILE);
        if (!flow_inside(cell)) continue;
        uint at = flow_cell(cell, slice);
        uvec2 c = flow_coefficients[at];
        float d = dot(flow_faces_of(c.x), vec4(1.0)) + uintBitsToFloat(c.y), r = from[at];
        if (iteration == 0) r = d > 0.0 ? r - mean : 0.0;
        else r -= stride * image[at];
        if (iteration > 0) pressure[at] += stride * direction[at];
        residual[at] = r;
        float left = d > 0.0 ? 4.0 * r / d : 0.0;
        sum += vec2(left * left, r * r);
    }
    flow_leave(slice, FLOW_PARTS_R, vec4(sum.x, 0.0, 0.0, 0.0));
    flow_leave(slice, FLOW_PARTS_RZ, vec4(sum.y, 0.0, 0.0, 0.0));
}
