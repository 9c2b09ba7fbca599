void particle_put(uint slot, vec4 position, vec4 velocity) {
#if PARTICLE_PARTS > 1
    if (slot >= PARTICLES_EACH) {
        particle_positions_more[slot - PARTICLES_EACH] = position;
        particle_velocities_more[slot - PARTICLES_EACH] = velocity;
        return;
    }
#endif
    particle_positions[slot] = position;
    particle_velocities[slot] = velocity;
}
