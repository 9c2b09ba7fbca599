// What a state looks like: an image of halves that others sample, of the gas, or, with FLOW, of its
// velocity and pressure.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#ifndef FLOW
#define PYRO_ON_GAS
#endif
#include "sim/pyro/state.glsl"

const float MOST = 65000.0;

#ifndef FLOW
layout(std430) readonly buffer PyroGas { PYRO_FOUR gas[]; };
layout(rgba16f) writeonly uniform image3D scalars; // K, and kg/m^3 of fuel, soot, what has burnt
#if PYRO_SMOKE
layout(std430) readonly buffer PyroSmoke { float smoke[]; };
layout(r16f) writeonly uniform image3D smokes; // kg/m^3
#endif

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    vec4 g = pyro_unpack(pyro_load(gas[pyro_at(c)]));
    float air = PYRO_AIR / pyro_temperature(g); // kg/m^3
    vec4 s = vec4(pyro_temperature(g), air * g.PYRO_FUEL, air * g.PYRO_SOOT, air * g.PYRO_BURNT);
    imageStore(scalars, c, clamp(s, -MOST, MOST));
#if PYRO_SMOKE
    imageStore(smokes, c, vec4(PYRO_AIR / ambient * smoke[pyro_at(c)]));
#endif
}
#else
#include "sim/pyro/velocity.glsl"
uniform float pressure_unit; // Pa by 1 m/s
layout(std430) readonly buffer PyroPressure { float pressure[]; };
layout(rgba16f) writeonly uniform image3D flow; // m/s; Pa

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    vec4 v = vec4(pyro_velocity_cell(pyro_near_of(c)), pressure_unit * pressure[pyro_at(c)]);
    imageStore(flow, c, clamp(v, -MOST, MOST));
}
#endif
