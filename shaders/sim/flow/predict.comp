// What MacCormack's method (Selle et al. 2008) corrects: everything traced back once.
layout(local_size_x = 16, local_size_y = 16) in;
#define FLOW_STATE
#define FLOW_OBSTACLES readonly
#include "sim/flow/state.glsl"
#include "sim/flow/carry.glsl"

layout(std430) writeonly buffer FlowHatVelocity { vec2 hat_velocity[]; };
layout(std430) writeonly buffer FlowHatScalars { vec4 hat_scalars[]; };

void main() {
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    int slice = int(gl_GlobalInvocationID.z);
    ivec2 last = FLOW_SIZE - ivec2(FLOW_AROUND_X, FLOW_AROUND_Y);
    if (any(greaterThan(cell, last))) return;
    vec2 corner = vec2(cell), v = vec2(0.0);
    if (cell.y < FLOW_NY) {
        flow_quad q = flow_quad_u(flow_trace(corner + vec2(0.0, 0.5), -1.0, slice));
        v.x = flow_mix(FLOW_FOUR(flow_velocity, x, q, slice), q.t);
    }
    if (cell.x < FLOW_NX) {
        flow_quad q = flow_quad_v(flow_trace(corner + vec2(0.5, 0.0), -1.0, slice));
        v.y = flow_mix(FLOW_FOUR(flow_velocity, y, q, slice), q.t);
    }
    hat_velocity[flow_corner(cell, slice)] = v;
    if (!flow_inside(cell)) return;
    flow_scalar_quad q = flow_scalars_before(flow_trace(corner + 0.5, -1.0, slice), slice);
    hat_scalars[flow_cell(cell, slice)] =
        flow_scalars_mean(q, flow_scalars[flow_cell(cell, slice)]);
}
