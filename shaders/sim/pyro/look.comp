// What a state looks like: images of halves that others sample.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/trace.glsl"

uniform float pressure_unit; // Pa by 1 m/s
layout(std430) readonly buffer PyroGas { PYRO_FOUR gas[]; };
layout(std430) readonly buffer PyroPressure { float pressure[]; };
layout(rgba16f) writeonly uniform image3D scalars; // K, and kg/m^3 of fuel, soot, what has burnt
layout(rgba16f) writeonly uniform image3D flow;    // m/s; Pa

const float MOST = 65000.0;

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int at = pyro_at(c);
    vec4 g = pyro_load(gas[at]);
    float air = PYRO_AIR / pyro_temperature(g); // kg/m^3
    vec4 s = vec4(pyro_temperature(g), air * g.PYRO_FUEL, air * g.PYRO_SOOT, air * g.PYRO_BURNT);
    imageStore(scalars, c, clamp(s, -MOST, MOST));
    imageStore(flow, c, clamp(vec4(pyro_velocity_cell(pyro_near_of(c)), pressure_unit * pressure[at]), -MOST, MOST));
}
