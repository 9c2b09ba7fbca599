// A few planes of simulated flow round an axis: 2D Navier-Stokes in each, turned into space by
// sampling (Krueger and Westermann 2005, "GPU simulation and rendering of volumetric effects for
// computer games and virtual environments"). Here the last stage, what the last two steps left as
// images, mixed for the time of the frame.
layout(local_size_x = 16, local_size_y = 8, local_size_z = 1) in;
//@ option top = open {closed, open, periodic} : upper edge of the slices
//@ option bottom = closed {closed, open, periodic} : lower edge; periodic only with the upper one
//@ option sides = closed {closed, open, periodic} : left and right edge
//@ option advection = maccormack {semi_lagrangian, maccormack} : how the flow carries; semi_lagrangian is as published and blurs more
//@ option solver = auto {cg, multigrid, transform, auto} : of the pressure; cg, conjugate gradients, is as published, multigrid is faster; transform needs no iterations where there are neither obstacles nor templates, and is what auto takes there
uniform float viscosity;        //= 1e-4 [0, inf] m^2/s : of the fluid; not used where a Reynolds number is given
uniform float reynolds;         //= 0 [0, inf] : speed * height / viscosity: the lower, the tougher the fluid; 0: by viscosity
uniform float speed;            //= 1 [0, inf] m/s : that reynolds refers to
uniform float vorticity;        //= 0 [0, 1000] 1/s : how much eddies are kept from fading (Fedkiw et al. 2001)
uniform float buoyancy_heat;    //= 1 [-inf, inf] m/s^2 : acceleration upwards by a temperature of 1, in proportion to it
uniform float buoyancy_density; //= 0 [-inf, inf] m/s^2 : acceleration upwards by a density of 1, in proportion to it
uniform float cooling_rate;     //= 0 [0, 100] 1/s : share of the temperature that goes
uniform float dissolve_rate;    //= 0 [0, 100] 1/s : share of the density and the dye that goes
uniform vec3 force;             //= {0, 0, 0} [-inf, inf] m/s^2 : acceleration everywhere, in a slice: to the right, upwards
uniform vec3 left_velocity;     //= {0, 0, 0} [-inf, inf] m/s : of the left edge where it is closed: it slides, or blows through
uniform vec3 right_velocity;    //= {0, 0, 0} [-inf, inf] m/s : of the right edge
uniform vec3 bottom_velocity;   //= {0, 0, 0} [-inf, inf] m/s : of the lower edge
uniform vec3 top_velocity;      //= {0, 0, 0} [-inf, inf] m/s : of the upper edge
uniform float friction;         //= 0 [0, 1] : of closed edges and obstacles: 0 the fluid slips along them, 1 it sticks
uniform float tolerance;        //= 1e-3 [1e-7, 1] : of the pressure: what is left of the divergence
uniform float max_speed;        //= 0 [0, inf] m/s : the flow is kept below; 0: 32 cells a step
uniform float variation;        //= 0.05 [0, 1] : how much slices differ: what inflow gives is more or less by that share
uniform int seed;               //= 0 [0, 16777215] : of what is random: of the variation, of templates
uniform sampler3D scalars_now;
uniform sampler3D scalars_before;
uniform sampler3D velocity_now;
uniform sampler3D velocity_before;
uniform vec3 size;   // cells, slices
uniform float blend; // of the two states
writeonly uniform image3D scalars;  //= output rgba16f optional : density, temperature, dye, pressure; the last layer is the first one mirrored
writeonly uniform image3D velocity; //= output rgba16f optional : m/s in the slice

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID), cells = ivec3(size), from = at;
    if (any(greaterThanEqual(at, cells + ivec3(0, 0, 1)))) return;
    bool mirrored = at.z == cells.z;
    if (mirrored) from = ivec3(cells.x - 1 - at.x, at.y, 0);
    if (imageSize(scalars).x > 1)
        imageStore(scalars, at, mix(texelFetch(scalars_before, from, 0), texelFetch(scalars_now, from, 0), blend));
    if (imageSize(velocity).x > 1) {
        vec2 v = mix(texelFetch(velocity_before, from, 0).xy, texelFetch(velocity_now, from, 0).xy, blend);
        imageStore(velocity, at, vec4(mirrored ? -v.x : v.x, v.y, 0.0, 0.0));
    }
}
