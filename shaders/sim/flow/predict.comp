// What MacCormack's method (Selle et al. 2008) corrects: everything traced back once; and from
// where.
layout(local_size_x = 16, local_size_y = 16) in;
#define FLOW_STATE
#define FLOW_OBSTACLES readonly
#include "sim/flow/state.glsl"
#include "sim/flow/carry.glsl"

layout(std430) writeonly buffer FlowHatVelocity { vec2 hat_velocity[]; };
layout(std430) writeonly buffer FlowHatScalars { vec4 hat_scalars[]; };
layout(std430) writeonly buffer FlowTraced { vec2 flow_traced[]; };

void main() {
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    int slice = int(gl_GlobalInvocationID.z);
    ivec2 last = FLOW_SIZE - ivec2(FLOW_AROUND_X, FLOW_AROUND_Y);
    if (any(greaterThan(cell, last))) return;
    vec2 corner = vec2(cell), v = vec2(0.0);
    vec4 from = vec4(0.0);
    if (cell.y < FLOW_NY) {
        vec2 here = flow_velocity_left(cell, slice);
        from.xy = flow_trace(corner + vec2(0.0, 0.5), here, -1.0, slice);
        flow_quad q = flow_quad_u(from.xy);
        v.x = flow_mix(FLOW_FOUR(flow_velocity, x, q, slice), q.t);
    }
    if (cell.x < FLOW_NX) {
        vec2 here = flow_velocity_bottom(cell, slice);
        from.zw = flow_trace(corner + vec2(0.5, 0.0), here, -1.0, slice);
        flow_quad q = flow_quad_v(from.zw);
        v.y = flow_mix(FLOW_FOUR(flow_velocity, y, q, slice), q.t);
    }
    hat_velocity[flow_corner(cell, slice)] = v;
    flow_traced[flow_traced_left(cell, slice)] = from.xy;
    flow_traced[flow_traced_bottom(cell, slice)] = from.zw;
    if (!flow_inside(cell)) return;
    uint at = flow_cell(cell, slice);
    vec2 was = flow_trace(corner + 0.5, flow_velocity_of(cell, slice), -1.0, slice);
    flow_scalar_quad q = flow_scalars_before(was, slice);
    flow_traced[flow_traced_cell(cell, slice)] = was;
    hat_scalars[at] = flow_scalars_mean(q, flow_scalars[at]);
}
