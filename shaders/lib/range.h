// Ranges: the least and the greatest value that something can have in a box, by interval arithmetic
// (Moore, "Interval analysis", 1966). A range may be wider than need be, but no value ever lies
// outside of it. Here are those of single numbers; C compiles this text too (src/field/glsl.h).
//
// What lies beyond RANGE_MOST counts as without end: every bound is at most RANGE_MOST or it is
// RANGE_END. Zero times anything is zero, so that nothing outside of a grid stays nothing whatever
// it is multiplied with. Results of more than one rounding are widened by RANGE_ROUNDING of
// themselves: 0 stays 0.
#ifndef LIB_RANGE_H
#define LIB_RANGE_H
#include "lib/operator.h"

#define RANGE_MOST 1e15f
#define RANGE_END 1e30f
#define RANGE_ROUNDING 1e-6f

struct range1 {
    float low, high;
};

// Comparisons are such that what is no number counts as unknown.
SHARED range1 range_make(float low, float high) {
    return range1(low >= -RANGE_MOST ? min(low, RANGE_MOST) : -RANGE_END,
                  high <= RANGE_MOST ? max(high, -RANGE_MOST) : RANGE_END);
}

SHARED range1 range_wide(float low, float high) {
    return range_make(low - RANGE_ROUNDING * abs(low), high + RANGE_ROUNDING * abs(high));
}

SHARED range1 range_number(float v) {
    return range_make(v, v);
}

SHARED range1 range_unknown1(void) {
    return range1(-RANGE_END, RANGE_END);
}

SHARED bool range_is_zero(range1 a) {
    return a.low == 0.0f && a.high == 0.0f;
}

SHARED range1 range_union(range1 a, range1 b) {
    return range1(min(a.low, b.low), max(a.high, b.high));
}

// ---- sums and products ------------------------------------------------------------------------

SHARED range1 range_add(range1 a, range1 b) {
    return range_make(a.low + b.low, a.high + b.high);
}

SHARED range1 range_sub(range1 a, range1 b) {
    return range_make(a.low - b.high, a.high - b.low);
}

SHARED range1 range_negate(range1 a) {
    return range1(-a.high, -a.low);
}

// Of two bounds.
SHARED float range_times(float a, float b) {
    if (a == 0.0f || b == 0.0f) return 0.0f;
    if (max(abs(a), abs(b)) <= RANGE_MOST) return a * b;
    return (a < 0.0f) == (b < 0.0f) ? RANGE_END : -RANGE_END;
}

SHARED range1 range_mul(range1 a, range1 b) {
    float ll = range_times(a.low, b.low), lh = range_times(a.low, b.high);
    float hl = range_times(a.high, b.low), hh = range_times(a.high, b.high);
    return range_wide(min(min(ll, lh), min(hl, hh)), max(max(ll, lh), max(hl, hh)));
}

// The value is linear in t: it is greatest and least at an end.
SHARED range1 range_mix(range1 a, range1 b, range1 t) {
    range1 rest = range_sub(range1(1.0f, 1.0f), t);
    range1 from = range_add(range_mul(a, range1(rest.high, rest.high)), range_mul(b, range1(t.low, t.low)));
    range1 to = range_add(range_mul(a, range1(rest.low, rest.low)), range_mul(b, range1(t.high, t.high)));
    return range_union(from, to);
}

// ---- operators: what lib/operator.h, or GLSL itself, makes of any values in the ranges ---------

SHARED range1 range_min(range1 a, range1 b) {
    return range1(min(a.low, b.low), min(a.high, b.high));
}

SHARED range1 range_max(range1 a, range1 b) {
    return range1(max(a.low, b.low), max(a.high, b.high));
}

SHARED range1 range_clamp(range1 v, range1 low, range1 high) {
    return range_min(range_max(v, low), high);
}

SHARED range1 range_abs(range1 a) {
    return range1(max(max(a.low, -a.high), 0.0f), max(a.high, -a.low));
}

// 0 where b is 0.
SHARED range1 range_div(range1 a, range1 b) {
    if (range_is_zero(a) || range_is_zero(b)) return range1(0.0f, 0.0f);
    if (b.low > 0.0f || b.high < 0.0f)
        return range_mul(a, range_wide(b.high > RANGE_MOST ? 0.0f : 1.0f / b.high,
                                       b.low < -RANGE_MOST ? 0.0f : 1.0f / b.low));
    if (a.low >= 0.0f && b.low == 0.0f) return range1(0.0f, RANGE_END);
    return range_unknown1();
}

