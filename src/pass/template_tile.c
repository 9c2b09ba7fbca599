// Pictures of templates as tiles: all of one size, with values times alpha, so that they can be
// sampled between texels and on coarser levels.
#include "base/maths.h"
#include "pass/templates.h"
#include <math.h>

static const float border = 0.3f;      // standard deviation of alpha, in halves of a side
static const float largest = 60000.0f; // a half can hold

static float value_of(const picture *from, float v) {
    if (from->bits == 8) v = (v * 255 - 128) / 127;
    if (from->bits == 16) v = (v * 65535 - 32768) / 32767;
    return clampf(v, -largest, largest);
}

static bool has_alpha(const picture *from) {
    size_t count = (size_t)from->width * from->height;
    for (size_t i = 0; i < count; i++)
        if (from->rgba[4 * i + 3] < 1) return true;
    return false;
}

static float gaussian_at(uint32_t x, uint32_t y) { // of a tile
    float u = 2 * ((float)x + 0.5f) / TEMPLATE_TILE - 1,
          v = 2 * ((float)y + 0.5f) / TEMPLATE_TILE - 1;
    return expf(-0.5f * (u * u + v * v) / (border * border));
}

// Texels of a line of `from` become one of `to`: weights of a triangle, at least a texel wide on
// both sides, so that small pictures are smooth and large ones have their mean.
typedef struct line_share {
    uint32_t first, count;
    float at, scale; // middle and half width of the triangle, in texels of `from`
} line_share;

static line_share share_of(uint32_t i, uint32_t from, uint32_t to) {
    float scale = fmaxf((float)from / (float)to, 1);
    float at = ((float)i + 0.5f) * (float)from / (float)to - 0.5f;
    float first = fmaxf(ceilf(at - scale), 0);
    float last = fminf(floorf(at + scale), (float)from - 1);
    return (line_share){(uint32_t)first, (uint32_t)(last - first) + 1, at, scale};
}

static float weight_of(const line_share *s, uint32_t k) {
    return fmaxf(1 - fabsf((float)(s->first + k) - s->at) / s->scale, 0);
}

static void add_texel(const picture *from, uint32_t x, uint32_t y, float weight, float sum[4]) {
    const float *texel = &from->rgba[4 * ((size_t)y * from->width + x)];
    float alpha = weight * clampf(texel[3], 0, 1);
    for (int c = 0; c < 3; c++) sum[c] += alpha * value_of(from, texel[c]);
    sum[3] += alpha;
}

void template_tile(const picture *from, float out[TEMPLATE_TILE * TEMPLATE_TILE * 4]) {
    bool alpha = has_alpha(from);
    for (uint32_t y = 0; y < TEMPLATE_TILE; y++) {
        line_share rows = share_of(y, from->height, TEMPLATE_TILE);
        for (uint32_t x = 0; x < TEMPLATE_TILE; x++, out += 4) {
            line_share columns = share_of(x, from->width, TEMPLATE_TILE);
            float sum[4] = {0}, all = 0;
            for (uint32_t j = 0; j < rows.count; j++)
                for (uint32_t i = 0; i < columns.count; i++) {
                    float weight = weight_of(&rows, j) * weight_of(&columns, i);
                    add_texel(from, columns.first + i, rows.first + j, weight, sum);
                    all += weight;
                }
            float factor = (alpha ? 1 : gaussian_at(x, y)) / all;
            for (int c = 0; c < 4; c++) out[c] = factor * sum[c];
        }
    }
}

void template_tile_fade(float rgba[TEMPLATE_TILE * TEMPLATE_TILE * 4]) {
    for (uint32_t i = 0; i < TEMPLATE_TILE * TEMPLATE_TILE; i++)
        rgba[4 * i + 3] = gaussian_at(i % TEMPLATE_TILE, i / TEMPLATE_TILE);
}

void template_tile_half(const float *from, uint32_t side, float *out) {
    uint32_t half = side / 2;
    for (uint32_t y = 0; y < half; y++)
        for (uint32_t x = 0; x < half; x++)
            for (uint32_t c = 0; c < 4; c++) {
                const float *at = &from[4 * (2 * y * side + 2 * x) + c];
                out[4 * (y * half + x) + c] =
                    0.25f * (at[0] + at[4] + at[4 * side] + at[4 * side + 4]);
            }
}
