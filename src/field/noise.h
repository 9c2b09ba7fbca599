// Procedural noise on the host: the twin of shaders/lib/noise.glsl, which describes it.
#pragma once
#include "base/maths.h"
#include "field/range.h"
#include <stdbool.h>

typedef enum noise_base { NOISE_PERLIN, NOISE_SIMPLEX, NOISE_VALUE, NOISE_WORLEY } noise_base;

typedef struct noise_desc {
    float frequency, octaves, persistence, lacunarity, seed, amplitude;
    float drift[3], phase; // times the time already
    float period;
    float power; // worley
    float delta; // curl, paper's
    int fractal;
    int distance; // worley
    bool paper;   // worley: its hash; curl: its differences
    bool four;    // dimensions
} noise_desc;

float noise_eval(noise_base base, const noise_desc *desc, float3 p); // 0..amplitude
void noise_curl(const noise_desc *desc, float3 p, float out[3]);     // amplitude is the amount
// In the box `at`, of amplitude 1.
range1 noise_range(noise_base base, const noise_desc *desc, const intervals *at);
intervals noise_curl_ranges(const noise_desc *desc, const intervals *at);
