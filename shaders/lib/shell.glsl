// What fields say of the shell that they are evaluated for, and of the point of it; elsewhere it is
// all zero. A shader that evaluates fields for a shell sets `shell_said` before. Twins in C:
// src/field/kinds_operator.c.
#ifndef LIB_SHELL_GLSL
#define LIB_SHELL_GLSL

struct shell_facts {
    float age;          // part of its life that has passed, 0..1
    float random;       // 0..1, its own
    vec3 shift;         // three more of these
    float depth;        // what the field `shell_depth` gave for it
    float displacement; // of the point
    vec3 normal;        // of the surface there, unit
    vec3 view;          // unit, towards the eye
};
shell_facts shell_said = shell_facts(0.0, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), vec3(0.0));

float shell_said_age(vec3 p) { return shell_said.age; }
float shell_said_random(vec3 p) { return shell_said.random; }
vec3 shell_said_shift(vec3 p) { return shell_said.shift; }
float shell_said_depth(vec3 p) { return shell_said.depth; }
float shell_said_displacement(vec3 p) { return shell_said.displacement; }
vec3 shell_said_normal(vec3 p) { return shell_said.normal; }
vec3 shell_said_view(vec3 p) { return shell_said.view; }

#endif
