// Air that is simulated: it flows, and carries smoke, heat and a dye (lattice Boltzmann). Here the
// last stage, what a step left as grids: two states of the air, mixed for the time of the frame.
layout(local_size_x = 32, local_size_y = 4, local_size_z = 1) in;
//@ option velocity_set = d3q19 {d3q19, d3q27} : directions that air moves in; d3q27 is rounder and takes 4/3 of the time
//@ option scalar_set = d3q7 {d3q7, d3q27} : directions that smoke, heat and dye move in; d3q27 is as published
//@ option collision = central_moments {bgk, trt, central_moments} : how air settles; bgk is as published, central_moments stays stable without viscosity
//@ option forcing = guo {guo, weights_only} : how buoyancy and force push; weights_only is as published, and wants bgk
//@ option precision = f16 {f32, f16} : of what is stored; f16 takes half the memory and time, but smoke, heat or dye that changes by less than 1/4096 of itself in a step, as by a slow decay, stands still: then take f32, or a longer time_step
//@ option beside_bodies = links {links, velocity} : what carries smoke on d3q7 there: links leaves even smoke even, velocity keeps what passes a narrow throat sharper, and is up to 10 % off
//@ option boundary_left = open {periodic, wall, slip, open, inflow} : face at -x
//@ option boundary_right = open {periodic, wall, slip, open, inflow} : face at +x
//@ option boundary_front = open {periodic, wall, slip, open, inflow} : face at -y
//@ option boundary_back = open {periodic, wall, slip, open, inflow} : face at +y
//@ option boundary_bottom = wall {periodic, wall, slip, open, inflow} : face at -z
//@ option boundary_top = open {periodic, wall, slip, open, inflow} : face at +z
//@ option guard = clamp {clamp, stop} : air that becomes too fast for the lattice is slowed down, or the simulation stops there
//@ field vec3 force = {0, 0, 0} : acceleration of the air (m/s^2), sampled at every second cell
uniform float viscosity;             //= 2e-5 [0, inf] m^2/s : of the air
uniform float diffusion;             //= 0 [0, inf] m^2/s : of smoke and dye
uniform float temperature_diffusion; //= 0 [0, inf] m^2/s : of heat
uniform float buoyancy_density;      //= 0 [-inf, inf] m/s^2 : acceleration upwards by a density of 1, in proportion to it
uniform float buoyancy_heat;         //= 1.2 [-inf, inf] m/s^2 : acceleration upwards by a temperature of 1, in proportion to it
uniform float dissolve_rate;         //= 0 [0, 10] 1/s : share of the smoke and the dye that goes
uniform float cooling_rate;          //= 0 [0, 10] 1/s : share of the temperature that goes
uniform vec3 wind;                   //= {0, 0, 0} [-inf, inf] m/s : of faces that are inflow or open
uniform float smagorinsky;           //= 0.1 [0, 1] : of the eddies finer than a cell, which take motion away
layout(std430) readonly buffer Moments { uvec4 moments[]; };
layout(std430) readonly buffer MomentsBefore { uvec4 before[]; };
layout(std430) readonly buffer Guard { uint spoilt; }; // what the guard found (src/sim/lbm_guard.h)
uniform vec3 size;      // cells
uniform float blend;    // of the two states
uniform float speed;    // metres a second of a cell a step
uniform float pressure; // pascals of an excess of density of 1
writeonly uniform image3D scalars;  //= output rgba16f optional : density, temperature, dye, pressure
writeonly uniform image3D velocity; //= output rgba16f optional : m/s

// Halves that are no numbers become 0: what goes wrong is told, and not shown.
uvec4 numbers_of(uvec4 m) {
    m = mix(m, m & 0xffff0000u, equal(m & 0x7c00u, uvec4(0x7c00u)));
    return mix(m, m & 0xffffu, equal(m & 0x7c000000u, uvec4(0x7c000000u)));
}

vec4 flow_of(uvec4 m) {
    return vec4(unpackHalf2x16(m.x), unpackHalf2x16(m.y));
}

vec3 scalars_of(uvec4 m) {
    return vec3(unpackHalf2x16(m.z), unpackHalf2x16(m.w).x);
}

void main() {
    if (spoilt != 0u) return; // it is no air any more: what was shown before stays
    uvec3 cell = gl_GlobalInvocationID, cells = uvec3(size);
    if (any(greaterThanEqual(cell, cells))) return;
    uint at = cell.x + cells.x * (cell.y + cells.y * cell.z);
    uvec4 now = numbers_of(moments[at]), last = numbers_of(before[at]);
    vec4 flow = mix(flow_of(last), flow_of(now), blend);
    vec3 carried = mix(scalars_of(last), scalars_of(now), blend);
    if (imageSize(scalars).x > 1) imageStore(scalars, ivec3(cell), vec4(carried, flow.w * pressure));
    if (imageSize(velocity).x > 1) imageStore(velocity, ivec3(cell), vec4(flow.xyz * speed, 0.0));
}
