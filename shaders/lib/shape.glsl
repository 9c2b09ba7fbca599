// Solids as densities: 0 outside, rising to 1 at the depth `falloff` below the surface (metres).
// Signed distances after Quilez, "3D SDFs". Twins in C: src/field/kinds_shape.c.
#ifndef LIB_SHAPE_GLSL
#define LIB_SHAPE_GLSL
#include "lib/shape.h"

float shape_sphere(vec3 p, vec3 position, float radius, float falloff) {
    return shape_density(length(p - position) - radius, falloff);
}

float shape_box(vec3 p, vec3 position, vec3 size, float falloff) {
    vec3 q = abs(p - position) - 0.5 * size;
    return shape_density(length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0), falloff);
}

float shape_capsule(vec3 p, vec3 from, vec3 to, float radius, float falloff) {
    vec3 a = p - from, b = to - from;
    float t = clamp(dot(a, b) / max(dot(b, b), 1e-12), 0.0, 1.0);
    return shape_density(length(a - b * t) - radius, falloff);
}

float shape_torus(vec3 p, vec3 position, float radius, float thickness, float falloff) {
    vec3 q = p - position;
    return shape_density(length(vec2(length(q.xy) - radius, q.z)) - thickness, falloff);
}

float shape_disc(vec3 p, float x, float y, float radius, float falloff) {
    return shape_density(length(p.xy - vec2(x, y)) - radius, falloff);
}

#endif
