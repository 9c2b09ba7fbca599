// The velocity's own sweep: each component is carried in volumes around its faces, each between the middles
// of two cells. So momentum that leaves one comes into another. Parabolas are not bounded here, as those of
// the gas are (flux.glsl): nothing breaks when a velocity is a little beyond those around it, and eddies last
// longer.
#ifndef SIM_PYRO_STIR_GLSL
#define SIM_PYRO_STIR_GLSL
#include "sim/pyro/volumes.glsl"

layout(std430) readonly buffer PyroFlowFrom { PYRO_FOUR flow_from[]; }; // before the sweep

// A component at its face `i` of the line of `c`.
#define VALUE(name, axis, component, is_along)                                                     \
    float name(ivec3 c, int i) {                                                                   \
        if (is_along && !PYRO_AROUND.ALONG) {                                                      \
            if (i >= PYRO_SIZE.ALONG && PYRO_ENDS.ALONG) return inflow.ALONG * PYRO_END_FLOWS.ALONG;\
            i = max(i, PYRO_FIRST.ALONG);                                                          \
        }                                                                                          \
        return PYRO_##component(flow_from[pyro_at(cell_along(c, i))]);                             \
    }
VALUE(value_x, x, X, SWEEP == SWEEP_X)
VALUE(value_y, y, Y, SWEEP == SWEEP_Y)
VALUE(value_z, z, Z, SWEEP == SWEEP_Z)

ivec3 cell_below(ivec3 c, ivec3 step_) {
    return pyro_into(c - step_);
}

// The ways across the lower ends of the three volumes `i` of the line of `c`, in cells.
vec3 ways_at(ivec3 c, int i) {
    c.ALONG = i;
    float own = WAY_ALONG(c);
    ivec3 back = c;
    back.ALONG--;
    vec3 other = vec3(SWEEP == SWEEP_X ? WAY_ALONG(back) : WAY_ALONG(ivec3(pyro_into(ivec3(c.x - 1, 0, 0)).x, c.yz)),
                      SWEEP == SWEEP_Y ? WAY_ALONG(back) : WAY_ALONG(ivec3(c.x, pyro_into(ivec3(0, c.y - 1, 0)).y, c.z)),
                      SWEEP == SWEEP_Z ? WAY_ALONG(back) : WAY_ALONG(ivec3(c.xy, pyro_into(ivec3(0, 0, c.z - 1)).z)));
    return 0.5 * (own + other);
}

// Their volumes before the sweep.
vec3 volumes_at(ivec3 c, int i) {
    c = cell_along(c, i);
    return 0.5 * (volume_of(c) + vec3(volume_of(cell_below(c, ivec3(1, 0, 0))), volume_of(cell_below(c, ivec3(0, 1, 0))),
                                      volume_of(cell_below(c, ivec3(0, 0, 1)))));
}

// The mean of what leaves a volume, `part` of it, where values are a parabola through it and its neighbours,
// of which those before lie where it goes.
#define PARABOLA(type)                                                                             \
    type parabola(type part, type before2, type before, type own, type behind, type behind2) {     \
        type first = 7.0 / 12.0 * (own + behind) - 1.0 / 12.0 * (before + behind2);                \
        type last = 7.0 / 12.0 * (own + before) - 1.0 / 12.0 * (behind + before2);                 \
        type rise = last - first, bow = 6.0 * own - 3.0 * (first + last);                          \
        return last - 0.5 * part * (rise - (1.0 - 2.0 / 3.0 * part) * bow);                        \
    }
PARABOLA(float)
PARABOLA(vec3)

