#include "media/sheet.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

sheet sheet_create(uint32_t columns, uint32_t rows, uint32_t width, uint32_t height) {
    const size_t count = (size_t)columns * width * rows * height;
    return (sheet){columns, rows, width, height, mem_alloc(count * 4 * sizeof(float))};
}

void sheet_free(sheet *s) {
    mem_free(s->pixels);
    *s = (sheet){0};
}

float *sheet_pixel(const sheet *s, uint32_t cell, uint32_t x, uint32_t y) {
    const size_t row = (size_t)(cell / s->columns) * s->height + y;
    const size_t column = (size_t)(cell % s->columns) * s->width + x;
    return s->pixels + 4 * (row * s->columns * s->width + column);
}

void sheet_add(sheet *s, uint32_t cell, const float *picture, float weight) {
    for (uint32_t y = 0; y < s->height; y++) {
        float *to = sheet_pixel(s, cell, 0, y);
        const float *from = picture + (size_t)4 * y * s->width;
        for (size_t i = 0; i < (size_t)4 * s->width; i++)
            if (isfinite(from[i])) to[i] += weight * from[i];
    }
}

static bool is_used(const float *pixel, float least, int channels) {
    for (int c = 0; c < channels; c++)
        if (pixel[c] > least) return true;
    return false;
}

sheet_area sheet_find_used_in(const sheet *s, uint32_t cell, float least, int channels) {
    sheet_area used = {s->width, s->height, 0, 0};
    for (uint32_t y = 0; y < s->height; y++)
        for (uint32_t x = 0; x < s->width; x++) {
            if (!is_used(sheet_pixel(s, cell, x, y), least, channels)) continue;
            if (x < used.left) used.left = x;
            if (y < used.top) used.top = y;
            if (x >= used.right) used.right = x + 1;
            if (y >= used.bottom) used.bottom = y + 1;
        }
    return used;
}

sheet_area sheet_find_used(const sheet *s, float least, int channels) {
    sheet_area all = {s->width, s->height, 0, 0};
    for (uint32_t cell = 0; cell < s->columns * s->rows; cell++) {
        sheet_area used = sheet_find_used_in(s, cell, least, channels);
        if (used.left < all.left) all.left = used.left;
        if (used.top < all.top) all.top = used.top;
        if (used.right > all.right) all.right = used.right;
        if (used.bottom > all.bottom) all.bottom = used.bottom;
    }
    return all;
}

void sheet_crop(sheet *s, sheet_area area) {
    sheet cut = sheet_create(s->columns, s->rows, area.right - area.left, area.bottom - area.top);
    for (uint32_t cell = 0; cell < s->columns * s->rows; cell++)
        for (uint32_t y = 0; y < cut.height; y++)
            memcpy(sheet_pixel(&cut, cell, 0, y), sheet_pixel(s, cell, area.left, area.top + y),
                   (size_t)4 * cut.width * sizeof(float));
    sheet_free(s);
    *s = cut;
}

void sheet_unpremultiply(sheet *s) {
    const size_t count = (size_t)s->columns * s->width * s->rows * s->height;
    for (size_t i = 0; i < count; i++) {
        float *pixel = s->pixels + 4 * i;
        for (int c = 0; c < 3; c++) pixel[c] = pixel[3] > 1e-4f ? pixel[c] / pixel[3] : 0;
    }
}

// ---- pull and push ----------------------------------------------------------------------------

typedef struct level {
    uint32_t width, height;
    float *texels; // colour times weight, weight: 0 to 1
} level;

enum { MOST_LEVELS = 16 };

static const float *level_at(const level *l, uint32_t x, uint32_t y) {
    if (x >= l->width) x = l->width - 1;
    if (y >= l->height) y = l->height - 1;
    return l->texels + 4 * ((size_t)y * l->width + x);
}

static level pull(const level *fine) {
    level l = {(fine->width + 1) / 2, (fine->height + 1) / 2, NULL};
    l.texels = mem_alloc((size_t)4 * l.width * l.height * sizeof(float));
    for (uint32_t y = 0; y < l.height; y++)
        for (uint32_t x = 0; x < l.width; x++) {
            float *to = l.texels + 4 * ((size_t)y * l.width + x), sum[4] = {0};
            for (uint32_t i = 0; i < 4; i++) {
                const float *from = level_at(fine, 2 * x + (i & 1), 2 * y + (i >> 1));
                for (int c = 0; c < 4; c++) sum[c] += from[c];
            }
            const float scale = sum[3] > 1 ? 1 / sum[3] : 1;
            for (int c = 0; c < 4; c++) to[c] = sum[c] * scale;
        }
    return l;
}

// The mean of the four texels around a finer one's middle, 9 : 3 : 3 : 1, by their weights.
static void smooth_at(const level *coarse, uint32_t x, uint32_t y, float out[4]) {
    const uint32_t near[2] = {x / 2, y / 2};
    const uint32_t far[2] = {x & 1 ? near[0] + 1 : near[0] - (near[0] > 0),
                             y & 1 ? near[1] + 1 : near[1] - (near[1] > 0)};
    memset(out, 0, 4 * sizeof *out);
    for (int i = 0; i < 4; i++) {
        const float *from = level_at(coarse, i & 1 ? far[0] : near[0], i & 2 ? far[1] : near[1]);
        const float part = (i & 1 ? 0.25f : 0.75f) * (i & 2 ? 0.25f : 0.75f);
        for (int c = 0; c < 4; c++) out[c] += part * from[c];
    }
}

// What a pixel lacks of its weight it takes from the coarser level, of whatever weight that is.
static void push(level *fine, const level *coarse) {
    for (uint32_t y = 0; y < fine->height; y++)
        for (uint32_t x = 0; x < fine->width; x++) {
            float *to = fine->texels + 4 * ((size_t)y * fine->width + x);
            float from[4];
            smooth_at(coarse, x, y, from);
            const float lack = from[3] > 0 ? (1 - to[3]) / from[3] : 0;
            for (int c = 0; c < 4; c++) to[c] += lack * from[c];
        }
}

static void fill_cell(sheet *s, uint32_t cell, float least) {
    level levels[MOST_LEVELS] = {{s->width, s->height, NULL}};
    int count = 1;
    bool any = false;
    levels[0].texels = mem_alloc((size_t)4 * s->width * s->height * sizeof(float));
    for (uint32_t y = 0; y < s->height; y++)
        for (uint32_t x = 0; x < s->width; x++) {
            const float *from = sheet_pixel(s, cell, x, y);
            if (!(from[3] > least)) continue;
            float *to = levels[0].texels + 4 * ((size_t)y * s->width + x);
            memcpy(to, from, 3 * sizeof *to);
            to[3] = 1;
            any = true;
        }
    for (; count < MOST_LEVELS && levels[count - 1].width * levels[count - 1].height > 1; count++)
        levels[count] = pull(&levels[count - 1]);
    for (int i = count - 1; i > 0; i--) push(&levels[i - 1], &levels[i]);
    for (uint32_t y = 0; any && y < s->height; y++)
        for (uint32_t x = 0; x < s->width; x++) {
            float *to = sheet_pixel(s, cell, x, y);
            if (!(to[3] > least))
                memcpy(to, levels[0].texels + 4 * ((size_t)y * s->width + x), 3 * sizeof *to);
        }
    for (int i = 0; i < count; i++) mem_free(levels[i].texels);
}

void sheet_fill(sheet *s, float least) {
    for (uint32_t cell = 0; cell < s->columns * s->rows; cell++) fill_cell(s, cell, least);
}
