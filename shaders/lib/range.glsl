// Ranges: the least and the greatest value that something can have in a box, by interval arithmetic
// (Moore, "Interval analysis", 1966). A range may be wider than need be, but no value ever lies
// outside of it. Twins in C: src/field/range.h.
//
// What lies beyond RANGE_MOST counts as without end: every bound is at most RANGE_MOST or it is
// RANGE_END. Zero times anything is zero, so that nothing outside of a grid stays nothing whatever
// it is multiplied with. Results of more than one rounding are widened by RANGE_ROUNDING of
// themselves: 0 stays 0.
#ifndef LIB_RANGE_GLSL
#define LIB_RANGE_GLSL

struct range1 {
    float low, high;
};
struct range3 {
    vec3 low, high;
};
struct range4 {
    vec4 low, high;
};

const float RANGE_MOST = 1e15, RANGE_END = 1e30, RANGE_ROUNDING = 1e-6;

// Comparisons are such that what is no number counts as unknown.
float range_low(float v) {
    return v >= -RANGE_MOST ? min(v, RANGE_MOST) : -RANGE_END;
}

float range_high(float v) {
    return v <= RANGE_MOST ? max(v, -RANGE_MOST) : RANGE_END;
}

range1 range_make(float low, float high) {
    return range1(range_low(low), range_high(high));
}

range1 range_wide(float low, float high) {
    return range_make(low - RANGE_ROUNDING * abs(low), high + RANGE_ROUNDING * abs(high));
}

bool range_is_zero(range1 a) {
    return a.low == 0.0 && a.high == 0.0;
}

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

range1 range_number(float v) { return range_make(v, v); }

range3 range_number(vec3 v) {
    return range_vec(range_number(v.x), range_number(v.y), range_number(v.z));
}

range4 range_number(vec4 v) {
    return range_vec(range_number(v.x), range_number(v.y), range_number(v.z), range_number(v.w));
}

range1 range_unknown1() { return range1(-RANGE_END, RANGE_END); }
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

range1 range_union(range1 a, range1 b) {
    return range1(min(a.low, b.low), max(a.high, b.high));
}

range4 range_union(range4 a, range4 b) {
    return range4(min(a.low, b.low), max(a.high, b.high));
}

// ---- sums and products ------------------------------------------------------------------------

range1 range_add(range1 a, range1 b) {
    return range_make(a.low + b.low, a.high + b.high);
}

range1 range_sub(range1 a, range1 b) {
    return range_make(a.low - b.high, a.high - b.low);
}

range1 range_negate(range1 a) {
    return range1(-a.high, -a.low);
}

// Of two bounds.
float range_times(float a, float b) {
    if (a == 0.0 || b == 0.0) return 0.0;
    return max(abs(a), abs(b)) > RANGE_MOST ? sign(a) * sign(b) * RANGE_END : a * b;
}

range1 range_mul(range1 a, range1 b) {
    float ll = range_times(a.low, b.low), lh = range_times(a.low, b.high);
    float hl = range_times(a.high, b.low), hh = range_times(a.high, b.high);
    return range_wide(min(min(ll, lh), min(hl, hh)), max(max(ll, lh), max(hl, hh)));
}

// The value is linear in t: it is greatest and least at an end.
range1 range_mix(range1 a, range1 b, range1 t) {
    range1 rest = range_sub(range1(1.0, 1.0), t);
    range1 from = range_add(range_mul(a, range1(rest.high, rest.high)), range_mul(b, range1(t.low, t.low)));
    range1 to = range_add(range_mul(a, range1(rest.low, rest.low)), range_mul(b, range1(t.high, t.high)));
    return range_union(from, to);
}

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
