// Operators, as shaders/lib/operator.h and GLSL's own functions have them. Arguments come widened
// to four components, so that those of the result can be computed alike.
#include "field/kinds.h"
#include "shared.h"
#include <math.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

#define EACH(NAME, EXPRESSION)                                                                     \
    void eval_##NAME(const field_point *at, const float(*args)[4], float out[4]) {                 \
        for (int i = 0; i < at->node->components; i++) out[i] = EXPRESSION;                        \
    }
#define A args[0][i]
#define B args[1][i]
#define C args[2][i]

EACH(add, A + B)
EACH(sub, A - B)
EACH(mul, A *B)
EACH(negate, -A)
EACH(div, operator_div(A, B))
EACH(min, fminf(A, B))
EACH(max, fmaxf(A, B))
EACH(mix, mixf(A, B, C))
EACH(clamp, fminf(fmaxf(A, B), C))
EACH(smoothstep, operator_smoothstep(A, B, C))
EACH(step, operator_step(A, B))
EACH(pow, operator_pow(A, B))
EACH(abs, fabsf(A))
EACH(sqrt, operator_sqrt(A))
EACH(exp, operator_exp(A))
EACH(sin, sinf(A))
EACH(floor, floorf(A))
EACH(fract, A - floorf(A))
EACH(remap, operator_remap(A, B, C, args[3][i], args[4][i]))

void eval_constant(const field_point *at, const float (*args)[4], float out[4]) {
    (void)args;
    memcpy(out, at->node->value, sizeof at->node->value);
}

void eval_palette(const field_point *at, const float (*args)[4], float out[4]) {
    palette_eval(at->node->object, at->context->time, args[0][0], out);
}

void eval_swizzle(const field_point *at, const float (*args)[4], float out[4]) {
    for (int i = 0; i < at->node->components; i++) out[i] = args[0][at->node->index >> 2 * i & 3];
}

void eval_position(const field_point *at, const float (*args)[4], float out[4]) {
    (void)args;
    out[0] = at->p.x;
    out[1] = at->p.y;
    out[2] = at->p.z;
}

void eval_zero(const field_point *at, const float (*args)[4], float out[4]) {
    (void)at, (void)args;
    memset(out, 0, 4 * sizeof *out);
}

// ---- of an instance: zero where there is none ---------------------------------------------------

void eval_instance_state(const field_point *at, const float (*args)[4], float out[4]) {
    eval_zero(at, args, out);
    if (at->context->instance) memcpy(out, at->context->instance->state.v, 4 * sizeof *out);
}

void eval_instance_random(const field_point *at, const float (*args)[4], float out[4]) {
    eval_zero(at, args, out);
    if (at->context->instance) memcpy(out, &at->context->instance->kind.v[2], sizeof *out);
}

void eval_instance_index(const field_point *at, const float (*args)[4], float out[4]) {
    eval_zero(at, args, out);
    if (at->context->instance) out[0] = (float)at->context->instance->kind.v[1];
}

void eval_instance_glow(const field_point *at, const float (*args)[4], float out[4]) {
    eval_zero(at, args, out);
    if (at->context->instance) out[0] = at->context->instance->color.v[3];
}

void eval_length(const field_point *at, const float (*args)[4], float out[4]) {
    float square = 0;
    for (int i = 0; i < kind_arg_width(at->node, 0); i++) square += A * A;
    out[0] = sqrtf(square);
}

void eval_dot(const field_point *at, const float (*args)[4], float out[4]) {
    out[0] = 0;
    for (int i = 0; i < kind_arg_width(at->node, 0); i++) out[0] += A * B;
}

void eval_atan(const field_point *at, const float (*args)[4], float out[4]) {
    (void)at;
    out[0] = operator_atan(args[0][0], args[1][0]);
}

void eval_vec(const field_point *at, const float (*args)[4], float out[4]) {
    (void)at;
    for (int i = 0; i < 3; i++) out[i] = args[i][0];
}

// Rotation Z * Y * X times the scale, and its inverse, around the translation.
void kind_transform_matrix(const float translate[4], const float rotate[4], const float scale[4],
                           float rows[3][4], float back[3][4]) {
    double c[3], s[3];
    for (int i = 0; i < 3; i++) {
        c[i] = cos((double)rotate[i] * degree);
        s[i] = sin((double)rotate[i] * degree);
    }
    double r[3][3] = {
        {c[2] * c[1], c[2] * s[1] * s[0] - s[2] * c[0], c[2] * s[1] * c[0] + s[2] * s[0]},
        {s[2] * c[1], s[2] * s[1] * s[0] + c[2] * c[0], s[2] * s[1] * c[0] - c[2] * s[0]},
        {-s[1], c[1] * s[0], c[1] * c[0]},
    };
    for (int i = 0; i < 3; i++) {
        double size = fabs((double)scale[i]) < 1e-6 ? 1e-6 : (double)scale[i], offset = 0;
        for (int k = 0; k < 3; k++) {
            rows[i][k] = (float)(r[k][i] / size);
            offset += r[k][i] / size * (double)translate[k];
            double other = fabs((double)scale[k]) < 1e-6 ? 1e-6 : (double)scale[k];
            back[i][k] = (float)(r[i][k] * other);
        }
        rows[i][3] = (float)-offset;
        back[i][3] = translate[i];
    }
}
