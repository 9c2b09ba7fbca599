// What the gas carries across faces, by volumes that move along one axis in a sweep. What crosses a face
// in a step is what lies within the way of its gas: some whole cells, and of the next one a part, in which
// values are a parabola (Colella and Woodward 1984; with whole cells, Leonard, Lock and MacVean 1996). So
// steps may be as long as they like, and what leaves a cell comes into another: nothing is lost.
#ifndef SIM_PYRO_FLUX_GLSL
#define SIM_PYRO_FLUX_GLSL
#include "sim/pyro/volumes.glsl"

// Beyond the ends of a line clean air is where gas can pass.
bool is_outside(int i) {
    return (i < 0 && PYRO_PASSES_LOW.ALONG) || (i >= PYRO_SIZE.ALONG && PYRO_PASSES_HIGH.ALONG);
}
float volume_along(ivec3 c, int i) { // before the sweep
    return is_outside(i) ? 1.0 : volume_of(cell_along(c, i));
}
bvec4 at_most(vec4 a, vec4 b) {
    return lessThanEqual(a, b);
}
bvec4 is_more(vec4 a, vec4 b) {
    return greaterThan(a, b);
}
bool at_most(float a, float b) {
    return a <= b;
}
bool is_more(float a, float b) {
    return a > b;
}

layout(std430) readonly buffer PyroGasFrom { PYRO_FOUR gas_from[]; }; // before the sweep
#define GAS_FROM(at) pyro_load(gas_from[at])
#if PYRO_SMOKE
layout(std430) readonly buffer PyroSmokeFrom { float smoke_from[]; };
#define SMOKE_FROM(at) smoke_from[at]
#endif

// The four numbers of the gas are carried by the functions gas_*, smoke by smoke_*; they are the same.
#define EACH_HELD_GAS(function) function(gas, vec4, GAS_FROM)
#if PYRO_SMOKE
#define EACH_HELD(function) EACH_HELD_GAS(function) function(smoke, float, SMOKE_FROM)
#else
#define EACH_HELD EACH_HELD_GAS
#endif

// Of a cell of the line of `c`, which may be beyond its ends.
#define ALONG_OF(name, type, from)                                                                 \
    type name##_along(ivec3 c, int i) {                                                            \
        return is_outside(i) ? type(0.0) : from(pyro_at(cell_along(c, i)));                        \
    }
EACH_HELD(ALONG_OF)

// The value between two cells of four.
#define BETWEEN(type)                                                                              \
    type value_between(type a, type b, type c, type d) {                                           \
        return clamp(7.0 / 12.0 * (b + c) - 1.0 / 12.0 * (a + d), min(b, c), max(b, c));           \
    }
BETWEEN(vec4)
BETWEEN(float)

// The mean of what leaves a cell, `part` of it, where values are a parabola, of which `first` is the far end
// and `last` the one where gas leaves. Between these it goes neither up nor down again.
#define PARABOLA(type)                                                                             \
    type parabola(float part, type own, type first, type last) {                                   \
        type from = first, to = last, rise = last - first, bow = 6.0 * own - 3.0 * (first + last); \
        first = mix(first, 3.0 * own - 2.0 * last, is_more(rise * bow, rise * rise));              \
        last = mix(last, 3.0 * own - 2.0 * first, is_more(-rise * rise, rise * bow));              \
        first = mix(first, own, at_most((to - own) * (own - from), type(0.0)));                    \
        last = mix(last, own, at_most((to - own) * (own - from), type(0.0)));                      \
        rise = last - first, bow = 6.0 * own - 3.0 * (first + last);                               \
        return last - 0.5 * part * (rise - (1.0 - 2.0 / 3.0 * part) * bow);                        \
    }
PARABOLA(vec4)
PARABOLA(float)

// What crosses the lower face of the cell `i` of the line of `c` when its gas moves by `way`, upwards.
// `volume`: of the cell from which it comes, before the sweep.
#define FLUX_OF(name, type, from)                                                                  \
    type name##_flux(ivec3 c, int i, float way, float volume) {                                    \
        int up = way > 0.0 ? -1 : 1, at = way > 0.0 ? i - 1 : i; /* `up` is against the way */     \
        float rest = abs(way);                                                                     \
        type sum = type(0.0);                                                                      \
        for (int k = 0; k < MOST_CELLS && rest >= volume; k++) {                                   \
            sum += volume * name##_along(c, at);                                                   \
            rest -= volume;                                                                        \
            at += up;                                                                              \
            volume = volume_along(c, at);                                                          \
        }                                                                                          \
        type own = name##_along(c, at);                                                            \
        if (PYRO_PARABOLIC == 1) {                                                                 \
            type behind = name##_along(c, at + up), before = name##_along(c, at - up);             \
            own = parabola(min(rest / volume, 1.0), own,                                           \
                           value_between(before, own, behind, name##_along(c, at + 2 * up)),       \
                           value_between(name##_along(c, at - 2 * up), before, own, behind));      \
        }                                                                                          \
        return (way > 0.0 ? 1.0 : -1.0) * (sum + rest * own);                                      \
    }
EACH_HELD(FLUX_OF)

// What a cell holds after a sweep in which so much comes and goes. Where a step is so long that a sweep
// takes all of a cell's gas and more, it has no volume between sweeps: there values are kept in bounds
// instead, and balance is lost.
#define AFTER(type)                                                                                \
    type after_sweep(type own, float before, float way, type comes, float next_way, type goes) {   \
        float volume = SWEEP == SWEEP_Z ? 1.0 : before + way - next_way;                           \
        if (volume < LEAST_VOLUME) return own;                                                     \
        type held = (own * before + comes - goes) / volume;                                        \
        if (before <= LEAST_VOLUME) {                                                              \
            type from_below = way > 0.0 ? comes / way : own;                                       \
            type from_above = next_way < 0.0 ? goes / next_way : own;                              \
            held = clamp(held, min(own, min(from_below, from_above)), max(own, max(from_below, from_above)));\
        }                                                                                          \
        return pyro_clean(held);                                                                   \
    }
AFTER(vec4)
AFTER(float)

// A line of cells, from its lowest one upwards: `way` across the lower face of the next cell, what `comes`
// through it, and the `volume` of that cell before the sweep. gas_next: what the next cell holds after it.
#define SWEEP_OF(name, type, from)                                                                 \
    struct name##_sweep {                                                                          \
        float way;                                                                                 \
        type comes;                                                                                \
        float volume;                                                                              \
    };                                                                                             \
    name##_sweep name##_begin(ivec3 c) {                                                           \
        name##_sweep s;                                                                            \
        s.way = WAY_ALONG(c);                                                                      \
        s.volume = volume_along(c, c.ALONG);                                                       \
        s.comes = name##_flux(c, c.ALONG, s.way, s.way > 0.0 ? volume_along(c, c.ALONG - 1) : s.volume);\
        return s;                                                                                  \
    }                                                                                              \
    type name##_next(inout name##_sweep s, ivec3 c) {                                              \
        ivec3 above = c;                                                                           \
        above.ALONG++;                                                                             \
        float way = WAY_ALONG(above), next = volume_along(c, above.ALONG);                         \
        type goes = name##_flux(c, above.ALONG, way, way > 0.0 ? s.volume : next);                 \
        type held = after_sweep(from(pyro_at(c)), s.volume, s.way, s.comes, way, goes);            \
        s = name##_sweep(way, goes, next);                                                         \
        return held;                                                                               \
    }
EACH_HELD(SWEEP_OF)
#endif
