// Slices round an axis with made-up content, and a sampler of them on the host.
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "field/extrude.h"
#include <math.h>

enum { SLICES_X = 16, SLICES_Y = 8, SLICES_LAYERS = 5, SLICES_MOST = SLICES_LAYERS - 1 };

typedef struct test_slices {
    field_extrusion place;
    float scalars[SLICES_LAYERS][SLICES_Y][SLICES_X][4];
    float vectors[SLICES_LAYERS][SLICES_Y][SLICES_X][4];
} test_slices;

static inline float test_texel(uint32_t i) { // exact as a half, with a sign
    i = (i ^ 61) * 2654435761u;
    return (float)(i >> 24) / 128 - 1;
}

// The last layer is the first one mirrored.
static inline void test_slices_fill(test_slices *s) {
    uint32_t n = s->place.count, i = 0;
    for (uint32_t z = 0; z <= n; z++)
        for (int y = 0; y < SLICES_Y; y++)
            for (int x = 0; x < SLICES_X; x++)
                for (int c = 0; c < 4; c++, i++) {
                    int from = z < n ? x : SLICES_X - 1 - x;
                    float turned = z < n || c > 0 ? 1 : -1;
                    s->scalars[z][y][x][c] = z < n ? test_texel(i) : s->scalars[0][y][from][c];
                    s->vectors[z][y][x][c] =
                        z < n ? test_texel(i + 77777) : turned * s->vectors[0][y][from][c];
                }
}

// As a sampler filters: linear in all directions, up to the edge.
static inline float test_slices_sample(const test_slices *s, bool vectors, const float at[3],
                                       int channel) {
    const int size[3] = {SLICES_X, SLICES_Y, (int)s->place.count + 1};
    int first[3];
    float share[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        float texel = at[i] * (float)size[i] - 0.5f;
        texel = fminf(fmaxf(texel, 0), (float)size[i] - 1);
        first[i] = (int)fminf(floorf(texel), (float)size[i] - 2);
        share[i] = texel - (float)first[i];
    }
    for (int k = 0; k < 8; k++) {
        float weight = 1;
        for (int i = 0; i < 3; i++) weight *= k >> i & 1 ? share[i] : 1 - share[i];
        int x = first[0] + (k & 1), y = first[1] + (k >> 1 & 1), z = first[2] + (k >> 2);
        sum += weight * (vectors ? s->vectors : s->scalars)[z][y][x][channel];
    }
    return sum;
}

static inline float test_slices_scalar(const test_slices *s, float3 p, int channel) {
    field_extruded e = field_extrude(&s->place, p);
    return e.inside ? test_slices_sample(s, false, e.at, channel) : 0;
}

static inline float3 test_slices_vector(const test_slices *s, float3 p) {
    field_extruded e = field_extrude(&s->place, p);
    if (!e.inside) return (float3){0, 0, 0};
    float x = test_slices_sample(s, true, e.at, 0), y = test_slices_sample(s, true, e.at, 1);
    const float3 o = e.outward, a = s->place.along;
    return (float3){x * o.x + y * a.x, x * o.y + y * a.y, x * o.z + y * a.z};
}
