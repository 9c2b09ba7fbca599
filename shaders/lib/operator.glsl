// lib/operator.h for vectors, component by component.
#ifndef LIB_OPERATOR_GLSL
#define LIB_OPERATOR_GLSL
#include "lib/operator.h"

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
