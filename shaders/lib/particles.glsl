// Reads what the pass `particles` keeps, as of the time of the frame. How a pass binds it:
// src/pass/particles.h.
//
//     for each slot below particle_used:
//         particle p;
//         if (particle_read(slot, p)) ... p.position ... p.age / p.lifetime
uniform sampler2D particles; //= input : the particles (of the pass particles)

#ifndef LIB_PARTICLES_GLSL
#define LIB_PARTICLES_GLSL
#include "lib/particles_state.glsl"
#include "lib/random.glsl"
uniform float particle_back; // seconds from the frame to the state, which is up to a step ahead

struct particle {
    vec3 position;  // m
    float age;      // s
    vec3 velocity;  // m/s
    float lifetime; // s, above the age
    float quantity; // that it carries; 0: none
    uint id;        // its own as long as it lives, whatever slot it is in; from 0 on
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

// Evenly spread over [0, 1), the same for a particle all its life. `what` from 64 on is for those
// that draw: lower ones are used up by its birth.
float particle_random(uint id, uint what) {
    return float(random_hash(id + random_hash(what + random_hash(particle_seed))) >> 8) * (1.0 / 16777216.0);
}

#endif
