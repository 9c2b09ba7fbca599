// Ranges of noise (lib/noise.glsl). Twins in C: src/field/noise_range.c.
//
// A base noise cannot change by more than its slope times the way. So an octave lies around its
// value at the middle of the box, by the slope times half the diagonal (in its cells), and in -1..1;
// where that says nothing it is not even evaluated.
//
// Slopes, by all gradients (values) that the corners can have: at a point d of the cell, along a
// direction e, a lattice noise rises by sum_c g_c . (w_c e + (e . grad w_c) (d - c)); each corner's
// gradient g_c, an edge of the cube, gives at most the sum of the greatest but one components of
// that vector. What is left, to find the worst d and e, is a search (ascent from 60000 points);
// its results are rounded up by 2 to 3 %. The kernels of simplex noise likewise. Distances to
// feature points change by no more than the way.
#ifndef LIB_RANGE_NOISE_GLSL
#define LIB_RANGE_NOISE_GLSL
#include "lib/range_operator.glsl"
#include "lib/noise.glsl"

const vec2 RANGE_PERLIN = vec2(3.73, 3.80), RANGE_VALUE = vec2(3.86); // in 3 and 4 dimensions
const vec2 RANGE_SIMPLEX = vec2(7.2, 7.0);
const float RANGE_SIMPLEX4_CLOSED = 7.2;
const vec2 RANGE_CURL = vec2(7.45, 7.6), RANGE_CURL_SLOPE = vec2(21.7, 23.9); // of a component

range1 range_fold(range1 n, int fractal) {
    range1 size = range_abs(n);
    if (fractal == NOISE_RIDGED)
        return range1((1.0 - size.high) * (1.0 - size.high), (1.0 - size.low) * (1.0 - size.low));
    if (fractal == NOISE_BILLOW) return size;
    return range1(0.5 + 0.5 * n.low, 0.5 + 0.5 * n.high);
}

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

range1 range_around(float v, float r) {
    return range1(clamp(v - r, -1.0, 1.0), clamp(v + r, -1.0, 1.0));
}

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
    RANGE_NOISE_SUM(RANGE_NEAR(RANGE_VALUE, noise_value3(o.q.xyz, o.seed, o.period),
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

// From squared distances to the nearest and the second nearest point.
range1 range_cells(vec2 squared, float reach, float power, int distance) {
    vec2 f = sqrt(squared), low = clamp(f - reach, 0.0, 1.0), high = clamp(f + reach, 0.0, 1.0);
    range1 at = distance == NOISE_F2 ? range1(low.y, high.y) : range1(low.x, high.x);
    if (distance == NOISE_F2_F1)
        at = range1(max(max(low.y - high.x, f.y - f.x - 2.0 * reach), 0.0),
                    min(high.y - low.x, f.y - f.x + 2.0 * reach));
    power = clamp(power, 0.01, 16.0);
    at = range1(max(pow(at.low, power) - 1e-4, 0.0), min(pow(at.high, power) + 1e-4, 1.0));
    if (distance == NOISE_F2_F1) return range1(2.0 * at.low - 1.0, 2.0 * at.high - 1.0);
    return range1(1.0 - 2.0 * at.high, 1.0 - 2.0 * at.low);
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
