// Ranges of operators: each holds what the operator (lib/operator.glsl, or GLSL's own) makes of any
// values in the ranges of its arguments. Twins in C: src/field/range_kinds.c.
#ifndef LIB_RANGE_OPERATOR_GLSL
#define LIB_RANGE_OPERATOR_GLSL
#include "lib/range.glsl"
#include "lib/operator.glsl"

range1 range_min(range1 a, range1 b) {
    return range1(min(a.low, b.low), min(a.high, b.high));
}

range1 range_max(range1 a, range1 b) {
    return range1(max(a.low, b.low), max(a.high, b.high));
}

range1 range_clamp(range1 v, range1 low, range1 high) {
    return range_min(range_max(v, low), high);
}

range1 range_abs(range1 a) {
    return range1(max(max(a.low, -a.high), 0.0), max(a.high, -a.low));
}

// 0 where b is 0.
range1 range_div(range1 a, range1 b) {
    if (range_is_zero(a) || range_is_zero(b)) return range1(0.0, 0.0);
    if (b.low > 0.0 || b.high < 0.0)
        return range_mul(a, range_wide(b.high > RANGE_MOST ? 0.0 : 1.0 / b.high,
                                       b.low < -RANGE_MOST ? 0.0 : 1.0 / b.low));
    if (a.low >= 0.0 && b.low == 0.0) return range1(0.0, RANGE_END);
    return range_unknown1();
}

range1 range_remap(range1 v, range1 in_min, range1 in_max, range1 out_min, range1 out_max) {
    range1 t = range_div(range_sub(v, in_min), range_sub(in_max, in_min));
    return range_add(out_min, range_mul(t, range_sub(out_max, out_min)));
}

// A rounding decides on which side of the edge a value lies.
range1 range_step(range1 v, range1 edge) {
    float low = RANGE_ROUNDING * (abs(v.low) + abs(edge.high)), high = RANGE_ROUNDING * (abs(v.high) + abs(edge.low));
    return range1(v.low - low >= edge.high ? 1.0 : 0.0, v.high + high >= edge.low ? 1.0 : 0.0);
}

// Rises with the value and falls with both edges while these are in order; else the other way.
range1 range_smoothstep(range1 v, range1 low, range1 high) {
    if (low.low == low.high && high.low == high.high && low.low == high.low) return range_step(v, low);
    float least = 0.0, most = 1.0;
    if (low.high < high.low) {
        least = operator_smoothstep(v.low, low.high, high.high);
        most = operator_smoothstep(v.high, low.low, high.low);
    } else if (low.low > high.high) {
        least = operator_smoothstep(v.high, low.low, high.low);
        most = operator_smoothstep(v.low, low.high, high.high);
    }
    const float rest = 1.0 - 2.0 * RANGE_ROUNDING; // where it ends it is exact
    return range1(least < 1.0 ? least * rest : 1.0, most > 0.0 ? min(most / rest, 1.0) : 0.0);
}

// 0 where a is not above 0, but 1 where b is 0. For a above 0 it is monotone in each of both.
range1 range_pow(range1 a, range1 b) {
    bool may_be_1 = b.low <= 0.0 && b.high >= 0.0, is_1 = b.low == 0.0 && b.high == 0.0;
    if (a.high <= 0.0 || is_1) return range1(is_1 ? 1.0 : 0.0, may_be_1 ? 1.0 : 0.0);
    float from = max(a.low, 0.0);
    float ll = operator_pow(from, b.low), lh = operator_pow(from, b.high);
    float hl = operator_pow(a.high, b.low), hh = operator_pow(a.high, b.high);
    const float inexact = 1e-5; // of what drivers make of it
    float low = min(min(ll, lh), min(hl, hh)) * (1.0 - inexact);
    float high = max(max(ll, lh), max(hl, hh)) * (1.0 + inexact);
    bool endless = (a.high > RANGE_MOST && b.high > 0.0) || (a.low <= 0.0 && b.low < 0.0);
    if (a.low <= 0.0 || (a.high > RANGE_MOST && b.low < 0.0)) low = 0.0;
    if (may_be_1) high = max(high, 1.0);
    return range_make(low, endless ? RANGE_END : high);
}

range1 range_sqrt(range1 a) {
    return range_wide(operator_sqrt(a.low), a.high > RANGE_MOST ? RANGE_END : operator_sqrt(a.high));
}

range1 range_exp(range1 a) {
    float low = operator_exp(a.low), high = operator_exp(a.high);
    return range_make(low * (1.0 - 1e-4), high * (1.0 + 1e-4)); // drivers are inexact far from 0
}

range1 range_atan(range1 y, range1 x) { return range1(-3.1416, 3.1416); }

// No steeper than 1. The sine of a large number is not exact.
range1 range_sin(range1 a) {
    float middle = 0.5 * (a.low + a.high), reach = 0.5 * (a.high - a.low) + 1e-3;
    if (!(reach < 3.0) || abs(middle) > 1e3) return range1(-1.0, 1.0);
    return range1(max(sin(middle) - reach, -1.0), min(sin(middle) + reach, 1.0));
}

range1 range_floor(range1 a) {
    return range_make(floor(a.low), floor(a.high));
}

range1 range_fract(range1 a) {
    if (floor(a.low) != floor(a.high) || abs(a.high) > 1e6) return range1(0.0, 1.0);
    return range1(fract(a.low), fract(a.high));
}

RANGE_EACH_2(range_min)
RANGE_EACH_2(range_max)
RANGE_EACH_3(range_clamp)
RANGE_EACH_1(range_abs)
RANGE_EACH_2(range_div)
RANGE_EACH_2(range_step)
RANGE_EACH_3(range_smoothstep)
RANGE_EACH_2(range_pow)
RANGE_EACH_1(range_sqrt)
RANGE_EACH_1(range_exp)
RANGE_EACH_1(range_sin)
RANGE_EACH_1(range_floor)
RANGE_EACH_1(range_fract)

range3 range_remap(range3 v, range3 in_min, range3 in_max, range3 out_min, range3 out_max) {
    range3 t = range_div(range_sub(v, in_min), range_sub(in_max, in_min));
    return range_add(out_min, range_mul(t, range_sub(out_max, out_min)));
}

range4 range_remap(range4 v, range4 in_min, range4 in_max, range4 out_min, range4 out_max) {
    range4 t = range_div(range_sub(v, in_min), range_sub(in_max, in_min));
    return range_add(out_min, range_mul(t, range_sub(out_max, out_min)));
}

range1 range_dot(range1 a, range1 b) { return range_mul(a, b); }

range1 range_dot(range3 a, range3 b) {
    range3 c = range_mul(a, b);
    return range_add(range_add(range_x(c), range_y(c)), range_z(c));
}

range1 range_dot(range4 a, range4 b) {
    range4 c = range_mul(a, b);
    return range_add(range_add(range_add(range_x(c), range_y(c)), range_z(c)), range_w(c));
}

// Squares are of bounds without their signs.
range1 range_length(range1 a) { return range_abs(a); }

range1 range_length(range3 a) {
    range3 b = range_abs(a);
    return range_sqrt(range_dot(b, b));
}

range1 range_length(range4 a) {
    range4 b = range_abs(a);
    return range_sqrt(range_dot(b, b));
}

#endif
