// Combustion of one cell in one step, at low Mach number (Rehm and Baum 1978): gas that becomes
// warmer expands at the pressure that it has. Fuel burns as fast as it mixes with oxygen, once it is
// hot enough (the eddy dissipation of Magnussen and Hjertager 1977, as in fire research). With
// PYRO_PREMIXED it burns where a flame passes, which moves into mixture at a speed of its own (Peters 2000,
// section 2.4): what has burnt of a cell's fuel, its progress, is 1 behind it and 0 before it.
#ifndef SIM_PYRO_BURN_GLSL
#define SIM_PYRO_BURN_GLSL

uniform float dt;
uniform float ignition;    // K
uniform float burn_share;  // of what can burn, in this step
uniform float flame_reach; // cells that a premixed flame moves into mixture at rest in this step
uniform float oxygen_need; // kg that 1 kg of fuel takes
uniform float heat;        // K by which air is warmer when as much fuel has burnt in it
uniform float soot_yield;  // kg of 1 kg of burnt fuel
uniform float soot_share;  // of the soot that burns in this step where it is hot and in fresh air
uniform float soot_heat;   // as `heat`
uniform float soot_kept;   // share of the soot that does not dissolve in this step
#if PYRO_SMOKE
uniform float smoke_yield; // kg of 1 kg of burnt fuel
uniform float smoke_kept;  // as `soot_kept`
#endif
uniform float cooling;     // of the third power of the temperature's inverse in this step, 1/K^3
uniform float expansion;   // 1: as gases do

const float PYRO_OXYGEN = 0.232; // of air, by mass

const float PYRO_HEAT_CAPACITY = 1150.0; // of air between its surroundings and a flame, J/(kg K)

// Fuel for which a cell has oxygen, by mass of air.
float pyro_burnable(vec4 gas) {
    float oxygen = max(PYRO_OXYGEN - oxygen_need * gas.PYRO_BURNT, 0.0);
    return min(gas.PYRO_FUEL, oxygen / oxygen_need);
}

// What burns of it in a step in which a flame brings so much more progress.
float pyro_burnt_in_step(vec4 gas, float brought) {
#if PYRO_PREMIXED
    return clamp(brought * (gas.PYRO_FUEL + gas.PYRO_BURNT), 0.0, pyro_burnable(gas));
#else
    return pyro_temperature(gas) > ignition ? burn_share * pyro_burnable(gas) : 0.0;
#endif
}

// Heat that burning gives to 1 kg of air, W.
float pyro_burning(vec4 gas, float brought) {
    return pyro_burnt_in_step(max(gas, vec4(-1e30, 0.0, 0.0, 0.0)), brought) / dt * heat * PYRO_HEAT_CAPACITY;
}

// Of a cell's fuel, packed or not, what has burnt. Air without any has not.
float pyro_progress(vec4 gas) {
    return clamp(gas.PYRO_BURNT / max(gas.PYRO_FUEL + gas.PYRO_BURNT, 1e-5), 0.0, 1.0);
}

// Changes what a cell holds. Returns how much more room its gas takes, as a share of what it took.
float pyro_burn(inout vec4 gas, float brought) {
    gas.yzw = max(gas.yzw, vec3(0.0));
    float before = pyro_temperature(gas), burnt = pyro_burnt_in_step(gas, brought);
    float oxygen = max(PYRO_OXYGEN - oxygen_need * gas.PYRO_BURNT, 0.0);
    gas.PYRO_FUEL -= burnt;
    gas.PYRO_BURNT += burnt;
    float soot = gas.PYRO_SOOT + soot_yield * burnt;
    float oxidized = soot * soot_share * smoothstep(1200.0, 1600.0, before) * oxygen / PYRO_OXYGEN;
    gas.PYRO_SOOT = soot_kept * (soot - oxidized);
    float mass = 1.0 + gas.PYRO_FUEL + gas.PYRO_BURNT; // which is warmed
    float hot = before + (heat * burnt + soot_heat * oxidized) / mass;
    // Radiation to surroundings that radiate back: dT/dt = -k (T^4 - ambient^4).
    float lost = hot - 1.0 / pow(1.0 / (hot * hot * hot) + cooling, 1.0 / 3.0);
    float cold = min(ambient / hot, 1.0);
    float after = hot - lost * (1.0 - cold * cold * cold * cold);
    gas.PYRO_WARMTH += after - before;
    return expansion * ((after - before) / before); // exactly 0 where nothing happens
}
#endif
