// Shapes: the twin of shaders/lib/shape.glsl, and their boxes, known when no argument varies in
// space.
#include "field/kinds.h"
#include <math.h>

static float length3(float x, float y, float z) {
    return sqrtf(x * x + y * y + z * z);
}

void eval_sphere(const field_point *at, const float (*a)[4], float out[4]) {
    out[0] = shape_density(
        length3(at->p.x - a[0][0], at->p.y - a[0][1], at->p.z - a[0][2]) - a[1][0], a[2][0]);
}

void eval_box(const field_point *at, const float (*a)[4], float out[4]) {
    float x = fabsf(at->p.x - a[0][0]) - 0.5f * a[1][0],
          y = fabsf(at->p.y - a[0][1]) - 0.5f * a[1][1];
    float z = fabsf(at->p.z - a[0][2]) - 0.5f * a[1][2];
    float outside = length3(fmaxf(x, 0), fmaxf(y, 0), fmaxf(z, 0));
    out[0] = shape_density(outside + fminf(fmaxf(x, fmaxf(y, z)), 0), a[2][0]);
}

void eval_capsule(const field_point *at, const float (*a)[4], float out[4]) {
    float r[3] = {at->p.x - a[0][0], at->p.y - a[0][1], at->p.z - a[0][2]};
    float b[3] = {a[1][0] - a[0][0], a[1][1] - a[0][1], a[1][2] - a[0][2]};
    float square = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
    float t = (r[0] * b[0] + r[1] * b[1] + r[2] * b[2]) / fmaxf(square, 1e-12f);
    t = clampf(t, 0, 1);
    float distance = length3(r[0] - b[0] * t, r[1] - b[1] * t, r[2] - b[2] * t);
    out[0] = shape_density(distance - a[2][0], a[3][0]);
}

void eval_torus(const field_point *at, const float (*a)[4], float out[4]) {
    float x = at->p.x - a[0][0], y = at->p.y - a[0][1], z = at->p.z - a[0][2];
    float ring = length3(x, y, 0) - a[1][0];
    out[0] = shape_density(length3(ring, z, 0) - a[2][0], a[3][0]);
}

void eval_disc(const field_point *at, const float (*a)[4], float out[4]) {
    out[0] = shape_density(length3(at->p.x - a[0][0], at->p.y - a[1][0], 0) - a[2][0], a[3][0]);
}

static box3 around(const float centre[4], float x, float y, float z) {
    return (box3){{centre[0] - x, centre[1] - y, centre[2] - z},
                  {centre[0] + x, centre[1] + y, centre[2] + z}};
}

// Values of all arguments but the falloff, which is last and lies inside.
static bool uniform_args(const field *node, const field_context *context, float out[3][4]) {
    size_t count = kind_arg_count(node) - 1;
    for (size_t i = 0; i < count; i++)
        if (!kind_uniform_arg(node, i, context, out[i])) return false;
    return true;
}

// The box of a shape, as an expression of the values `a` of its arguments.
#define BOUNDS(shape, value)                                                                       \
    box3 bounds_##shape(const field *node, const field_context *context, const box3 *args) {       \
        (void)args;                                                                                \
        float a[3][4];                                                                             \
        return uniform_args(node, context, a) ? (value) : box3_infinite();                         \
    }
BOUNDS(sphere, around(a[0], a[1][0], a[1][0], a[1][0]))
BOUNDS(box, around(a[0], 0.5f * a[1][0], 0.5f * a[1][1], 0.5f * a[1][2]))
BOUNDS(capsule, ((box3){{fminf(a[0][0], a[1][0]) - a[2][0], fminf(a[0][1], a[1][1]) - a[2][0],
                         fminf(a[0][2], a[1][2]) - a[2][0]},
                        {fmaxf(a[0][0], a[1][0]) + a[2][0], fmaxf(a[0][1], a[1][1]) + a[2][0],
                         fmaxf(a[0][2], a[1][2]) + a[2][0]}}))
BOUNDS(torus, around(a[0], a[1][0] + a[2][0], a[1][0] + a[2][0], a[2][0]))
BOUNDS(disc, ((box3){{a[0][0] - a[2][0], a[1][0] - a[2][0], box3_infinite().min.z},
                     {a[0][0] + a[2][0], a[1][0] + a[2][0], box3_infinite().max.z}}))
