// Ranges of operators (lib/range.h) for vectors.
#ifndef LIB_RANGE_OPERATOR_GLSL
#define LIB_RANGE_OPERATOR_GLSL
#include "lib/range.glsl"
#include "lib/operator.glsl"

range1 range_atan(range1 y, range1 x) { return range1(-3.1416, 3.1416); }

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
