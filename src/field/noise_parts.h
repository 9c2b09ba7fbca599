// Between the parts of noise: noise.c computes bases and octaves, noise_range.c bounds them.
#pragma once
#include "field/noise.h"

typedef struct noise_octave {
    float q[4], lacunarity, period, weight, shift;
    uint32_t seed;
    int count; // of all octaves
} noise_octave;

noise_octave noise_begin(const noise_desc *desc, float3 p);
void noise_next(noise_octave *o, const noise_desc *desc);

float noise_base_value(noise_base base, const noise_desc *desc,
                       const noise_octave *o); // about -1..1
// Distances to the nearest and the second nearest feature point, at most 1.
void noise_base_distances(const noise_desc *desc, const noise_octave *o, float f[2]);
void noise_base_curl(const noise_desc *desc, const noise_octave *o, float out[3]);
