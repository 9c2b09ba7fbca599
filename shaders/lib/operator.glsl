// Operators of fields that GLSL has not, or leaves undefined for some input: their results are
// finite whatever the arguments. Twins in C: src/field/kinds_operator.c.
#ifndef LIB_OPERATOR_GLSL
#define LIB_OPERATOR_GLSL

float operator_div(float a, float b) {
    return b == 0.0 ? 0.0 : a / b;
}

float operator_pow(float a, float b) {
    return a <= 0.0 ? (b == 0.0 ? 1.0 : 0.0) : pow(a, b);
}

float operator_sqrt(float a) {
    return sqrt(max(a, 0.0));
}

float operator_exp(float a) {
    return exp(min(a, 80.0));
}

float operator_step(float value, float edge) {
    return value >= edge ? 1.0 : 0.0;
}

float operator_smoothstep(float value, float low, float high) {
    if (low == high) return operator_step(value, low);
    float t = clamp((value - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

float operator_remap(float value, float in_min, float in_max, float out_min, float out_max) {
    return out_min + operator_div(value - in_min, in_max - in_min) * (out_max - out_min);
}

float operator_atan(float y, float x) {
    return x == 0.0 && y == 0.0 ? 0.0 : atan(y, x);
}

// The same for vectors, component by component.
#define OPERATOR_1(NAME)                                                                           \
    vec3 NAME(vec3 a) { return vec3(NAME(a.x), NAME(a.y), NAME(a.z)); }                            \
    vec4 NAME(vec4 a) { return vec4(NAME(a.xyz), NAME(a.w)); }
#define OPERATOR_2(NAME)                                                                           \
    vec3 NAME(vec3 a, vec3 b) { return vec3(NAME(a.x, b.x), NAME(a.y, b.y), NAME(a.z, b.z)); }     \
    vec4 NAME(vec4 a, vec4 b) { return vec4(NAME(a.xyz, b.xyz), NAME(a.w, b.w)); }

OPERATOR_1(operator_sqrt)
OPERATOR_1(operator_exp)
OPERATOR_2(operator_div)
OPERATOR_2(operator_pow)
OPERATOR_2(operator_step)

vec3 operator_smoothstep(vec3 v, vec3 a, vec3 b) {
    return vec3(operator_smoothstep(v.x, a.x, b.x), operator_smoothstep(v.y, a.y, b.y),
                operator_smoothstep(v.z, a.z, b.z));
}

vec4 operator_smoothstep(vec4 v, vec4 a, vec4 b) {
    return vec4(operator_smoothstep(v.xyz, a.xyz, b.xyz), operator_smoothstep(v.w, a.w, b.w));
}

vec3 operator_remap(vec3 v, vec3 a, vec3 b, vec3 c, vec3 d) {
    return c + operator_div(v - a, b - a) * (d - c);
}

vec4 operator_remap(vec4 v, vec4 a, vec4 b, vec4 c, vec4 d) {
    return c + operator_div(v - a, b - a) * (d - c);
}

#endif