// What crosses the lower end of a volume `i` when it moves by `way`, upwards. `volume`: of that from which
// it comes.
#define FLUX(name, value, part_of)                                                                 \
    float name(ivec3 c, int i, float way, float volume) {                                          \
        int up = way > 0.0 ? -1 : 1, at = way > 0.0 ? i - 1 : i;                                   \
        float rest = abs(way), sum = 0.0;                                                          \
        for (int k = 0; k < MOST_CELLS && rest >= volume; k++) {                                   \
            sum += volume * value(c, at);                                                          \
            rest -= volume;                                                                        \
            at += up;                                                                              \
            volume = volumes_at(c, at).part_of;                                                    \
        }                                                                                          \
        float own = value(c, at), part = min(rest / volume, 1.0);                                  \
        if (PYRO_PARABOLIC == 1)                                                                   \
            own = parabola(part, value(c, at - 2 * up), value(c, at - up), own, value(c, at + up), value(c, at + 2 * up));\
        return (way > 0.0 ? 1.0 : -1.0) * (sum + rest * own);                                      \
    }
FLUX(flux_x, value_x, x)
FLUX(flux_y, value_y, y)
FLUX(flux_z, value_z, z)

#if PYRO_SIDE_BY_SIDE
// All components at the face `i` of the line of `c`.
vec3 values_at(ivec3 c, int i) {
    vec3 v = pyro_load(flow_from[pyro_at(cell_along(c, i))]).xyz;
    if (!PYRO_AROUND.ALONG && (i < PYRO_FIRST.ALONG || i >= PYRO_SIZE.ALONG))
        v.ALONG = SWEEP == SWEEP_X ? value_x(c, i) : SWEEP == SWEEP_Y ? value_y(c, i) : value_z(c, i);
    return v;
}

// What crosses when all components come from the same volume, and from a part of it: nearly everywhere.
vec3 fluxes_from(ivec3 c, int i, vec3 ways, vec3 volumes) {
    int up = ways.x > 0.0 ? -1 : 1, at = ways.x > 0.0 ? i - 1 : i;
    vec3 own = values_at(c, at), part = abs(ways) / volumes;
    if (PYRO_PARABOLIC == 1)
        own = parabola(part, values_at(c, at - 2 * up), values_at(c, at - up), own, values_at(c, at + up),
                       values_at(c, at + 2 * up));
    return ways * own;
}
#endif

vec3 fluxes_at(ivec3 c, int i, vec3 ways, vec3 volumes_below, vec3 volumes) {
    vec3 from = mix(volumes, volumes_below, greaterThan(ways, vec3(0.0)));
#if PYRO_SIDE_BY_SIDE
    bvec3 upwards = greaterThan(ways, vec3(0.0));
    if ((all(upwards) || !any(upwards)) && all(lessThan(abs(ways), from))) return fluxes_from(c, i, ways, from);
#endif
    return vec3(flux_x(c, i, ways.x, from.x), flux_y(c, i, ways.y, from.y), flux_z(c, i, ways.z, from.z));
}

// A line of faces, from its lowest one upwards.
struct stir_state {
    vec3 ways, comes; // across the lower ends of the next volumes
    vec3 volumes;     // before the sweep
};

stir_state stir_begin(ivec3 c) {
    stir_state s;
    int i = c.ALONG;
    s.ways = ways_at(c, i);
    s.volumes = volumes_at(c, i);
    s.comes = fluxes_at(c, i, s.ways, volumes_at(c, i - 1), s.volumes);
    return s;
}

// A velocity after the sweep, when so much comes into its volumes, and goes.
vec3 after_stir(ivec3 c, vec3 volumes, vec3 ways, vec3 comes, vec3 next_ways, vec3 goes) {
    int i = c.ALONG;
    vec3 own = vec3(value_x(c, i), value_y(c, i), value_z(c, i)), after = volumes + ways - next_ways;
    vec3 held = (own * volumes + comes - goes) / max(after, vec3(LEAST_VOLUME));
    return mix(own, held, greaterThanEqual(after, vec3(LEAST_VOLUME)));
}

// The velocity at the next faces after the sweep.
vec3 stir_next(inout stir_state s, ivec3 c) {
    int i = c.ALONG;
    vec3 ways = ways_at(c, i + 1), next = volumes_at(c, i + 1);
    vec3 goes = fluxes_at(c, i + 1, ways, s.volumes, next);
    vec3 held = after_stir(c, s.volumes, s.ways, s.comes, ways, goes);
    s = stir_state(ways, goes, next);
    return held;
}
#endif
