// A step up to the projection: what the air carries (itself, density, temperature, dye) moves, then
// forces act and sources give; faces that nothing passes get the velocity of what stands there.
layout(local_size_x = 16, local_size_y = 16) in;
#define FLOW_STATE
#define FLOW_OBSTACLES readonly
#define FLOW_SOURCES readonly
#include "sim/flow/state.glsl"
#include "sim/flow/carry.glsl"

uniform float dt;
uniform vec2 acceleration; // m/s^2
uniform vec2 buoyancy;     // by 1 of density, of temperature, m/s^2
uniform float vorticity;   // 1/s
uniform vec3 kept;         // of density, temperature, dye
uniform float max_speed;   // m/s
uniform vec4 wall_velocity[4]; // of the faces left, right, bottom, top: x, y
layout(std430) writeonly buffer FlowVelocityTo { vec2 velocity_to[]; };
layout(std430) writeonly buffer FlowScalarsTo { vec4 scalars_to[]; };
#if FLOW_WITH_CORRECTION
layout(std430) readonly buffer FlowHatVelocity { vec2 hat_velocity[]; };
layout(std430) readonly buffer FlowHatScalars { vec4 hat_scalars[]; };
layout(std430) readonly buffer FlowTraced { vec2 flow_traced[]; };
FLOW_SCALAR_QUAD(hat_scalars_at, hat_scalars)
#endif

// ---- what is carried --------------------------------------------------------------------------

// MacCormack (Selle et al. 2008): half of what tracing there and back changes is taken away, within
// the values that were found. Next to what is no air it is not.
#if FLOW_WITH_CORRECTION
#define CARRY(name, component, QUAD, from, here)                                                  \
    float name(ivec2 face, vec2 p, int slice) {                                                    \
        uint at = flow_corner(face, slice);                                                        \
        vec2 was = from, to = flow_trace(p, here(face, slice), 1.0, slice);                        \
        float first = hat_velocity[at].component;                                                  \
        if (flow_is_near(was, slice) || flow_is_near(to, slice)) return first;                     \
        flow_quad q = QUAD(was), back = QUAD(to);                                                  \
        vec4 found = FLOW_FOUR(flow_velocity, component, q, slice);                                \
        float there = flow_mix(FLOW_FOUR(hat_velocity, component, back, slice), back.t);           \
        float value = first + 0.5 * (flow_velocity[at].component - there);                         \
        return clamp(value, flow_least(found), flow_most(found));                                  \
    }

vec4 carry_scalars(ivec2 cell, int slice) {
    uint at = flow_cell(cell, slice);
    vec2 from = flow_traced[flow_traced_cell(cell, slice)];
    vec2 to = flow_trace(vec2(cell) + 0.5, flow_velocity_of(cell, slice), 1.0, slice);
    vec4 first = hat_scalars[at], own = flow_scalars[at];
    if (flow_is_near(from, slice) || flow_is_near(to, slice)) return first;
    flow_scalar_quad q = flow_scalars_before(from, slice), back = hat_scalars_at(to, slice);
    vec4 value = first + 0.5 * (own - flow_scalars_mean(back, own));
    return clamp(value, min(min(q.value[0], q.value[1]), min(q.value[2], q.value[3])),
                 max(max(q.value[0], q.value[1]), max(q.value[2], q.value[3])));
}
#else
#define CARRY(name, component, QUAD, from, here)                                                  \
    float name(ivec2 face, vec2 p, int slice) {                                                    \
        flow_quad q = QUAD(flow_trace(p, here(face, slice), -1.0, slice));                         \
        return flow_mix(FLOW_FOUR(flow_velocity, component, q, slice), q.t);                       \
    }

vec4 carry_scalars(ivec2 cell, int slice) {
    vec2 from = flow_trace(vec2(cell) + 0.5, flow_velocity_of(cell, slice), -1.0, slice);
    vec4 own = flow_scalars[flow_cell(cell, slice)];
    return flow_scalars_mean(flow_scalars_before(from, slice), own);
}
#endif

CARRY(carry_u, x, flow_quad_u, flow_traced[flow_traced_left(face, slice)], flow_velocity_left)
CARRY(carry_v, y, flow_quad_v, flow_traced[flow_traced_bottom(face, slice)], flow_velocity_bottom)

// ---- forces -----------------------------------------------------------------------------------

ivec2 around(ivec2 cell) {
    if (FLOW_AROUND_X) cell.x = (cell.x + FLOW_NX) % FLOW_NX;
    if (FLOW_AROUND_Y) cell.y = (cell.y + FLOW_NY) % FLOW_NY;
    return cell;
}
ivec2 nearest(ivec2 cell) { // in the slice
    return clamp(around(cell), ivec2(0), FLOW_SIZE - 1);
}

