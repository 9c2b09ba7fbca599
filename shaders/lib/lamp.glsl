// What fields say of the light of `point_lights` that they are evaluated for; elsewhere it is all
// zero. A shader that evaluates fields for such a light sets `lamp_said` before. Twins in C:
// src/field/kinds_operator.c.
#ifndef LIB_LAMP_GLSL
#define LIB_LAMP_GLSL

struct lamp_facts {
    float index;  // its number, from 0 on
    float random; // 0..1, its own
};
lamp_facts lamp_said = lamp_facts(0.0, 0.0);

float lamp_said_index(vec3 p) { return lamp_said.index; }
float lamp_said_random(vec3 p) { return lamp_said.random; }

#endif
