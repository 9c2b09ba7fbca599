// What fields say of the light of `point_lights` that they are evaluated for; elsewhere it is all
// zero. A shader that evaluates fields for such a light sets `point_light_current` before. Twins in C:
// src/field/kinds_operator.c.
#ifndef LIB_POINT_LIGHT_GLSL
#define LIB_POINT_LIGHT_GLSL

struct point_light_facts {
    float index;  // its number, from 0 on
    float random; // 0..1, its own
};
point_light_facts point_light_current = point_light_facts(0.0, 0.0);

float point_light_current_index(vec3 p) { return point_light_current.index; }
float point_light_current_random(vec3 p) { return point_light_current.random; }

#endif
