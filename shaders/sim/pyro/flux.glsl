// What the gas carries across faces, by volumes that move along one axis in a sweep. What crosses a face
// in a step is what lies within the way of its gas: some whole cells, and of the next one a part, in which
// values are a parabola (Colella and Woodward 1984; with whole cells, Leonard, Lock and MacVean 1996). So
// steps may be as long as they like, and what leaves a cell comes into another: nothing is lost.
#ifndef SIM_PYRO_FLUX_GLSL
#define SIM_PYRO_FLUX_GLSL
#include "sim/pyro/volumes.glsl"

layout(std430) readonly buffer PyroGasFrom { PYRO_FOUR gas_from[]; }; // before the sweep

// Of a cell of the line of `c`, which may be beyond its ends, where clean air is when gas can pass.
bool is_outside(int i) {
    return (i < 0 && PYRO_PASSES_LOW.ALONG) || (i >= PYRO_SIZE.ALONG && PYRO_PASSES_HIGH.ALONG);
}
vec4 gas_along(ivec3 c, int i) {
    return is_outside(i) ? vec4(0.0) : pyro_load(gas_from[pyro_at(cell_along(c, i))]);
}
float volume_along(ivec3 c, int i) { // before the sweep
    return is_outside(i) ? 1.0 : volume_of(cell_along(c, i));
}

// The value between two cells of four.
vec4 value_between(vec4 a, vec4 b, vec4 c, vec4 d) {
    return clamp(7.0 / 12.0 * (b + c) - 1.0 / 12.0 * (a + d), min(b, c), max(b, c));
}

// What crosses the lower face of the cell `i` of the line of `c` when its gas moves by `way`, upwards.
// `volume`: of the cell from which it comes, before the sweep.
vec4 flux_along(ivec3 c, int i, float way, float volume) {
    int up = way > 0.0 ? -1 : 1; // against the way
    int at = way > 0.0 ? i - 1 : i;
    float rest = abs(way);
    vec4 sum = vec4(0.0);
    for (int k = 0; k < MOST_CELLS && rest >= volume; k++) {
        sum += volume * gas_along(c, at);
        rest -= volume;
        at += up;
        volume = volume_along(c, at);
    }
    vec4 own = gas_along(c, at);
#if PYRO_PARABOLIC
    float part = min(rest / volume, 1.0);
    vec4 behind = gas_along(c, at + up), before = gas_along(c, at - up);
    vec4 first = value_between(before, own, behind, gas_along(c, at + 2 * up)); // at the far end
    vec4 last = value_between(gas_along(c, at - 2 * up), before, own, behind);  // where gas leaves
    vec4 rise = last - first, bow = 6.0 * own - 3.0 * (first + last);
    bvec4 peaks = lessThanEqual((last - own) * (own - first), vec4(0.0));
    bvec4 low = greaterThan(rise * bow, rise * rise), high = lessThan(rise * bow, -rise * rise);
    first = mix(first, 3.0 * own - 2.0 * last, low);
    last = mix(last, 3.0 * own - 2.0 * first, high);
    first = mix(first, own, peaks);
    last = mix(last, own, peaks);
    rise = last - first, bow = 6.0 * own - 3.0 * (first + last);
    own = last - 0.5 * part * (rise - (1.0 - 2.0 / 3.0 * part) * bow);
#endif
    return (way > 0.0 ? 1.0 : -1.0) * (sum + rest * own);
}

// What a cell holds after a sweep in which so much comes and goes. Where a step is so long that a sweep
// takes all of a cell's gas and more, it has no volume between sweeps: there values are kept in bounds
// instead, and balance is lost.
vec4 after_sweep(vec4 gas, float before, float way, vec4 comes, float next_way, vec4 goes) {
    float volume = before + way - next_way;
#if SWEEP == SWEEP_Z
    volume = 1.0;
#endif
    if (volume < LEAST_VOLUME) return gas;
    vec4 held = (gas * before + comes - goes) / volume;
    if (before <= LEAST_VOLUME) {
        vec4 from_below = way > 0.0 ? comes / way : gas, from_above = next_way < 0.0 ? goes / next_way : gas;
        held = clamp(held, min(gas, min(from_below, from_above)), max(gas, max(from_below, from_above)));
    }
    return pyro_clean(held);
}

// A line of cells, from its lowest one upwards.
struct sweep_state {
    float way;    // across the lower face of the next cell
    vec4 comes;   // through it
    float volume; // of that cell, before the sweep
};

sweep_state sweep_begin(ivec3 c) {
    sweep_state s;
    s.way = WAY_ALONG(c);
    s.volume = volume_along(c, c.ALONG);
    s.comes = flux_along(c, c.ALONG, s.way, s.way > 0.0 ? volume_along(c, c.ALONG - 1) : s.volume);
    return s;
}

// What the next cell holds after the sweep.
vec4 sweep_next(inout sweep_state s, ivec3 c) {
    ivec3 above = c;
    above.ALONG++;
    float way = WAY_ALONG(above), next = volume_along(c, above.ALONG);
    vec4 goes = flux_along(c, above.ALONG, way, way > 0.0 ? s.volume : next);
    vec4 held = after_sweep(pyro_load(gas_from[pyro_at(c)]), s.volume, s.way, s.comes, way, goes);
    s.way = way;
    s.comes = goes;
    s.volume = next;
    return held;
}
#endif
