// Advection by tracing back (Stam 1999), with the midpoint rule: what the air held where it was a
// step ago. FLOW_STATE is the state before the step.
#ifndef SIM_FLOW_CARRY_GLSL
#define SIM_FLOW_CARRY_GLSL
#include "sim/flow/sample.glsl"

// Where the predictor leaves what it traced back: of left and bottom faces by turns, then of cells.
uint flow_traced_left(ivec2 face, int slice) {
    return 2u * flow_corner(face, slice);
}
uint flow_traced_bottom(ivec2 face, int slice) {
    return 2u * flow_corner(face, slice) + 1u;
}
uint flow_traced_cell(ivec2 cell, int slice) {
    return 2u * flow_corner(ivec2(0), FLOW_SLICES) + flow_cell(cell, slice);
}

uniform float reach; // cells in a step, by 1 m/s
// Of the faces left, right, bottom, top: 1 where clean air comes in.
uniform vec4 fresh;

const vec2 FLOW_END = vec2(FLOW_SIZE);

vec2 flow_velocity_at(vec2 p, int slice) {
    flow_quad u = flow_quad_u(p), v = flow_quad_v(p);
    return vec2(flow_mix(FLOW_FOUR(flow_velocity, x, u, slice), u.t),
                flow_mix(FLOW_FOUR(flow_velocity, y, v, slice), v.t));
}

// Of a left face, of a bottom face, of the middle of a cell.
vec2 flow_velocity_left(ivec2 cell, int slice) {
    flow_quad q = flow_quad_v(vec2(cell) + vec2(0.0, 0.5));
    return vec2(flow_velocity[flow_corner(cell, slice)].x,
                0.25 * dot(FLOW_FOUR(flow_velocity, y, q, slice), vec4(1.0)));
}
vec2 flow_velocity_bottom(ivec2 cell, int slice) {
    flow_quad q = flow_quad_u(vec2(cell) + vec2(0.5, 0.0));
    return vec2(0.25 * dot(FLOW_FOUR(flow_velocity, x, q, slice), vec4(1.0)),
                flow_velocity[flow_corner(cell, slice)].y);
}

// Where the air at p, whose velocity is `here`, was (-1) or will be (1).
vec2 flow_trace(vec2 p, vec2 here, float way, int slice) {
    vec2 half_ = p + 0.5 * way * reach * here;
    return p + way * reach * flow_velocity_at(half_, slice);
}

bool flow_left(vec2 p) { // the slice
    bvec2 out_ = bvec2(!FLOW_AROUND_X, !FLOW_AROUND_Y);
    bvec2 low = lessThan(p, vec2(0.0)), high = greaterThan(p, FLOW_END);
    return (out_.x && (low.x || high.x)) || (out_.y && (low.y || high.y));
}

bool flow_is_solid(ivec2 cell, int slice) {
#if FLOW_WITH_OBSTACLES
    return flow_obstacles[flow_cell(cell, slice)].x >= 0.5;
#else
    return false;
#endif
}

// Near a solid, or outside.
bool flow_is_near(vec2 p, int slice) {
    if (flow_left(p)) return true;
#if FLOW_WITH_OBSTACLES
    flow_quad q = flow_quad_at(p - 0.5, FLOW_SIZE - 1);
    return flow_is_solid(q.low, slice) || flow_is_solid(q.high, slice) ||
           flow_is_solid(ivec2(q.low.x, q.high.y), slice) ||
           flow_is_solid(ivec2(q.high.x, q.low.y), slice);
#else
    return false;
#endif
}

// ---- scalars ----------------------------------------------------------------------------------

struct flow_scalar_quad {
    vec4 value[4];
    vec4 weight; // of each; those of solids are 0
};

// Of any buffer of scalars: `from[cell]`.
#define FLOW_SCALAR_QUAD(name, from)                                                               \
    flow_scalar_quad name(vec2 p, int slice) {                                                     \
        flow_quad q = flow_quad_at(p - 0.5, FLOW_SIZE - 1);                                        \
        ivec2 cell[4] =                                                                            \
            ivec2[4](q.low, ivec2(q.high.x, q.low.y), ivec2(q.low.x, q.high.y), q.high);           \
        flow_scalar_quad s;                                                                        \
        vec2 a = 1.0 - q.t, b = q.t;                                                               \
        s.weight = vec4(a.x * a.y, b.x * a.y, a.x * b.y, b.x * b.y);                               \
        for (int i = 0; i < 4; i++) {                                                              \
            s.value[i] = from[flow_cell(cell[i], slice)];                                          \
            if (flow_is_solid(cell[i], slice)) s.weight[i] = 0.0;                                  \
        }                                                                                          \
        vec2 low = max(0.5 - p, 0.0), high = max(p - FLOW_END + 0.5, 0.0);                         \
        vec4 beyond = min(vec4(low.x, high.x, low.y, high.y), 1.0) * fresh;                        \
        float kept = (1.0 - max(beyond.x, beyond.y)) * (1.0 - max(beyond.z, beyond.w));            \
        for (int i = 0; i < 4; i++) s.value[i] *= kept;                                            \
        return s;                                                                                  \
    }

FLOW_SCALAR_QUAD(flow_scalars_before, flow_scalars)

// `own` where there is no air around.
vec4 flow_scalars_mean(flow_scalar_quad q, vec4 own) {
    float sum = dot(q.weight, vec4(1.0));
    if (sum < 1e-4) return own;
    return (q.weight.x * q.value[0] + q.weight.y * q.value[1] + q.weight.z * q.value[2] +
            q.weight.w * q.value[3]) / sum;
}
#endif
