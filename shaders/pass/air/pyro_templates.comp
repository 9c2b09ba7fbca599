// A group of templates: pictures of pressure or velocity that are put into burning gas for a while, again and
// again, and leave puffs and eddies of their size there (after Krueger and Westermann 2005, 3, in planes).
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;
//@ option scale_by = nothing {nothing, temperature, fuel, soot} : `strength` is times what the gas has of that around the template, as it is in each step: thousands of kelvin above the air around; kg/m^3
//@ option within = nothing {nothing, temperature, fuel, soot} : templates are put only where the gas has from `above` to `below` of that: K; kg/m^3
#define PYRO_ON_GAS
#include "sim/pyro/state.glsl"
#include "pass/air/templates.glsl"
layout(std430) readonly buffer PyroGas { PYRO_FOUR gas[]; };
layout(std430) readonly buffer PyroVelocity { PYRO_FOUR velocity[]; };

const int TEMPERATURE = 0, FUEL = 1, SOOT = 2;

float quantity_at(int which, vec3 at) {
    vec4 g = pyro_unpack(pyro_load(gas[pyro_at(clamp(ivec3(floor(at)), ivec3(0), PYRO_SIZE - 1))]));
    float warm = pyro_temperature(g);
    return which == TEMPERATURE ? warm : PYRO_AIR / warm * (which == FUEL ? g.PYRO_FUEL : g.PYRO_SOOT);
}

// The mean of both faces of a cell.
vec3 way_at(vec3 at) {
    const ivec3 last = PYRO_SIZE / PYRO_RATIO - 1;
    ivec3 c = clamp(ivec3(floor(at)) / PYRO_RATIO, ivec3(0), last), above = min(c + 1, last);
    return vec3(PYRO_X(velocity[pyro_flow_at(c)]) + PYRO_X(velocity[pyro_flow_at(ivec3(above.x, c.yz))]),
                PYRO_Y(velocity[pyro_flow_at(c)]) + PYRO_Y(velocity[pyro_flow_at(ivec3(c.x, above.y, c.z))]),
                PYRO_Z(velocity[pyro_flow_at(c)]) + PYRO_Z(velocity[pyro_flow_at(ivec3(c.xy, above.z))]));
}

float scale_of(int which, float value) {
    return which == TEMPERATURE ? 1e-3 * (value - ambient) : value;
}
