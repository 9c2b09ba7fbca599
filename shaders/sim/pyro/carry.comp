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
#if PYRO_SMOKE
layout(std430) writeonly buffer PyroSmokeInto { float smoke_into[]; };
#endif

#if PYRO_SIDE_BY_SIDE && !defined(CARRY_Y)
#include "sim/pyro/lines.glsl"
shared vec4 crossing[LINE_FACES]; // what crosses them
shared float ways[LINE_FACES];
#if PYRO_SMOKE
shared float smoke_crossing[LINE_FACES];
#endif

void main() {
    ivec3 first = first_of_half_brick();
    bool near = is_near_gas();
    for (int k = int(gl_LocalInvocationIndex); near && k < LINE_FACES; k += int(gl_WorkGroupSize.x)) {
        ivec3 c = first + line_face(k);
        float way = WAY_ALONG(c);
        ways[k] = way;
        float volume = volume_along(c, way > 0.0 ? c.x - 1 : c.x);
        crossing[k] = gas_flux(c, c.x, way, volume);
#if PYRO_SMOKE
        smoke_crossing[k] = smoke_flux(c, c.x, way, volume);
#endif
    }
    barrier();
    for (int k = int(gl_LocalInvocationIndex); k < LINE_CELLS; k += int(gl_WorkGroupSize.x)) {
        ivec3 c = first + line_cell(k);
        int face = line_face_below(k), at = pyro_at(c);
        vec4 held = vec4(0.0);
        if (near) held = after_sweep(pyro_load(gas_from[at]), volume_along(c, c.x), ways[face], crossing[face],
                                     ways[face + 1], crossing[face + 1]);
        gas_into[at] = pyro_store(held);
#if PYRO_SMOKE
        smoke_into[at] = !near ? 0.0 : after_sweep(smoke_from[at], volume_along(c, c.x), ways[face],
                                                   smoke_crossing[face], ways[face + 1], smoke_crossing[face + 1]);
#endif
    }
}
#else
void main() { // a thread does a line of eight cells
    ivec3 c = first_of_half_brick();
    c.ACROSS += int(gl_LocalInvocationIndex & 7u);
    c.z += int(gl_LocalInvocationIndex >> 3);
    bool near = is_near_gas();
    gas_sweep s;
    if (near) s = gas_begin(c);
#if PYRO_SMOKE
    smoke_sweep smoke;
    if (near) smoke = smoke_begin(c);
#endif
    for (int i = 0; i < 8; i++) {
        gas_into[pyro_at(c)] = pyro_store(near ? gas_next(s, c) : vec4(0.0));
#if PYRO_SMOKE
        smoke_into[pyro_at(c)] = near ? smoke_next(smoke, c) : 0.0;
#endif
        c.ALONG++;
    }
}
#endif
