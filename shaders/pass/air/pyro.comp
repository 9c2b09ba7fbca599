// Gas that burns: fuel that is hot and finds oxygen becomes fire, which expands, rises and leaves soot.
// Here the last stage, what a step left as grids: two states of the gas, mixed for the time of the
// frame.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
//@ option fuel = petrol {petrol, kerosene, propane, methane, ethanol, wood, dust, black_powder} : whose heat, oxygen, soot and temperature of ignition it has (effects/README.md has the table)
//@ option combustion = mixing {mixing, premixed} : fuel burns where it is hot and meets air (fires), or where a flame passes that moves into mixture on its own (clouds of dust or gas); premixed, what a source gives above the temperature of ignition lights it
//@ option advection = parabolic {upwind, parabolic, reflection} : what is taken to lie within a cell, of which a part flows into the next one: a parabola keeps detail, upwind is even and takes two thirds of the time; with reflection the velocity goes two halves of a step, and eddies last longer
//@ option density = constant {constant, variable} : what the pressure moves; variable is as gases are: light gas is moved farther than heavy gas, flames rise faster and draw in more air; a step takes longer
//@ option velocity_cells = full {full, half} : as many as the gas, or half as many along each axis: a step takes a third of the time and may be twice as long; eddies are coarser, and what they carry is as fine
//@ option precision = auto {f32, f16, auto} : of what is stored; auto is f16 on graphics cards, which takes half the memory
//@ option boundary_left = open {open, wall, inflow, periodic} : face at -x
//@ option boundary_right = open {open, wall, inflow, periodic} : face at +x
//@ option boundary_front = open {open, wall, inflow, periodic} : face at -y
//@ option boundary_back = open {open, wall, inflow, periodic} : face at +y
//@ option boundary_bottom = wall {open, wall, inflow, periodic} : face at -z
//@ option boundary_top = open {open, wall, inflow, periodic} : face at +z
//@ field vec3 guide = {0, 0, 0} : velocity that large eddies shall have (m/s), as that of a coarser run: fine.guide = coarse.velocity; small eddies stay free
//@ field vec3 force = {0, 0, 0} : acceleration of the gas (m/s^2), sampled at every second cell: a curl that moves makes it restless
uniform float gravity;              //= 9.81 [-1e3, 1e3] m/s^2 : by which light gas rises
uniform float ambient_temperature;  //= 293 [50, 2000] K : of the air around
uniform float ignition_temperature; //= 0 [0, 5000] K : above which fuel burns; 0: that of the fuel
uniform float flame_speed;          //= 3 [0, 1e3] m/s : of a premixed flame into mixture at rest: 0.4 in calm gas, some metres a second in dust or where it is restless
uniform float burn_time;            //= 0.1 [0, 1e3] s : that fuel and air within a cell take to mix: shorter burns fiercer
uniform float heat_of_combustion;   //= 0 [0, 1000] MJ/kg : that 1 kg of fuel gives; 0: that of the fuel, less what its flame radiates
uniform float soot_yield;           //= -1 [-1, 1] kg/kg : of 1 kg of fuel; below 0: that of the fuel
uniform float soot_burn_time;       //= 1 [0, 1e3] s : that soot in hot fresh air takes to burn; 0: it does not
uniform float cooling;              //= 400 [0, 1e6] K/s : by which gas of 1500 K cools at first; by the fourth power of its temperature
uniform float expansion;            //= 1 [0, 10] : how much gas expands where it becomes warmer; 1: as gases do
uniform float vorticity;            //= 0 [0, 1000] 1/s : how much eddies are kept from fading (Fedkiw et al. 2001)
uniform float turbulence;           //= 0 [0, 1] : how much eddies below the cells push those that cells can hold, where gas is sheared: 0.3 is felt, 1 is rough
uniform float dissolve_rate;        //= 0 [0, 100] 1/s : share of the soot that goes
uniform float smoke_yield;          //= 0 [0, 10] kg/kg : of 1 kg of fuel: smoke that does not glow or burn, as of damp wood
uniform float smoke_dissolve_rate;  //= 0 [0, 100] 1/s : share of the smoke that goes
uniform float guide_rate;           //= 20 [0, 1e4] 1/s : at which the guide holds large eddies; 0: it does not
uniform float guide_size;           //= 0 [0, 1e6] m : what is smaller than this is a small eddy; 0: the cells of what the guide reads
uniform vec3 wind;                  //= {0, 0, 0} [-inf, inf] m/s : of the air at first, and of faces that are inflow
uniform sampler3D gas_now, gas_before, flow_now, flow_before;
#if SMOKES
uniform sampler3D smoke_now, smoke_before;
#endif
#if HAS_OUTFLOW
uniform sampler3D outflow; // its fourth: what templates let out (1/s)
#endif
uniform vec3 size;         // cells
uniform float cell_size;   // m
uniform float blend;       // of the two states
uniform float burn_power;  // MW of 1 kg of fuel that can burn
uniform float oxygen_need; // kg of 1 kg of fuel
uniform float burns_above; // K
uniform float flame_power; // MW of 1 kg of fuel by 1 K, and by 1/m of the slope of a premixed flame
writeonly uniform image3D scalars;  //= output rgba16f optional : temperature (K), fuel, soot, fuel that has burnt (kg/m^3)
writeonly uniform image3D velocity; //= output rgba16f optional : m/s; pressure beyond that of the air around (Pa)
writeonly uniform image3D rates;    //= output rgba16f optional : heat of burning (MW/m^3), divergence (1/s), vorticity (1/s), smoke (kg/m^3)

