// Ranges of noise: the twin of shaders/lib/range_noise.glsl, which has the reasons.
#include "field/noise_parts.h"
#include <math.h>

// Greatest slopes of the bases, in 3 and 4 dimensions.
static const float perlin_slope[2] = {RANGE_PERLIN3, RANGE_PERLIN4};
static const float simplex_slope[2] = {RANGE_SIMPLEX3, RANGE_SIMPLEX4};
static const float most_curl[2] = {RANGE_CURL3, RANGE_CURL4};
static const float curl_slope[2] = {RANGE_CURL3_SLOPE, RANGE_CURL4_SLOPE};

static float slope_of(noise_base base, const noise_desc *desc) {
    if (base == NOISE_VALUE) return RANGE_VALUE;
    if (base == NOISE_PERLIN) return perlin_slope[desc->four];
    return desc->four && desc->period >= 0.5f ? RANGE_SIMPLEX4_CLOSED : simplex_slope[desc->four];
}

static range1 cells_range(const noise_desc *desc, const noise_octave *o, float reach) {
    float f[2];
    noise_base_distances(desc, o, f);
    return range_cells(f[0], f[1], reach, desc->power, desc->distance);
}

static range1 base_range(noise_base base, const noise_desc *desc, const noise_octave *o,
                         float reach) {
    float slope = base == NOISE_WORLEY ? 1 : slope_of(base, desc);
    if (reach * slope >= (base == NOISE_WORLEY ? 1 : 2)) return range1(-1, 1);
    if (base == NOISE_WORLEY) return cells_range(desc, o, reach);
    return range_around(noise_base_value(base, desc, o), reach * slope);
}

static noise_octave begin_range(const noise_desc *desc, const intervals *at, float *reach) {
    float square = 0, middle[3], rounding = 0;
    for (int i = 0; i < 3; i++) {
        float side = at->c[i].high - at->c[i].low;
        square += side * side;
        middle[i] = 0.5f * (at->c[i].low + at->c[i].high);
    }
    noise_octave o = noise_begin(desc, (float3){middle[0], middle[1], middle[2]});
    for (int i = 0; i < 3; i++) rounding += 1e-6f * fabsf(o.q[i]);
    *reach = 0.5f * sqrtf(square) * fabsf(desc->frequency) + rounding + 1e-5f;
    return o;
}

range1 noise_range(noise_base base, const noise_desc *desc, const intervals *at) {
    float reach, total = 0;
    noise_octave o = begin_range(desc, at, &reach);
    range1 sum = {0, 0};
    for (int i = 0; i < o.count; i++) {
        range1 n = range_fold(base_range(base, desc, &o, reach), desc->fractal);
        sum.low += o.weight * n.low;
        sum.high += o.weight * n.high;
        total += o.weight;
        noise_next(&o, desc);
        reach *= fabsf(o.lacunarity);
    }
    return range_wide(sum.low / total, sum.high / total);
}

static intervals paper_curl_range(const noise_desc *desc) {
    noise_octave o = noise_begin(desc, (float3){0, 0, 0});
    float way = 2 * sqrtf(2) * fabsf(desc->delta * desc->frequency) + 1e-5f, sum = 0;
    for (int i = 0; i < o.count; i++) {
        sum += o.weight * fminf(perlin_slope[desc->four] * way, 2);
        noise_next(&o, desc);
        way *= fabsf(o.lacunarity);
    }
    return (intervals){{{-sum, sum}, {-sum, sum}, {-sum, sum}}};
}

intervals noise_curl_ranges(const noise_desc *desc, const intervals *at) {
    if (desc->paper) return paper_curl_range(desc);
    float reach, total = 0, most = most_curl[desc->four];
    noise_octave o = begin_range(desc, at, &reach);
    intervals sum = {0};
    reach *= curl_slope[desc->four];
    for (int i = 0; i < o.count; i++) {
        float curl[3] = {0};
        if (reach < 2 * most) noise_base_curl(desc, &o, curl);
        for (int k = 0; k < 3; k++) {
            bool known = reach < 2 * most;
            sum.c[k].low += o.weight * (known ? fmaxf(curl[k] - reach, -most) : -most);
            sum.c[k].high += o.weight * (known ? fminf(curl[k] + reach, most) : most);
        }
        total += o.weight;
        noise_next(&o, desc);
        reach *= fabsf(o.lacunarity);
    }
    for (int k = 0; k < 3; k++) sum.c[k] = range_wide(sum.c[k].low / total, sum.c[k].high / total);
    return sum;
}
