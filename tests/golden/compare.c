// Compares a picture with the golden one. When they differ, writes expected, actual and their
// difference times 8 side by side, names that file, and ends with status 1.
//
//   golden_compare EXPECTED.png ACTUAL.png DIFFERENCE.png
//
// Drivers differ: texture units interpolate with as few as 8 bits of fraction, exp, pow and sin in
// their last digits; an edge of a mesh covers another pixel. So two numbers are limited, both in
// 8-bit codes (0..255) over R, G, B. Between llvmpipe, which made the golden pictures, and an
// NVIDIA H200 they were at most 0.005 and 0.95.
//
// - The mean over the picture, to 0.05: ten times that, and half of what taking every other step of
//   the march changes, which nobody sees.
// - The mean over the worst block of 8 x 8 pixels, to 4: one of its 64 pixels may be as wrong as
//   black and white, which is an edge; a light, an object or a wisp of smoke that is missing fills
//   more of it.
#include "base/error.h"
#include "base/memory.h"
#include "media/png.h"
#include <stdio.h>
#include <stdlib.h>

enum { BLOCK = 8, AMPLIFY = 8 };

static const double MEAN_LIMIT = 0.05, BLOCK_LIMIT = 4;

static uint8_t pixel(const png_image *image, uint32_t x, uint32_t y, uint32_t channel) {
    return ((const uint8_t *)image->pixels)[((size_t)y * image->width + x) * 4 + channel];
}

// Sum of the differences in a block, cut at the border of the picture.
static uint64_t block_sum(const png_image *a, const png_image *b, uint32_t x0, uint32_t y0) {
    uint64_t sum = 0;
    for (uint32_t y = y0; y < y0 + BLOCK && y < a->height; y++)
        for (uint32_t x = x0; x < x0 + BLOCK && x < a->width; x++)
            for (uint32_t c = 0; c < 3; c++)
                sum += (uint64_t)abs(pixel(a, x, y, c) - pixel(b, x, y, c));
    return sum;
}

typedef struct difference {
    double mean, block; // codes
    uint32_t x, y;      // the worst block
} difference;

// Blocks at the border count as whole ones: what lies outside is equal.
static difference compare(const png_image *a, const png_image *b) {
    difference d = {0};
    uint64_t all = 0, worst = 0;
    for (uint32_t y = 0; y < a->height; y += BLOCK)
        for (uint32_t x = 0; x < a->width; x += BLOCK) {
            uint64_t sum = block_sum(a, b, x, y);
            all += sum;
            if (sum <= worst) continue;
            worst = sum;
            d.x = x;
            d.y = y;
        }
    d.mean = (double)all / (3.0 * a->width * a->height);
    d.block = (double)worst / (3.0 * BLOCK * BLOCK);
    return d;
}

static bool write_difference(const char *path, const png_image *a, const png_image *b) {
    uint32_t width = a->width;
    uint8_t *pixels = mem_alloc((size_t)width * 3 * a->height * 3), *out = pixels;
    for (uint32_t y = 0; y < a->height; y++)
        for (uint32_t x = 0; x < width * 3; x++)
            for (uint32_t c = 0; c < 3; c++) {
                int expected = pixel(a, x % width, y, c), actual = pixel(b, x % width, y, c);
                int amplified = abs(expected - actual) * AMPLIFY;
                if (amplified > 255) amplified = 255;
                *out++ = (uint8_t)(x < width ? expected : x < 2 * width ? actual : amplified);
            }
    bool done = png_write(
        path,
        &(png_image){
            .width = width * 3, .height = a->height, .channels = 3, .bits = 8, .pixels = pixels},
        NULL, 0);
    mem_free(pixels);
    return done;
}

int main(int argc, char **argv) {
    if (argc != 4) {
        fprintf(stderr, "usage: %s EXPECTED.png ACTUAL.png DIFFERENCE.png\n", argv[0]);
        return 2;
    }
    arena memory = {0};
    png_image expected, actual;
    int status = 1;
    if (!png_read(argv[1], NULL, &memory, &expected) ||
        !png_read(argv[2], NULL, &memory, &actual)) {
        fprintf(stderr, "%s\n", err_get());
    } else if (expected.width != actual.width || expected.height != actual.height ||
               expected.bits != 8 || actual.bits != 8) {
        fprintf(stderr, "%s: %u x %u, %d bits; expected: %u x %u, 8 bits\n", argv[2], actual.width,
                actual.height, actual.bits, expected.width, expected.height);
    } else {
        difference d = compare(&expected, &actual);
        printf("mean %.3f (limit %g), worst block %.2f (limit %g) at %u, %u\n", d.mean, MEAN_LIMIT,
               d.block, BLOCK_LIMIT, d.x, d.y);
        status = d.mean <= MEAN_LIMIT && d.block <= BLOCK_LIMIT ? 0 : 1;
        if (status && write_difference(argv[3], &expected, &actual))
            printf("expected, actual and difference x %d: %s\n", AMPLIFY, argv[3]);
        else if (status)
            fprintf(stderr, "%s\n", err_get());
    }
    arena_free(&memory);
    return status;
}
