// What fields say of the instance that they are evaluated for; elsewhere it is all zero. A shader
// that evaluates fields for an instance sets `instance_said` before. Twins in C:
// src/field/kinds_operator.c.
#ifndef LIB_INSTANCE_GLSL
#define LIB_INSTANCE_GLSL
#include "shared.h"
#include "lib/turn.glsl"

struct instance_facts {
    vec4 state;   // numbers of the effect's own
    float random; // 0..1, its own
    float index;  // its number, from 0 on
    float glow;   // factor of what it emits
};
instance_facts instance_said = instance_facts(vec4(0.0), 0.0, 0.0, 0.0);

vec4 instance_said_state(vec3 p) { return instance_said.state; }
float instance_said_random(vec3 p) { return instance_said.random; }
float instance_said_index(vec3 p) { return instance_said.index; }
float instance_said_glow(vec3 p) { return instance_said.glow; }

// Before fields are evaluated for it.
void instance_say(instance_entry e) {
    instance_said = instance_facts(e.state, uintBitsToFloat(e.kind.z), float(e.kind.y), e.color.w);
}

// From its own space to that of all.
vec3 instance_vector(instance_entry e, vec3 v) { return turn_vector(e.turn, v * e.place.w); }
vec3 instance_point(instance_entry e, vec3 p) { return e.place.xyz + instance_vector(e, p); }

#endif
