// The gas moves along x, or, with CARRY_Y, along y (flux.glsl). A thread does a line of eight cells. The
// sweep along z is that of gas.comp.
#define PYRO_ON_GAS
#ifdef CARRY_Y
#define SWEEP SWEEP_Y
#define ACROSS x
#else
#define SWEEP SWEEP_X
#define ACROSS y
#endif
layout(local_size_x = 32) in; // all along x, since software drivers fill their vectors so
#include "sim/pyro/state.glsl"
#include "sim/pyro/present.glsl"
#include "sim/pyro/flux.glsl"

layout(std430) writeonly buffer PyroGasInto { PYRO_FOUR gas_into[]; }; // after the sweep

void main() {
    ivec3 c = first_of_half_brick();
    c.ACROSS += int(gl_LocalInvocationIndex & 7u);
    c.z += int(gl_LocalInvocationIndex >> 3);
    bool near = is_near_gas();
    sweep_state s;
    if (near) s = sweep_begin(c);
    for (int i = 0; i < 8; i++) {
        gas_into[pyro_at(c)] = pyro_store(near ? sweep_next(s, c) : vec4(0.0));
        c.ALONG++;
    }
}
