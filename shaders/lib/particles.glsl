// Reads what the pass `particles` keeps, as of the time of the frame. How a pass binds it:
// src/pass/particles/particles.h.
//
//     for each slot below particle_used:
//         particle p;
//         if (particle_read(slot, p)) ... p.position ... p.age / p.lifetime
uniform sampler2D particles; //= input : the particles (of the pass particles)
#include "lib/particles_read.glsl"
