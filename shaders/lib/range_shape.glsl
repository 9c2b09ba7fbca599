// Ranges of shapes (lib/shape.glsl): from the range of the distance. Twins in C:
// src/field/range_kinds.c.
#ifndef LIB_RANGE_SHAPE_GLSL
#define LIB_RANGE_SHAPE_GLSL
#include "lib/range_operator.glsl"
#include "lib/range_shape.h"
#include "lib/shape.glsl"

range1 range_sphere(range3 p, range3 position, range1 radius, range1 falloff) {
    return range_density(range_sub(range_length(range_sub(p, position)), radius), falloff);
}

float range_box_distance(vec3 q) { // rises with every coordinate
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

range1 range_box(range3 p, range3 position, range3 size, range1 falloff) {
    range3 q = range_abs(range_sub(p, position)), half_size = range_mul(size, range_number(vec3(0.5)));
    q = range_sub(q, half_size);
    return range_density(range_wide(range_box_distance(clamp(q.low, -RANGE_MOST, RANGE_MOST)),
                                    range_box_distance(min(q.high, RANGE_MOST))), falloff);
}

// The distance of a point from a line changes by no more than the point and the line's ends move.
range1 range_capsule(range3 p, range3 from, range3 to, range1 radius, range1 falloff) {
    vec3 at = 0.5 * (p.low + p.high), a = 0.5 * (from.low + from.high), b = 0.5 * (to.low + to.high);
    float ends = max(length(0.5 * (from.high - from.low)), length(0.5 * (to.high - to.low)));
    float reach = length(0.5 * (p.high - p.low)) + ends;
    vec3 r = at - a, line = b - a;
    float t = clamp(dot(r, line) / max(dot(line, line), 1e-12), 0.0, 1.0), d = length(r - line * t);
    if (!(reach < 1e6)) return range1(0.0, 1.0);
    reach += 1e-6 * (length(at) + length(a) + length(b));
    return range_density(range_sub(range_wide(max(d - reach, 0.0), d + reach), radius), falloff);
}

range1 range_torus(range3 p, range3 position, range1 radius, range1 thickness, range1 falloff) {
    range3 q = range_sub(p, position);
    range1 none = range1(0.0, 0.0);
    range1 ring = range_sub(range_length(range_vec(range_x(q), range_y(q), none)), radius);
    return range_density(range_sub(range_length(range_vec(ring, range_z(q), none)), thickness), falloff);
}

range1 range_disc(range3 p, range1 x, range1 y, range1 radius, range1 falloff) {
    range3 q = range_vec(range_sub(range_x(p), x), range_sub(range_y(p), y), range_number(0.0));
    return range_density(range_sub(range_length(q), radius), falloff);
}

#endif
