// Conjugate gradients without a preconditioner: goes along the direction as far as is best, and
// sees whether the solve is done. (With multigrid, down.comp does this too.)
layout(local_size_x = FLOW_GROUP) in;
#include "sim/flow/state.glsl"
#include "sim/flow/levels.glsl"
#include "sim/flow/solve.glsl"

uniform int iteration;
uniform float tolerance;
layout(std430) readonly buffer FlowCoefficients { uvec2 flow_coefficients[]; };
layout(std430) readonly buffer FlowFrom { float from[]; };
layout(std430) readonly buffer FlowDirection { float direction[]; }; // then its image
layout(std430) buffer FlowPressure { float pressure[]; };
layout(std430) writeonly buffer FlowResidual { float residual[]; };

void main() {
    int slice = int(gl_WorkGroupID.z);
    flow_way way = flow_begin(slice, iteration, tolerance);
    if (way.done && !way.leads) return;
    float mean = way.leads ? 0.0 : flow_means(slice).x, sum = 0.0;
    for (int i = int(gl_LocalInvocationIndex); i < FLOW_TILE * FLOW_TILE; i += FLOW_GROUP) {
        ivec2 cell = ivec2(gl_WorkGroupID.xy) * FLOW_TILE + ivec2(i % FLOW_TILE, i / FLOW_TILE);
        if (!flow_inside(cell)) continue;
        uint at = flow_cell(cell, slice);
        uvec2 c = flow_coefficients[at];
        float r = from[at];
        if (way.leads) {
            r -= way.stride * direction[flow_cell_behind(cell, slice)];
            pressure[at] += way.stride * direction[at];
        } else {
            r = c.x != 0u ? r - mean : 0.0;
        }
        residual[at] = r;
        sum += r * r;
    }
    flow_leave(slice, FLOW_PARTS_RZ, vec4(sum, 0.0, 0.0, 0.0));
}