// Confinement (Fedkiw, Stam and Jensen 2001), of both velocities of a cell. Vorticity is that of
// the corners of cells, times the side of a cell.
vec2 confine(ivec2 cell, int slice) {
    const ivec2 no = ivec2(0);
    const ivec2 last_u = ivec2(FLOW_NX, FLOW_NY - 1), last_v = ivec2(FLOW_NX - 1, FLOW_NY);
    float u[12], v[12], w[9], m[9];
    for (int i = 0; i < 12; i++) {
        ivec2 at_u = around(cell + ivec2(i % 3 - 1, i / 3 - 2));
        ivec2 at_v = around(cell + ivec2(i % 4 - 2, i / 4 - 1));
        u[i] = flow_velocity[flow_corner(clamp(at_u, no, last_u), slice)].x;
        v[i] = flow_velocity[flow_corner(clamp(at_v, no, last_v), slice)].y;
    }
    for (int i = 0; i < 9; i++) {
        int at = i / 3 * 4 + i % 3;
        w[i] = (v[at + 1] - v[at]) - (u[i + 3] - u[i]);
    }
    // w[4] is the corner between the left face, up to w[7], and the bottom face, up to w[5].
    for (int i = 0; i < 9; i++) m[i] = abs(w[i]);
    vec2 left = vec2(0.25 * (m[5] + m[8] - m[3] - m[6]), m[7] - m[4]);
    vec2 bottom = vec2(m[5] - m[4], 0.25 * (m[7] + m[8] - m[1] - m[2]));
    float up = left.y / max(length(left), 1e-12), right = bottom.x / max(length(bottom), 1e-12);
    return vorticity * vec2(0.5 * up * (w[4] + w[7]), -0.5 * right * (w[4] + w[5]));
}

vec2 forces(ivec2 cell, int slice) {
    vec4 here = flow_scalars[flow_cell(nearest(cell), slice)];
    vec4 below = flow_scalars[flow_cell(nearest(cell - ivec2(0, 1)), slice)];
    vec2 a = acceleration;
    a.y += dot(0.5 * (here.xy + below.xy), buoyancy);
    if (vorticity != 0.0) a += confine(cell, slice);
    return dt * a;
}

// ---- sources, and what stands in the way ------------------------------------------------------

#if FLOW_WITH_SOURCES
// Of a face: the mean of the cells on its two sides.
float give(float velocity, ivec2 cell, ivec2 other, int component, int slice) {
    flow_source a, b;
    FLOW_SOURCE_LOAD(nearest(cell), slice, a)
    FLOW_SOURCE_LOAD(nearest(other), slice, b)
    float share = clamp(0.5 * flow_clean(a.share.w + b.share.w), 0.0, 1.0);
    return velocity * (1.0 - share) + 0.5 * flow_clean(a.push[component] + b.push[component]);
}
#endif

// The velocity of a face that nothing passes, or of one that it is open for.
float obstruct(float velocity, ivec2 cell, ivec2 other, int component, int slice) {
#if FLOW_WITH_OBSTACLES
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 2; i++) {
        ivec2 side = around(i == 0 ? cell : other);
        if (!flow_inside(side)) continue;
        vec4 o = flow_obstacles[flow_cell(side, slice)];
        if (o.x >= 0.5) sum += vec2(flow_clean(o[1 + component]), 1.0);
    }
    if (sum.y > 0.0) return sum.x / sum.y;
#endif
    return velocity;
}

float limit(float v) {
    return clamp(flow_clean(v), -max_speed, max_speed);
}

void advance_velocity(ivec2 cell, int slice) {
    vec2 corner = vec2(cell), v = vec2(0.0), force = forces(cell, slice);
    ivec2 left = cell - ivec2(1, 0), below = cell - ivec2(0, 1);
    if (cell.y < FLOW_NY) {
        v.x = carry_u(cell, corner + vec2(0.0, 0.5), slice) + force.x;
#if FLOW_WITH_SOURCES
        v.x = give(v.x, cell, left, 0, slice);
#endif
        v.x = obstruct(limit(v.x), cell, left, 0, slice);
        if (FLOW_FACE_LEFT == FLOW_CLOSED && cell.x == 0) v.x = wall_velocity[0].x;
        if (FLOW_FACE_RIGHT == FLOW_CLOSED && cell.x == FLOW_NX) v.x = wall_velocity[1].x;
    }
    if (cell.x < FLOW_NX) {
        v.y = carry_v(cell, corner + vec2(0.5, 0.0), slice) + force.y;
#if FLOW_WITH_SOURCES
        v.y = give(v.y, cell, below, 1, slice);
#endif
        v.y = obstruct(limit(v.y), cell, below, 1, slice);
        if (FLOW_FACE_BOTTOM == FLOW_CLOSED && cell.y == 0) v.y = wall_velocity[2].y;
        if (FLOW_FACE_TOP == FLOW_CLOSED && cell.y == FLOW_NY) v.y = wall_velocity[3].y;
    }
    velocity_to[flow_corner(cell, slice)] = vec2(limit(v.x), limit(v.y));
}

void advance_scalars(ivec2 cell, int slice) {
    vec3 value = carry_scalars(cell, slice).xyz * kept;
#if FLOW_WITH_SOURCES
    flow_source s;
    FLOW_SOURCE_LOAD(cell, slice, s)
    value = value * (1.0 - clamp(flow_clean(s.share).xyz, 0.0, 1.0)) + s.add;
#endif
    if (flow_is_solid(cell, slice)) value = vec3(0.0);
    scalars_to[flow_cell(cell, slice)] = flow_clean(vec4(value, 0.0));
}

void main() {
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    int slice = int(gl_GlobalInvocationID.z);
    ivec2 last = FLOW_SIZE - ivec2(FLOW_AROUND_X, FLOW_AROUND_Y);
    if (any(greaterThan(cell, last))) return;
    advance_velocity(cell, slice);
    if (flow_inside(cell)) advance_scalars(cell, slice);
}
