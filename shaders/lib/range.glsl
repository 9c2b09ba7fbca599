// lib/range.h for vectors.
#ifndef LIB_RANGE_GLSL
#define LIB_RANGE_GLSL
#include "lib/range.h"

struct range3 {
    vec3 low, high;
};
struct range4 {
    vec4 low, high;
};

bool range_is_zero(range3 a) {
    return a.low == vec3(0.0) && a.high == vec3(0.0);
}

bool range_is_zero(range4 a) {
    return a.low == vec4(0.0) && a.high == vec4(0.0);
}

// ---- parts ------------------------------------------------------------------------------------

range1 range_x(range3 a) { return range1(a.low.x, a.high.x); }
range1 range_y(range3 a) { return range1(a.low.y, a.high.y); }
range1 range_z(range3 a) { return range1(a.low.z, a.high.z); }
range1 range_x(range4 a) { return range1(a.low.x, a.high.x); }
range1 range_y(range4 a) { return range1(a.low.y, a.high.y); }
range1 range_z(range4 a) { return range1(a.low.z, a.high.z); }
range1 range_w(range4 a) { return range1(a.low.w, a.high.w); }

range3 range_vec(range1 x, range1 y, range1 z) {
    return range3(vec3(x.low, y.low, z.low), vec3(x.high, y.high, z.high));
}

range4 range_vec(range1 x, range1 y, range1 z, range1 w) {
    return range4(vec4(x.low, y.low, z.low, w.low), vec4(x.high, y.high, z.high, w.high));
}

range3 range_vec3(range1 a) { return range_vec(a, a, a); }
range4 range_vec4(range1 a) { return range_vec(a, a, a, a); }

// A function of single ranges for vectors, component by component.
#define RANGE_EACH_1(NAME)                                                                         \
    range3 NAME(range3 a) { return range_vec(NAME(range_x(a)), NAME(range_y(a)), NAME(range_z(a))); } \
    range4 NAME(range4 a) {                                                                        \
        return range_vec(NAME(range_x(a)), NAME(range_y(a)), NAME(range_z(a)), NAME(range_w(a)));  \
    }
#define RANGE_EACH_2(NAME)                                                                         \
    range3 NAME(range3 a, range3 b) {                                                              \
        return range_vec(NAME(range_x(a), range_x(b)), NAME(range_y(a), range_y(b)),               \
                         NAME(range_z(a), range_z(b)));                                            \
    }                                                                                              \
    range4 NAME(range4 a, range4 b) {                                                              \
        return range_vec(NAME(range_x(a), range_x(b)), NAME(range_y(a), range_y(b)),               \
                         NAME(range_z(a), range_z(b)), NAME(range_w(a), range_w(b)));              \
    }
#define RANGE_EACH_3(NAME)                                                                         \
    range3 NAME(range3 a, range3 b, range3 c) {                                                    \
        return range_vec(NAME(range_x(a), range_x(b), range_x(c)),                                 \
                         NAME(range_y(a), range_y(b), range_y(c)),                                 \
                         NAME(range_z(a), range_z(b), range_z(c)));                                \
    }                                                                                              \
    range4 NAME(range4 a, range4 b, range4 c) {                                                    \
        return range_vec(NAME(range_x(a), range_x(b), range_x(c)),                                 \
                         NAME(range_y(a), range_y(b), range_y(c)),                                 \
                         NAME(range_z(a), range_z(b), range_z(c)),                                 \
                         NAME(range_w(a), range_w(b), range_w(c)));                                \
    }

// ---- a single value, and no knowledge ---------------------------------------------------------

range3 range_number(vec3 v) {
    return range_vec(range_number(v.x), range_number(v.y), range_number(v.z));
}

range4 range_number(vec4 v) {
    return range_vec(range_number(v.x), range_number(v.y), range_number(v.z), range_number(v.w));
}

range3 range_unknown3() { return range_vec3(range_unknown1()); }
range4 range_unknown4() { return range_vec4(range_unknown1()); }

// Of what no place tells.
range1 range_nowhere1(range3 p) { return range_unknown1(); }
range3 range_nowhere3(range3 p) { return range_unknown3(); }
range4 range_nowhere4(range3 p) { return range_unknown4(); }

// Of such a part of a whole, and of a direction.
range1 range_share1(range3 p) { return range1(0.0, 1.0); }
range3 range_share3(range3 p) { return range_vec3(range1(0.0, 1.0)); }
range3 range_way3(range3 p) { return range_vec3(range1(-1.0, 1.0)); }

range4 range_union(range4 a, range4 b) {
    return range4(min(a.low, b.low), max(a.high, b.high));
}

// ---- sums and products ------------------------------------------------------------------------

RANGE_EACH_2(range_add)
RANGE_EACH_2(range_sub)
RANGE_EACH_1(range_negate)
RANGE_EACH_2(range_mul)
RANGE_EACH_3(range_mix)

// ---- points -----------------------------------------------------------------------------------

// Where a matrix of these rows takes the points of a box.
range3 range_transform(range3 p, vec4 x, vec4 y, vec4 z) {
    range3 a = range_mul(p, range_number(x.xyz)), b = range_mul(p, range_number(y.xyz)),
           c = range_mul(p, range_number(z.xyz));
    return range_vec(
        range_add(range_add(range_add(range_x(a), range_y(a)), range_z(a)), range_number(x.w)),
        range_add(range_add(range_add(range_x(b), range_y(b)), range_z(b)), range_number(y.w)),
        range_add(range_add(range_add(range_x(c), range_y(c)), range_z(c)), range_number(z.w)));
}

// p + amount * by.
range3 range_move(range3 p, range3 by, range1 amount) {
    return range_add(p, range_mul(range_vec3(amount), by));
}

#endif
