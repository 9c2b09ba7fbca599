// The pass type `particles`: points that are born, move and die on the device, in steps that are a
// fixed part of a second whatever is drawn. Its uniforms, options and fields are those of
// shaders/pass/particles/particles.comp; what is kept of each, shaders/lib/particles_state.glsl
// says.
//
// Nothing of it depends on a camera (but collisions with what a picture shows), and no picture
// comes of it. A pass that reads it has `#include "lib/particles.glsl"`, which declares an input
// `particles`: given as `particles = sparks` or by `from = sparks`, it orders the passes and names
// the particles. All else comes by itself, in a user's shader too: defines, numbers and buffers
// (pass_particles_provider).
//
// Numbers and fields are those of the middle of each step; grids that fields sample are those of
// the frame. The state is up to a step ahead of the frame; particle_read() goes back along the
// velocity.
#pragma once
#include "pass/pass.h"

enum { PASS_PARTICLES_MOST = 1 << 24, PASS_PARTICLES_EACH = 1 << 23 }; // in all; of a binding

typedef struct pass_particles_desc {
    uint32_t count;   // at most so many at a time; the oldest make room for new ones
    double time_step; // seconds
    double warm_up;   // seconds that are simulated before time 0
    // They are born in the space of one of these, as often as `share` says of it (NULL: 1), which
    // multiplies 'rate' and 'burst'. NULL: in the world.
    scene_instances *at;
    const field *share;
} pass_particles_desc;

// Before pass_declare. False with a message.
bool pass_particles_open(pass *p, const pass_particles_desc *desc);

// ---- for passes that read them: pass.particles, from pass_declare on --------------------------

uint32_t pass_particles_count(const pass *particles); // slots
uint32_t pass_particles_used(const pass *particles);  // of these, from 0 on, such as may hold one