SHARED range1 range_remap(range1 v, range1 in_min, range1 in_max, range1 out_min, range1 out_max) {
    range1 t = range_div(range_sub(v, in_min), range_sub(in_max, in_min));
    return range_add(out_min, range_mul(t, range_sub(out_max, out_min)));
}

// A rounding decides on which side of the edge a value lies.
SHARED range1 range_step(range1 v, range1 edge) {
    float low = RANGE_ROUNDING * (abs(v.low) + abs(edge.high));
    float high = RANGE_ROUNDING * (abs(v.high) + abs(edge.low));
    return range1(operator_step(v.low - low, edge.high), operator_step(v.high + high, edge.low));
}

// Rises with the value and falls with both edges while these are in order; else the other way.
SHARED range1 range_smoothstep(range1 v, range1 low, range1 high) {
    const float rest = 1.0f - 2.0f * RANGE_ROUNDING; // where it ends it is exact
    float least = 0.0f, most = 1.0f;
    if (low.low == low.high && high.low == high.high && low.low == high.low) return range_step(v, low);
    if (low.high < high.low) {
        least = operator_smoothstep(v.low, low.high, high.high);
        most = operator_smoothstep(v.high, low.low, high.low);
    } else if (low.low > high.high) {
        least = operator_smoothstep(v.high, low.low, high.low);
        most = operator_smoothstep(v.low, low.high, high.high);
    }
    return range1(least < 1.0f ? least * rest : 1.0f, most > 0.0f ? min(most / rest, 1.0f) : 0.0f);
}

// 0 where a is not above 0, but 1 where b is 0. For a above 0 it is monotone in each of both.
SHARED range1 range_pow(range1 a, range1 b) {
    const float inexact = 1e-5f; // of what drivers make of it
    bool may_be_1 = b.low <= 0.0f && b.high >= 0.0f, is_1 = b.low == 0.0f && b.high == 0.0f;
    if (a.high <= 0.0f || is_1) return range1(is_1 ? 1.0f : 0.0f, may_be_1 ? 1.0f : 0.0f);
    float from = max(a.low, 0.0f);
    float ll = operator_pow(from, b.low), lh = operator_pow(from, b.high);
    float hl = operator_pow(a.high, b.low), hh = operator_pow(a.high, b.high);
    float low = min(min(ll, lh), min(hl, hh)) * (1.0f - inexact);
    float high = max(max(ll, lh), max(hl, hh)) * (1.0f + inexact);
    bool endless = (a.high > RANGE_MOST && b.high > 0.0f) || (a.low <= 0.0f && b.low < 0.0f);
    if (a.low <= 0.0f || (a.high > RANGE_MOST && b.low < 0.0f)) low = 0.0f;
    if (may_be_1) high = max(high, 1.0f);
    return range_make(low, endless ? RANGE_END : high);
}

SHARED range1 range_sqrt(range1 a) {
    return range_wide(operator_sqrt(a.low), a.high > RANGE_MOST ? RANGE_END : operator_sqrt(a.high));
}

// Drivers are inexact far from 0.
SHARED range1 range_exp(range1 a) {
    return range_make(operator_exp(a.low) * (1.0f - 1e-4f), operator_exp(a.high) * (1.0f + 1e-4f));
}

// No steeper than 1. The sine of a large number is not exact.
SHARED range1 range_sin(range1 a) {
    float middle = 0.5f * (a.low + a.high), reach = 0.5f * (a.high - a.low) + 1e-3f;
    if (!(reach < 3.0f) || abs(middle) > 1e3f) return range1(-1.0f, 1.0f);
    return range1(max(sin(middle) - reach, -1.0f), min(sin(middle) + reach, 1.0f));
}

SHARED range1 range_floor(range1 a) {
    return range_make(floor(a.low), floor(a.high));
}

SHARED range1 range_fract(range1 a) {
    if (floor(a.low) != floor(a.high) || abs(a.high) > 1e6f) return range1(0.0f, 1.0f);
    return range1(fract(a.low), fract(a.high));
}

#endif
