// Velocities and scalars between cells: positions are in cells from the slice's lower left corner.
#ifndef SIM_FLOW_SAMPLE_GLSL
#define SIM_FLOW_SAMPLE_GLSL

struct flow_quad { // four places, the weights of the right and of the upper ones
    ivec2 low, high;
    vec2 t;
};

// `last`: the greatest index; what is beyond an end goes around, or is what is there.
flow_quad flow_quad_at(vec2 p, ivec2 last) {
    vec2 cell = floor(p);
    flow_quad q = flow_quad(ivec2(cell), ivec2(cell) + 1, p - cell);
    if (FLOW_AROUND_X) {
        q.low.x = (q.low.x + 64 * FLOW_NX) % FLOW_NX;
        q.high.x = (q.high.x + 64 * FLOW_NX) % FLOW_NX;
    }
    if (FLOW_AROUND_Y) {
        q.low.y = (q.low.y + 64 * FLOW_NY) % FLOW_NY;
        q.high.y = (q.high.y + 64 * FLOW_NY) % FLOW_NY;
    }
    q.low = clamp(q.low, ivec2(0), last);
    q.high = clamp(q.high, ivec2(0), last);
    return q;
}

// Horizontal velocities are of left faces, vertical ones of bottom faces.
flow_quad flow_quad_u(vec2 p) {
    return flow_quad_at(p - vec2(0.0, 0.5), ivec2(FLOW_NX, FLOW_NY - 1));
}
flow_quad flow_quad_v(vec2 p) {
    return flow_quad_at(p - vec2(0.5, 0.0), ivec2(FLOW_NX - 1, FLOW_NY));
}

float flow_mix(vec4 v, vec2 t) {
    vec2 row = mix(v.xz, v.yw, t.x);
    return mix(row.x, row.y, t.y);
}
float flow_least(vec4 v) {
    return min(min(v.x, v.y), min(v.z, v.w));
}
float flow_most(vec4 v) {
    return max(max(v.x, v.y), max(v.z, v.w));
}

// The four values of a component of a buffer of velocities.
#define FLOW_FOUR(velocity, component, q, slice)                                                   \
    vec4(velocity[flow_corner((q).low, slice)].component,                                          \
         velocity[flow_corner(ivec2((q).high.x, (q).low.y), slice)].component,                     \
         velocity[flow_corner(ivec2((q).low.x, (q).high.y), slice)].component,                     \
         velocity[flow_corner((q).high, slice)].component)
#endif
