// Pictures of templates as tiles.
#include "base/arena.h"
#include "base/memory.h"
#include "pass/templates.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { TEXELS = TEMPLATE_TILE * TEMPLATE_TILE };

static float tile[4 * TEXELS];

static const float *texel(int x, int y) { // rows from the top
    return tile + 4 * (y * TEMPLATE_TILE + x);
}

// `alpha` below 1 stands for a picture that has its own.
static picture even(float *rgba, uint32_t side, int bits, float value, float alpha) {
    for (uint32_t i = 0; i < side * side; i++) {
        for (int c = 0; c < 3; c++) rgba[4 * i + (uint32_t)c] = value;
        rgba[4 * i + 3] = alpha;
    }
    return (picture){side, side, bits, rgba};
}

static void values_are_times_alpha_whatever_the_size(void **state) {
    (void)state;
    static const uint32_t sides[] = {1, 5, 64, 200};
    static float rgba[4 * 200 * 200];
    for (size_t k = 0; k < COUNT_OF(sides); k++) {
        picture p = even(rgba, sides[k], 0, -2, 0.5f);
        template_tile(&p, tile);
        for (int i = 0; i < TEXELS; i++) {
            assert_true(fabsf(tile[4 * i + 2] + 1) < 1e-5f);
            assert_true(fabsf(tile[4 * i + 3] - 0.5f) < 1e-5f);
        }
    }
}

static void png_has_its_nothing_at_128(void **state) {
    (void)state;
    static const struct {
        int bits;
        float value, expected;
    } rows[] = {{8, 128.0f / 255, 0},      {8, 1, 1},  {8, 1.0f / 255, -1},
                {16, 32768.0f / 65535, 0}, {16, 1, 1}, {0, 0.5f, 0.5f}};
    float rgba[4];
    for (size_t k = 0; k < COUNT_OF(rows); k++) {
        picture p = even(rgba, 1, rows[k].bits, rows[k].value, 0.5f);
        template_tile(&p, tile);
        assert_true(fabsf(2 * texel(30, 30)[0] - rows[k].expected) < 1e-5f);
    }
}

static void without_alpha_the_border_fades(void **state) {
    (void)state;
    float rgba[4 * 9];
    picture p = even(rgba, 3, 0, 1, 1);
    template_tile(&p, tile);
    assert_true(texel(32, 32)[3] > 0.997f);
    assert_true(texel(0, 32)[3] < 0.005f && texel(0, 32)[3] > 0.003f);
    assert_true(texel(0, 0)[3] < 3e-5f);
    assert_true(fabsf(texel(20, 40)[3] - texel(43, 23)[3]) < 1e-6f); // the same all around
    assert_true(texel(20, 40)[0] == texel(20, 40)[3]);
}

// A step from 0 to 1 in the middle of a large picture stays there, and as sharp as a tile can show.
static void large_pictures_keep_their_edges_and_means(void **state) {
    (void)state;
    enum { SIDE = 256 };
    static float rgba[4 * SIDE * SIDE];
    picture p = even(rgba, SIDE, 0, 0, 0.5f);
    for (int y = 0; y < SIDE; y++)
        for (int x = SIDE / 2; x < SIDE; x++) rgba[4 * (y * SIDE + x)] = 1;
    template_tile(&p, tile);
    double sum = 0;
    for (int i = 0; i < TEXELS; i++) sum += (double)tile[4 * i] / TEXELS;
    assert_true(fabs(sum - 0.25) < 1e-5);
    assert_true(fabsf(texel(30, 9)[0]) < 1e-6f && fabsf(texel(33, 9)[0] - 0.5f) < 1e-6f);
}

static void levels_are_means(void **state) {
    (void)state;
    static const float from[4 * 16] = {
        1, 2, 3, 4, 3, 2, 1, 0, [16] = 4, 4, 4, 4, [20] = 8, 8, 8, 8};
    float half[4 * 4];
    template_tile_half(from, 4, half);
    assert_true(half[0] == 4 && half[1] == 4 && half[2] == 4 && half[3] == 4);
    assert_true(half[4] == 0 && half[15] == 0);
}

static void what_is_beyond_halves_stays_finite(void **state) {
    (void)state;
    float rgba[4];
    picture p = even(rgba, 1, 0, -1e30f, 0.99f);
    template_tile(&p, tile);
    assert_true(texel(32, 32)[0] >= -65504 && texel(32, 32)[0] < -1e4f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_times_alpha_whatever_the_size),
        cmocka_unit_test(png_has_its_nothing_at_128),
        cmocka_unit_test(without_alpha_the_border_fades),
        cmocka_unit_test(large_pictures_keep_their_edges_and_means),
        cmocka_unit_test(levels_are_means),
        cmocka_unit_test(what_is_beyond_halves_stays_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
