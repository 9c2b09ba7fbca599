// The gas moves along x, or, with CARRY_Y, along y (flux.glsl). The sweep along z is that of gas.comp.
#define PYRO_ON_GAS
#ifdef CARRY_Y
#define SWEEP SWEEP_Y
#define ACROSS x
#else
#define SWEEP SWEEP_X
#define ACROSS y
#endif
#if PYRO_SIDE_BY_SIDE && !defined(CARRY_Y)
layout(local_size_x = 96) in;
#else
layout(local_size_x = 32) in; // all along x, since software drivers fill their vectors so
#endif
#include "sim/pyro/state.glsl"
#include "sim/pyro/present.glsl"
#include "sim/pyro/flux.glsl"

layout(std430) writeonly buffer PyroGasInto { PYRO_FOUR gas_into[]; }; // after the sweep

#if PYRO_SIDE_BY_SIDE && !defined(CARRY_Y)
#include "sim/pyro/lines.glsl"
shared vec4 crossing[LINE_FACES]; // what crosses them
shared float ways[LINE_FACES];

void main() {
    ivec3 first = first_of_half_brick();
    bool near = is_near_gas();
    for (int k = int(gl_LocalInvocationIndex); near && k < LINE_FACES; k += int(gl_WorkGroupSize.x)) {
        ivec3 c = first + line_face(k);
        float way = WAY_ALONG(c);
        ways[k] = way;
        crossing[k] = flux_along(c, c.x, way, volume_along(c, way > 0.0 ? c.x - 1 : c.x));
    }
    barrier();
    for (int k = int(gl_LocalInvocationIndex); k < LINE_CELLS; k += int(gl_WorkGroupSize.x)) {
        ivec3 c = first + line_cell(k);
        int face = line_face_below(k), at = pyro_at(c);
        vec4 held = vec4(0.0);
        if (near) held = after_sweep(pyro_load(gas_from[at]), volume_along(c, c.x), ways[face], crossing[face],
                                     ways[face + 1], crossing[face + 1]);
        gas_into[at] = pyro_store(held);
    }
}
#else
void main() { // a thread does a line of eight cells
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
#endif
