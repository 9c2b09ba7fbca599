// What noise on the GPU (lib/noise.glsl) and on the host (src/field/noise.c) have in common. C compiles
// this text too (src/field/glsl.h).
#ifndef LIB_NOISE_H
#define LIB_NOISE_H
#ifndef SHARED
#define SHARED
#endif

#define NOISE_NEXT_SEED 0x9e3779b9u
#define NOISE_MAX_OCTAVES 12
#define NOISE_FBM 0 // option "fractal"
#define NOISE_RIDGED 1
#define NOISE_BILLOW 2
#define NOISE_F1 0 // option "distance"
#define NOISE_F2 1
#define NOISE_F2_F1 2

// What brings the extremes of a base to 1, in 3 and 4 dimensions; of simplex noise that repeats in 4.
#define NOISE_PERLIN3 0.964921415f
#define NOISE_PERLIN4 0.655895233f
#define NOISE_SIMPLEX3 76.8f
#define NOISE_SIMPLEX4 62.7f
#define NOISE_SIMPLEX4_CLOSED 80.0f

// Full avalanche in two multiplications (Wellons, "Prospecting for hash functions", lowbias32).
SHARED uint noise_hash(uint h) {
    h ^= h >> 16u;
    h *= 0x7feb352du;
    h ^= h >> 15u;
    h *= 0x846ca68bu;
    return h ^ (h >> 16u);
}

SHARED float noise_fold(float n, int fractal) { // -1..1 to 0..1
    if (fractal == NOISE_RIDGED) return (1.0f - abs(n)) * (1.0f - abs(n));
    return fractal == NOISE_BILLOW ? abs(n) : 0.5f + 0.5f * n;
}

// Worley noise from the distances to the nearest and the second nearest feature point: high near them.
SHARED float noise_cells(float f1, float f2, float power, int distance) {
    float at = distance == NOISE_F2_F1 ? f2 - f1 : distance == NOISE_F2 ? f2 : f1;
    float v = pow(at, clamp(power, 0.01f, 16.0f));
    return distance == NOISE_F2_F1 ? 2.0f * v - 1.0f : 1.0f - 2.0f * v;
}

#endif
