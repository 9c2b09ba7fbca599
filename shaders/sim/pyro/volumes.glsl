// Volumes that move along one axis in a sweep, along x, y and z in turn. A sweep alone is not what the gas
// does as a whole: a cell whose gas flows in along x and out along y holds more of it between the two. So
// cells have volumes (Easter 1993), which begin with 1, and as much more as the gas expands, and end with 1.
//
// Define SWEEP as SWEEP_X, SWEEP_Y or SWEEP_Z before this is included.
#ifndef SIM_PYRO_VOLUMES_GLSL
#define SIM_PYRO_VOLUMES_GLSL
#include "sim/pyro/faces.glsl"

#if defined(PYRO_ON_GAS) && PYRO_RATIO == 2 // carrier.comp writes it
#define PYRO_SPREAD_IN_CARRIER
const ivec3 WAY_FIRST = ivec3(0);
#else
const ivec3 WAY_FIRST = PYRO_FIRST;
#endif
uniform float reach; // cells in a step, by 1 m/s
layout(std430) readonly buffer PyroCarrier { PYRO_FOUR carrier[]; }; // m/s across the faces of cells

const float FARTHEST = 7.0;     // cells in a step: is_near_gas looks so far
const float LEAST_VOLUME = 0.1; // between sweeps
const int MOST_CELLS = 16;      // from which gas crosses a face

// The way of the gas across the lower face of a cell along an axis, in cells. `c` may be beyond the
// first or the last one by 1 along it.
#define WAY(name, axis, component)                                                                 \
    float name(ivec3 c) {                                                                          \
        bool known = c.axis == PYRO_SIZE.axis && PYRO_ENDS.axis;                                   \
        if (PYRO_AROUND.axis) c.axis = (c.axis + PYRO_SIZE.axis) % PYRO_SIZE.axis;                 \
        else c.axis = clamp(c.axis, WAY_FIRST.axis, PYRO_SIZE.axis - 1);                           \
        float v = known ? inflow.axis * PYRO_END_FLOWS.axis : PYRO_##component(carrier[pyro_at(c)]);\
        return clamp(reach * v, -FARTHEST, FARTHEST);                                              \
    }
WAY(way_x, x, X)
WAY(way_y, y, Y)
WAY(way_z, z, Z)

#define SWEEP_X 0
#define SWEEP_Y 1
#define SWEEP_Z 2
#if SWEEP == SWEEP_X
#define ALONG x
#define WAY_ALONG way_x
#elif SWEEP == SWEEP_Y
#define ALONG y
#define WAY_ALONG way_y
#else
#define ALONG z
#define WAY_ALONG way_z
#endif

// How much volume leaves a cell along y and z together, and along this sweep's axis.
#ifdef PYRO_SPREAD_IN_CARRIER
float spread_yz(ivec3 c) {
    return reach * PYRO_W(carrier[pyro_at(c)]);
}
#else
layout(std430) readonly buffer PyroSpread { float spread[]; }; // m/s
float spread_yz(ivec3 c) {
    return reach * spread[pyro_at(c)];
}
#endif
float spread_along(ivec3 c) {
    ivec3 above = c;
    above.ALONG++;
    return WAY_ALONG(above) - WAY_ALONG(c);
}

ivec3 cell_along(ivec3 c, int i) { // in the line of `c`; the nearest one, or around
    const int n = PYRO_SIZE.ALONG;
    if (PYRO_AROUND.ALONG) i += i < 0 ? n : i >= n ? -n : 0;
    c.ALONG = clamp(i, 0, n - 1);
    return c;
}
// The volume of a cell before the sweep.
float volume_of(ivec3 c) {
#if SWEEP == SWEEP_X
    return max(1.0 + spread_yz(c) + spread_along(c), LEAST_VOLUME);
#elif SWEEP == SWEEP_Y
    return max(1.0 + spread_yz(c), LEAST_VOLUME);
#else
    return max(1.0 + spread_along(c), LEAST_VOLUME);
#endif
}
#endif
