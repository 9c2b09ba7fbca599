// Ranges of noise (lib/noise.glsl), by slopes (lib/range_noise.h). Twins in C: src/field/noise_range.c.
#ifndef LIB_RANGE_NOISE_GLSL
#define LIB_RANGE_NOISE_GLSL
#include "lib/range_noise.h"
#include "lib/range_operator.glsl"
#include "lib/noise.glsl"

// In 3 and 4 dimensions.
const vec2 RANGE_PERLIN = vec2(RANGE_PERLIN3, RANGE_PERLIN4), RANGE_VALUES = vec2(RANGE_VALUE);
const vec2 RANGE_SIMPLEX = vec2(RANGE_SIMPLEX3, RANGE_SIMPLEX4);
const vec2 RANGE_CURL = vec2(RANGE_CURL3, RANGE_CURL4), RANGE_CURL_SLOPE = vec2(RANGE_CURL3_SLOPE, RANGE_CURL4_SLOPE);

// Half the diagonal of the box in cells of the first octave, and what rounding makes of a point.
float range_reach(range3 p, noise_octave o, float frequency) {
    vec3 q = abs(o.q.xyz);
    return 0.5 * length(p.high - p.low) * abs(frequency) + 1e-6 * (q.x + q.y + q.z) + 1e-5;
}

// As NOISE_SUM; NEAR is the range of the base around its value, given the reach `r` in cells.
#define RANGE_NOISE_SUM(NEAR)                                                                      \
    noise_octave o = noise_begin(0.5 * (p.low + p.high), frequency, octaves, lacunarity, seed,     \
                                 drift, phase + w, period);                                        \
    float reach = range_reach(p, o, frequency), total = 0.0;                                       \
    range1 sum = range1(0.0, 0.0);                                                                 \
    for (int i = 0; i < o.count; i++) {                                                            \
        range1 n = range_fold(NEAR, fractal);                                                      \
        sum = range1(sum.low + o.weight * n.low, sum.high + o.weight * n.high);                    \
        total += o.weight;                                                                         \
        noise_next(o, persistence);                                                                \
        reach *= abs(o.lacunarity);                                                                \
    }                                                                                              \
    return range_mul(amplitude, range_wide(sum.low / total, sum.high / total))

// GLSL evaluates only the operand that `?:` chooses.
#define RANGE_NEAR(SLOPE, THREE, FOUR)                                                             \
    (reach * SLOPE[dimensions] >= 2.0 ? range1(-1.0, 1.0)                                          \
     : range_around(dimensions == NOISE_FOUR ? FOUR : THREE, reach * SLOPE[dimensions]))

range1 range_perlin(range3 p, float frequency, float octaves, float persistence, float lacunarity,
                    float seed, range1 amplitude, vec3 drift, float phase, float w, float period,
                    int fractal, int dimensions) {
    RANGE_NOISE_SUM(RANGE_NEAR(RANGE_PERLIN, noise_perlin3(o.q.xyz, o.seed, o.period),
                               noise_perlin4(o.q, o.seed, o.period)));
}

range1 range_value(range3 p, float frequency, float octaves, float persistence, float lacunarity,
                   float seed, range1 amplitude, vec3 drift, float phase, float w, float period,
                   int fractal, int dimensions) {
    RANGE_NOISE_SUM(RANGE_NEAR(RANGE_VALUES, noise_value3(o.q.xyz, o.seed, o.period),
                               noise_value4(o.q, o.seed, o.period)));
}

range1 range_simplex(range3 p, float frequency, float octaves, float persistence, float lacunarity,
                     float seed, range1 amplitude, vec3 drift, float phase, float w, float period,
                     int fractal, int dimensions) {
    period = period >= 0.5 ? 3.0 * max(floor(period / 3.0 + 0.5), 1.0) : 0.0;
    vec2 slope = vec2(RANGE_SIMPLEX.x, period > 0.0 ? RANGE_SIMPLEX4_CLOSED : RANGE_SIMPLEX.y);
    RANGE_NOISE_SUM(RANGE_NEAR(slope, noise_simplex3(o.q.xyz, o.seed, o.period),
                               noise_simplex4(o.q, o.seed, o.period)));
}

range1 range_cells(vec2 squared, float reach, float power, int distance) {
    return range_cells(sqrt(squared.x), sqrt(squared.y), reach, power, distance);
}

range1 range_worley(range3 p, float frequency, float octaves, float persistence, float lacunarity,
                    float seed, range1 amplitude, vec3 drift, float phase, float w, float period,
                    float power, int fractal, int dimensions, int distance, int mode) {
    RANGE_NOISE_SUM(reach >= 1.0 ? range1(-1.0, 1.0)
                    : range_cells(dimensions == NOISE_FOUR
                                      ? noise_worley4(o.q, o.seed, o.period, mode == NOISE_PAPER ? o.shift : -1.0)
                                      : noise_worley3(o.q.xyz, o.seed, o.period, mode == NOISE_PAPER ? o.shift : -1.0),
                                  reach, power, distance));
}

// The paper's differences: of one octave no more than its range, nor than its slope times the way.
float range_paper_curl(noise_octave o, float frequency, float persistence, float delta, float slope) {
    float way = 2.0 * sqrt(2.0) * abs(delta * frequency) + 1e-5, sum = 0.0;
    for (int i = 0; i < o.count; i++) {
        sum += o.weight * min(slope * way, 2.0);
        noise_next(o, persistence);
        way *= abs(o.lacunarity);
    }
    return sum;
}

range3 range_curl(range3 p, float frequency, float octaves, float persistence, float lacunarity,
                  float seed, range1 amount, vec3 drift, float phase, float w, float period,
                  float delta, int mode, int dimensions) {
    noise_octave o = noise_begin(0.5 * (p.low + p.high), frequency, octaves, lacunarity, seed,
                                 drift, phase + w, period);
    range3 all = range3(vec3(0.0), vec3(0.0));
    if (mode == NOISE_PAPER) {
        all.high += range_paper_curl(o, frequency, persistence, delta, RANGE_PERLIN[dimensions]);
        all.low = -all.high;
    } else {
        float reach = range_reach(p, o, frequency) * RANGE_CURL_SLOPE[dimensions], total = 0.0;
        vec3 most = vec3(RANGE_CURL[dimensions]);
        for (int i = 0; i < o.count; i++) {
            range3 n = range3(-most, most);
            if (reach < 2.0 * most.x) {
                vec3 v = noise_curl_base(o.q, o.seed, o.period, dimensions);
                n = range3(max(v - reach, -most), min(v + reach, most));
            }
            all = range3(all.low + o.weight * n.low, all.high + o.weight * n.high);
            total += o.weight;
            noise_next(o, persistence);
            reach *= abs(o.lacunarity);
        }
        all = range3(all.low / total, all.high / total);
    }
    return range_mul(range_vec3(amount), all);
}

#endif
