// Ranges of noise: the twin of shaders/lib/range_noise.glsl, which has the reasons.
#include "field/noise_parts.h"
#include <math.h>

// Greatest slopes of the bases, in 3 and 4 dimensions; shaders/lib/range_noise.glsl has the
// reasons.
static const float perlin_slope[2] = {3.73f, 3.80f}, value_slope[2] = {3.86f, 3.86f};
static const float simplex_slope[2] = {7.2f, 7.0f}, simplex4_closed_slope = 7.2f;
static const float most_curl[2] = {7.45f, 7.6f}, curl_slope[2] = {21.7f, 23.9f};

static float slope_of(noise_base base, const noise_desc *desc) {
    if (base == NOISE_VALUE) return value_slope[desc->four];
    if (base == NOISE_PERLIN) return perlin_slope[desc->four];
    return desc->four && desc->period >= 0.5f ? simplex4_closed_slope : simplex_slope[desc->four];
}

static interval around(float v, float reach) {
    return (interval){clampf(v - reach, -1, 1), clampf(v + reach, -1, 1)};
}

static interval cells_range(const noise_desc *desc, const noise_octave *o, float reach) {
    const float inexact = 1e-4f;
    float f[2], low[2], high[2], power = clampf(desc->power, 0.01f, 16);
    noise_base_distances(desc, o, f);
    for (int i = 0; i < 2; i++) {
        low[i] = clampf(f[i] - reach, 0, 1);
        high[i] = clampf(f[i] + reach, 0, 1);
    }
    int which = desc->distance == NOISE_F2;
    float from = low[which], to = high[which];
    if (desc->distance == NOISE_F2_F1) {
        from = fmaxf(fmaxf(low[1] - high[0], f[1] - f[0] - 2 * reach), 0);
        to = fminf(high[1] - low[0], f[1] - f[0] + 2 * reach);
    }
    from = fmaxf(powf(from, power) - inexact, 0);
    to = fminf(powf(to, power) + inexact, 1);
    if (desc->distance == NOISE_F2_F1) return (interval){2 * from - 1, 2 * to - 1};
    return (interval){1 - 2 * to, 1 - 2 * from};
}

static interval base_range(noise_base base, const noise_desc *desc, const noise_octave *o,
                           float reach) {
    float slope = base == NOISE_WORLEY ? 1 : slope_of(base, desc);
    if (reach * slope >= (base == NOISE_WORLEY ? 1 : 2)) return (interval){-1, 1};
    if (base == NOISE_WORLEY) return cells_range(desc, o, reach);
    return around(noise_base_value(base, desc, o), reach * slope);
}

static interval fold_range(interval n, noise_fractal fractal) {
    float near = fmaxf(fmaxf(n.low, -n.high), 0), far = fmaxf(n.high, -n.low);
    if (fractal == NOISE_RIDGED) return (interval){(1 - far) * (1 - far), (1 - near) * (1 - near)};
    if (fractal == NOISE_BILLOW) return (interval){near, far};
    return (interval){0.5f + 0.5f * n.low, 0.5f + 0.5f * n.high};
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

interval noise_range(noise_base base, const noise_desc *desc, const intervals *at) {
    float reach, total = 0;
    noise_octave o = begin_range(desc, at, &reach);
    interval sum = {0, 0};
    for (int i = 0; i < o.count; i++) {
        interval n = fold_range(base_range(base, desc, &o, reach), desc->fractal);
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
