// How a particle is read (lib/particles.glsl), for shaders that say themselves whether they have some.
#ifndef LIB_PARTICLES_READ_GLSL
#define LIB_PARTICLES_READ_GLSL
#include "lib/particles_state.glsl"
uniform float particle_back; // seconds from the frame to the state, which is up to a step ahead

struct particle {
    vec3 position;  // m
    float age;      // s
    vec3 velocity;  // m/s
    float lifetime; // s, above the age
    float quantity; // that it carries; 0: none
    uint id;        // its own, from 0 on: particle_random(id, 64) and those up to 127 are, too
};

// False: nothing is alive in the slot.
bool particle_read(uint slot, out particle p) {
    vec4 at = particle_position_at(slot), moves = particle_velocity_at(slot);
    p.age = at.w - particle_back;
    p.lifetime = moves.w;
    p.velocity = moves.xyz;
    p.position = at.xyz - particle_back * moves.xyz;
    p.quantity = 0.0;
    p.id = particle_number(slot);
    if (!(p.age >= 0.0 && p.age < p.lifetime)) return false;
#if PARTICLE_QUANTITY
    p.quantity = particle_quantities[slot];
#endif
    return true;
}

// Before fields are evaluated for it.
void particle_say(particle p) {
    particle_said = particle_facts(p.age / p.lifetime, p.quantity, particle_random(p.id, 64u), p.velocity);
}

#endif
