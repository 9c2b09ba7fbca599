// How particles lie on the device: two vectors each, in arrays of their own, so that threads side by
// side read 16 bytes side by side. A binding holds PARTICLES_EACH at most: it is 128 MiB then, all
// that software devices bind; more particles lie in a second pair of arrays.
//
// Slots are a ring: the particle that is born as number n takes slot n modulo the count, whoever was
// there. So a slot's particle, and all that is random about it, follows from numbers that the host
// knows, and birth needs neither a list nor an atomic.
#ifndef LIB_PARTICLES_STATE_GLSL
#define LIB_PARTICLES_STATE_GLSL
#include "lib/particle.glsl"
#include "lib/random.glsl"
#ifndef PARTICLES_ACCESS // of the arrays
#define PARTICLES_ACCESS readonly
#endif
#ifndef PARTICLE_PARTS // pairs of arrays: 1 or 2
#define PARTICLE_PARTS 1
#endif
#ifndef PARTICLE_QUANTITY // 1: a number is carried, too
#define PARTICLE_QUANTITY 0
#endif
#define PARTICLES_EACH 8388608u

// xyz: metres; w: age (s), below 0 where it is not born yet.
layout(std430) PARTICLES_ACCESS buffer ParticlePositions { vec4 particle_positions[]; };
// xyz: m/s; w: lifetime (s), 0 where there is none.
layout(std430) PARTICLES_ACCESS buffer ParticleVelocities { vec4 particle_velocities[]; };
#if PARTICLE_PARTS > 1
layout(std430) PARTICLES_ACCESS buffer ParticlePositionsMore { vec4 particle_positions_more[]; };
layout(std430) PARTICLES_ACCESS buffer ParticleVelocitiesMore { vec4 particle_velocities_more[]; };
#endif
#if PARTICLE_QUANTITY
layout(std430) PARTICLES_ACCESS buffer ParticleQuantities { float particle_quantities[]; };
#endif

uniform uint particle_count; // slots
uniform uint particle_used;  // of these, from 0 on, such as may hold one
uniform uint particle_next;  // slot of the particle to be born next,
uniform uint particle_round; // and the number of the one that slot 0 then holds or would hold
uniform uint particle_seed;

vec4 particle_position_at(uint slot) {
#if PARTICLE_PARTS > 1
    if (slot >= PARTICLES_EACH) return particle_positions_more[slot - PARTICLES_EACH];
#endif
    return particle_positions[slot];
}

vec4 particle_velocity_at(uint slot) {
#if PARTICLE_PARTS > 1
    if (slot >= PARTICLES_EACH) return particle_velocities_more[slot - PARTICLES_EACH];
#endif
    return particle_velocities[slot];
}

// The number of the slot's particle: of all that were ever born, modulo 2^32.
uint particle_number(uint slot) {
    return particle_round + slot - (slot < particle_next ? 0u : particle_count);
}

// Evenly spread over [0, 1), the same for a particle all its life. `what` from 64 to 127 is for those who
// draw; the others are used up by its birth.
float particle_random(uint id, uint what) {
    return float(random_hash(id + random_hash(what + random_hash(particle_seed))) >> 8) * (1.0 / 16777216.0);
}

// Before fields are evaluated for the slot's particle.
void particle_say(uint slot, float age, float lifetime, vec3 velocity) {
    particle_said.age = clamp(age / max(lifetime, 1e-20), 0.0, 1.0);
    particle_said.random = particle_random(particle_number(slot), 64u);
    particle_said.velocity = velocity;
#if PARTICLE_QUANTITY
    particle_said.quantity = particle_quantities[slot];
#endif
}

#endif
