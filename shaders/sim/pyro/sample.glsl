// Values between cells, and velocities around a cell. Positions are in cells from the box's lowest
// corner. All is written out by axis: software drivers keep what is indexed by a variable in memory.
#ifndef SIM_PYRO_SAMPLE_GLSL
#define SIM_PYRO_SAMPLE_GLSL

uniform vec3 inflow; // m/s, across faces that are PYRO_INFLOW

const bvec3 PYRO_PASSES_LOW = bvec3(PYRO_LOW_X == PYRO_OPEN || PYRO_LOW_X == PYRO_INFLOW,
                                    PYRO_LOW_Y == PYRO_OPEN || PYRO_LOW_Y == PYRO_INFLOW,
                                    PYRO_LOW_Z == PYRO_OPEN || PYRO_LOW_Z == PYRO_INFLOW);
const bvec3 PYRO_PASSES_HIGH = bvec3(PYRO_HIGH_X == PYRO_OPEN || PYRO_HIGH_X == PYRO_INFLOW,
                                     PYRO_HIGH_Y == PYRO_OPEN || PYRO_HIGH_Y == PYRO_INFLOW,
                                     PYRO_HIGH_Z == PYRO_OPEN || PYRO_HIGH_Z == PYRO_INFLOW);
// At the last face of an axis the velocity is known.
const bvec3 PYRO_ENDS = bvec3(PYRO_HIGH_X == PYRO_WALL || PYRO_HIGH_X == PYRO_INFLOW,
                              PYRO_HIGH_Y == PYRO_WALL || PYRO_HIGH_Y == PYRO_INFLOW,
                              PYRO_HIGH_Z == PYRO_WALL || PYRO_HIGH_Z == PYRO_INFLOW);
const vec3 PYRO_END_FLOWS = vec3(PYRO_HIGH_X == PYRO_INFLOW, PYRO_HIGH_Y == PYRO_INFLOW,
                                 PYRO_HIGH_Z == PYRO_INFLOW);
// The first face of each axis whose velocity is stored.
const ivec3 PYRO_FIRST = ivec3(PYRO_LOW_X == PYRO_OPEN, PYRO_LOW_Y == PYRO_OPEN, PYRO_LOW_Z == PYRO_OPEN);

// Whether a place is beyond a face that gas can pass.
bool pyro_is_beyond(vec3 p) {
    return any(both(lessThan(p, vec3(0.0)), PYRO_PASSES_LOW)) ||
           any(both(greaterThan(p, vec3(PYRO_SIZE)), PYRO_PASSES_HIGH));
}

// Into the box: around, or the nearest place in it.
vec3 pyro_into(vec3 p) {
    vec3 size = vec3(PYRO_SIZE);
    return mix(clamp(p, vec3(0.0), size), p - size * floor(p / size), PYRO_AROUND);
}

// Two coordinates along each axis as places, and the weight of the higher one.
struct pyro_span {
    ivec3 low, high;
    vec3 t;
    bvec3 ends; // the higher one is the last face of the axis, whose velocity is known
};

// Of a place in the box. `face`: 1 along the axis on whose faces values lie.
pyro_span pyro_span_at(vec3 p, ivec3 face) {
    vec3 at = p - 0.5 + 0.5 * vec3(face), low = floor(at);
    ivec3 i = ivec3(low), j = i + 1, last = PYRO_SIZE - 1, first = face * PYRO_FIRST;
    pyro_span s;
    s.t = at - low;
    s.ends = both(both(greaterThan(j, last), PYRO_ENDS), bvec3(face));
    s.low = pyro_places(mix(clamp(i, first, last), pyro_around(i), PYRO_AROUND));
    s.high = pyro_places(mix(clamp(j, first, last), pyro_around(j), PYRO_AROUND));
    return s;
}

// The eight values of a component of an array: those that are low along x first.
#define PYRO_EIGHT(from, component, s, low4, high4)                                                \
    {                                                                                              \
        int a_ = s.low.y + s.low.z, b_ = s.high.y + s.low.z;                                       \
        int c_ = s.low.y + s.high.z, d_ = s.high.y + s.high.z;                                     \
        low4 = vec4(PYRO_##component(from[a_ + s.low.x]), PYRO_##component(from[b_ + s.low.x]),    \
                    PYRO_##component(from[c_ + s.low.x]), PYRO_##component(from[d_ + s.low.x]));   \
        high4 = vec4(PYRO_##component(from[a_ + s.high.x]), PYRO_##component(from[b_ + s.high.x]), \
                     PYRO_##component(from[c_ + s.high.x]), PYRO_##component(from[d_ + s.high.x]));\
        vec3 end_ = inflow * PYRO_END_FLOWS;                                                       \
        if (s.ends.x) high4 = vec4(end_.x);                                                        \
        if (s.ends.y) low4.yw = high4.yw = vec2(end_.y);                                           \
        if (s.ends.z) low4.zw = high4.zw = vec2(end_.z);                                           \
    }

float pyro_mix(vec4 low, vec4 high, vec3 t) {
    vec4 x = mix(low, high, t.x);
    vec2 y = mix(x.xz, x.yw, t.y);
    return mix(y.x, y.y, t.z);
}

// ---- around a cell ----------------------------------------------------------------------------

// Places of a cell and of that before it, of the faces at its two ends.
struct pyro_near {
    ivec3 cell, below, face, next;
    bvec3 ends; // the face at the higher end is the last of the axis, whose velocity is known
};

pyro_near pyro_near_of(ivec3 c) {
    ivec3 last = PYRO_SIZE - 1;
    pyro_near n;
    n.cell = pyro_places(c);
    n.below = pyro_places(mix(max(c - 1, ivec3(0)), pyro_around(c - 1), PYRO_AROUND));
    n.face = pyro_places(mix(max(c, PYRO_FIRST), c, PYRO_AROUND));
    n.next = pyro_places(mix(clamp(c + 1, PYRO_FIRST, last), pyro_around(c + 1), PYRO_AROUND));
    n.ends = both(greaterThan(c + 1, last), PYRO_ENDS);
    return n;
}

// Velocities across the faces of a cell at its lower ends, and at its higher ones.
#define PYRO_FACES(from, n, low3, high3)                                                           \
    {                                                                                              \
        low3 = vec3(PYRO_X(from[n.face.x + n.cell.y + n.cell.z]),                                  \
                    PYRO_Y(from[n.cell.x + n.face.y + n.cell.z]),                                  \
                    PYRO_Z(from[n.cell.x + n.cell.y + n.face.z]));                                 \
        high3 = vec3(PYRO_X(from[n.next.x + n.cell.y + n.cell.z]),                                 \
                     PYRO_Y(from[n.cell.x + n.next.y + n.cell.z]),                                 \
                     PYRO_Z(from[n.cell.x + n.cell.y + n.next.z]));                                \
        high3 = mix(high3, inflow * PYRO_END_FLOWS, n.ends);                                       \
    }
#endif
