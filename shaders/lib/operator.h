// Operators of fields that GLSL has not, or leaves undefined for some input, of single numbers: their
// results are finite whatever the arguments. C compiles this text too (src/field/glsl.h).
#ifndef LIB_OPERATOR_H
#define LIB_OPERATOR_H
#ifndef SHARED
#define SHARED
#endif

SHARED float operator_div(float a, float b) {
    return b == 0.0f ? 0.0f : a / b;
}

SHARED float operator_pow(float a, float b) {
    return a <= 0.0f ? (b == 0.0f ? 1.0f : 0.0f) : pow(a, b);
}

SHARED float operator_sqrt(float a) {
    return sqrt(max(a, 0.0f));
}

SHARED float operator_exp(float a) {
    return exp(min(a, 80.0f));
}

SHARED float operator_step(float value, float edge) {
    return value >= edge ? 1.0f : 0.0f;
}

SHARED float operator_smoothstep(float value, float low, float high) {
    if (low == high) return operator_step(value, low);
    float t = clamp((value - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

SHARED float operator_remap(float value, float in_min, float in_max, float out_min, float out_max) {
    return out_min + operator_div(value - in_min, in_max - in_min) * (out_max - out_min);
}

SHARED float operator_atan(float y, float x) {
    return x == 0.0f && y == 0.0f ? 0.0f : atan(y, x);
}

#endif