const float AIR = 353.0;            // density of air times its temperature, kg K/m^3
const float AIR_OXYGEN = 0.232;     // by mass
const float AIR_ENERGY = 0.406;     // of the air of 1 m^3 by 1 K and its temperature, MJ/m^3

vec4 mixed(sampler3D before, sampler3D now, ivec3 at) {
    return mix(texelFetch(before, at, 0), texelFetch(now, at, 0), blend);
}

#if COMBUSTION == COMBUSTION_PREMIXED
float progress(ivec3 at) {
    vec4 gas = mixed(gas_before, gas_now, clamp(at, ivec3(0), ivec3(size) - 1));
    return gas.w / max(gas.y + gas.w, 1e-5);
}

float burning(vec4 gas, ivec3 at) {
    vec3 slope = vec3(progress(at + ivec3(1, 0, 0)) - progress(at - ivec3(1, 0, 0)),
                      progress(at + ivec3(0, 1, 0)) - progress(at - ivec3(0, 1, 0)),
                      progress(at + ivec3(0, 0, 1)) - progress(at - ivec3(0, 0, 1)));
    return flame_power * gas.x * (gas.y + gas.w) * length(slope) / (2.0 * cell_size);
}
#else
float burning(vec4 gas, ivec3 at) {
    float oxygen = max(AIR / gas.x * AIR_OXYGEN - oxygen_need * gas.w, 0.0);
    return gas.x > burns_above ? burn_power * min(gas.y, oxygen / oxygen_need) : 0.0;
}
#endif

// It may have larger cells.
vec4 flow_at(ivec3 at) {
    vec3 p = (vec3(at) + 0.5) / size;
    return mix(textureLod(flow_before, p, 0.0), textureLod(flow_now, p, 0.0), blend);
}

vec3 around(ivec3 at, int axis) {
    ivec3 low = at, high = at;
    low[axis] = max(at[axis] - 1, 0);
    high[axis] = min(at[axis] + 1, int(size[axis]) - 1);
    vec3 change = flow_at(high).xyz - flow_at(low).xyz;
    return change / (float(high[axis] - low[axis]) * cell_size);
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, ivec3(size)))) return;
    vec4 gas = mixed(gas_before, gas_now, at);
    if (imageSize(scalars).x > 1) imageStore(scalars, at, gas);
    if (imageSize(velocity).x > 1) imageStore(velocity, at, flow_at(at));
    if (imageSize(rates).x <= 1) return;
    vec3 x = around(at, 0), y = around(at, 1), z = around(at, 2);
    vec3 curl = vec3(y.z - z.y, z.x - x.z, x.y - y.x);
    float ratio = gas.x / 1500.0, around_ = ambient_temperature / gas.x;
    float lost = cooling * ratio * ratio * ratio * ratio * (1.0 - around_ * around_ * around_ * around_) / gas.x;
    float heat = burning(gas, at), smoke = 0.0, grows = expansion * (heat / AIR_ENERGY - lost);
#if SMOKES
    smoke = mixed(smoke_before, smoke_now, at).x;
#endif
#if HAS_OUTFLOW
    grows += textureLod(outflow, (vec3(at) + 0.5) / size, 0.0).w;
#endif
    imageStore(rates, at, vec4(heat, grows, length(curl), smoke));
}
