// What fields say of the particle that they are evaluated for; elsewhere it is all zero. A shader
// that evaluates fields for a particle sets `particle_said` before. Twins in C:
// src/field/kinds_operator.c.
#ifndef LIB_PARTICLE_GLSL
#define LIB_PARTICLE_GLSL

struct particle_facts {
    float age;      // part of its life that has passed, 0..1
    float quantity; // that it carries
    float random;   // 0..1, its own
    vec3 velocity;  // m/s
};
particle_facts particle_said = particle_facts(0.0, 0.0, 0.0, vec3(0.0));

float particle_said_age(vec3 p) { return particle_said.age; }
float particle_said_quantity(vec3 p) { return particle_said.quantity; }
float particle_said_random(vec3 p) { return particle_said.random; }
vec3 particle_said_velocity(vec3 p) { return particle_said.velocity; }

#endif
