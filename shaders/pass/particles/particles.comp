// Points that are born, are carried or thrown, meet what is solid and die: sparks, embers, dust. No
// picture comes of it: `splats` draws them. Here a step of a fixed part of a second, whatever is
// drawn; every particle is its own thread. Who is born in it comes from particles/birth.comp. Fields
// may use particle_age (0..1 over its life), particle_random, particle_velocity and particle_quantity,
// which is what it carried until now.
layout(local_size_x = 256, local_size_y = 1, local_size_z = 1) in;
//@ option motion = auto {auto, carried, forces} : carried: they go as `velocity` says; forces: they go on as they are, pushed by gravity and force, slowed by drag; auto: forces where one of these or a speed is given
//@ option integrator = rk2 {euler, rk2} : of the motion: by the velocity where they are (as published), or half a step ahead (midpoint)
//@ option contact = bounce {bounce, die} : what they do where they meet something
//@ option quantity_from = step {step, birth} : whether what they carry is that of the place they are at, or stays that of their birth
//@ field float shape = 0 : they are born where this is above the threshold; of a mesh, on that part of it
//@ field vec3 velocity = {0, 0, 0} : of the air that carries them, or that drag makes them follow (m/s)
//@ field vec3 force = {0, 0, 0} : acceleration (m/s^2)
//@ field vec3 speed = {0, 0, 0} : that they are born with (m/s)
//@ field float collide = 0 : distance to what they meet (m), below 0 within, as of `voxels`
//@ field vec3 collide_velocity = {0, 0, 0} : how that moves (m/s)
//@ field float alive = 1 : they die where this is 0 or less: where the air that carries them ends, as by 4 - position.z, or where it is cold
//@ field float quantity = 0 : a number that they carry, for those that draw them: a temperature, a density
uniform float rate;         //= 0 [0, 1e9] 1/s : how many are born
uniform float burst;        //= 0 [0, 16777216] : how many are born at once,
uniform float burst_time;   //= 0 [-inf, inf] s : when,
uniform float burst_period; //= 0 [0, inf] s : and how long until it happens again; 0: it does not
uniform float lifetime_min; //= 2 [0, inf] s : shortest life
uniform float lifetime_max; //= 2 [0, inf] s : longest life; `lifetime` sets both
uniform float threshold;    //= 0.5 [-inf, inf] : of the shape
uniform vec3 position;      //= {0, 0, 0} [-inf, inf] m : where they are born without a shape and a mesh,
uniform float radius;       //= 0 [0, inf] m : and how far from there at most
uniform float outward;      //= 0 [-inf, inf] m/s : speed away from the position, or along the normal of a mesh
uniform float spread;       //= 0 [0, 180] degrees : by which the speed is turned at most
uniform float variation;    //= 0 [0, 1] : share by which the speed is less at most
uniform float inherit;      //= 0 [-10, 10] : share of `velocity` that is added to the speed at birth
uniform float mesh_factor;  //= 0 [-10, 10] : share of the mesh's own motion that is added to it
uniform float gravity;      //= 0 [-inf, inf] m/s^2 : acceleration downwards
uniform float drag;         //= 0 [0, inf] 1/s : share of the difference to `velocity` that goes
uniform float drag_square;  //= 0 [0, inf] 1/m : the same for each m/s of the difference, as of what is fast or large
uniform float bounce;       //= 0.5 [0, 1] : share of the speed towards what they meet that is left, turned round
uniform float friction;     //= 0.2 [0, inf] : of Coulomb: speed along the surface lost for that across it
uniform float clearance;    //= 0 [0, inf] m : that they keep from what they meet: their own radius
uniform float contact_step; //= 0.005 [1e-6, 1e6] m : over twice which the direction of a surface is found: a part of the cells, where the distance has any
uniform float thickness;    //= 0.5 [0, inf] m : of what the picture shows: who is farther behind it is hidden, not inside
uniform uint seed;          //= 0 [0, 16777215] : of all that is random
uniform sampler2D depth;    //= input optional : what they bounce off as far as the picture shows it (of the pass geometry)
uniform sampler2D normal;   //= input optional : and how that is turned
uniform float time_step;    // s
#define PARTICLES_ACCESS
#include "lib/particles_state.glsl"
writeonly uniform image2D particles; //= output r32f : stands for the particles: `from` and the input `particles` name them by it
#include "lib/frame.glsl"
#include "fields.glsl"
#include "put.glsl"
#include "contact.glsl"
#include "move.glsl"

void main() {
    uint slot = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (slot >= particle_used) return;
    vec4 at = particle_position_at(slot), moves = particle_velocity_at(slot);
    if (at.w >= moves.w) { // it has died, in the step before or long ago
        if (moves.w > 0.0) particle_put(slot, vec4(0.0), vec4(0.0));
        return;
    }
    float passes = time_step + min(at.w, 0.0); // born within the step: the rest of it
    particle_say(slot, at.w + time_step - 0.5 * passes, moves.w, moves.xyz);
    move(at.xyz, moves.xyz, passes, moves.w);
#if HAS_ALIVE
    if (!(field_alive(at.xyz) > 0.0)) moves.w = 0.0;
#endif
    at.w += time_step;
    particle_put(slot, at, moves);
#if PARTICLE_QUANTITY
    if (QUANTITY_FROM == QUANTITY_FROM_STEP) particle_quantities[slot] = field_quantity(at.xyz);
#endif
}
