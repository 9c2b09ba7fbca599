// The density of a cell of the velocity, by that of the surroundings.
#ifndef SIM_PYRO_DENSITY_GLSL
#define SIM_PYRO_DENSITY_GLSL
#if PYRO_RATIO == 2
layout(std430) readonly buffer PyroDensity { float densities[]; }; // gas.comp writes it
float pyro_density_of(int at) {
    return densities[at];
}
#else
layout(std430) readonly buffer PyroGasTo { PYRO_FOUR gas_to[]; }; // after the step
float pyro_density_of(int at) {
    return pyro_density(pyro_unpack(pyro_load(gas_to[at])));
}
#endif
float pyro_density_at(ivec3 c) {
    return pyro_density_of(pyro_at(c));
}
#endif
