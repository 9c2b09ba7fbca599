// Figures of pictures that are known: by hand, or by evaluating the papers' filters directly in two
// dimensions and double precision.
#include "media_test.h"

#include "media/compare.h"
#include <math.h>

enum { WIDTH = 24, HEIGHT = 17, COUNT = WIDTH * HEIGHT };

typedef float pixels[COUNT * 3];

static compare_picture picture(const float *rgb) {
    return (compare_picture){WIDTH, HEIGHT, rgb};
}

static void fill(pixels out, float value) {
    for (size_t i = 0; i < COUNT * 3; i++) out[i] = value;
}

// A pattern without symmetry; to the right of the middle another one where it is `changed`.
static void pattern(pixels out, bool changed) {
    for (unsigned y = 0; y < HEIGHT; y++)
        for (unsigned x = 0; x < WIDTH; x++, out += 3) {
            bool other = changed && x >= 12;
            float red = (float)((x * 37 + y * 11) % 64) / 63, blue = (float)(x * y % 16) / 15;
            out[0] = other ? red * 0.75f : red;
            out[1] = (float)((x * 5 + y * 23) % 32) / 31;
            out[2] = other ? 1 - blue : blue;
        }
}

static double flip(const float *a, const float *b, double ppd) {
    float map[COUNT];
    compare_picture left = picture(a), right = picture(b);
    double mean = compare_flip(&left, &right, ppd, map), sum = 0;
    for (size_t i = 0; i < COUNT; i++) {
        assert_true(map[i] >= 0 && map[i] <= 1);
        sum += (double)map[i];
    }
    assert_true(fabs(sum / COUNT - mean) < 1e-6);
    return mean;
}

static double ssim(const float *a, const float *b) {
    compare_picture left = picture(a), right = picture(b);
    return compare_ssim(&left, &right);
}

static double psnr(const float *a, const float *b) {
    compare_picture left = picture(a), right = picture(b);
    return compare_psnr(&left, &right);
}

static void assert_near(double got, double wanted, double tolerance) {
    if (!(fabs(got - wanted) <= tolerance)) fail_msg("%.9f is not %.9f", got, wanted);
}

static void equal_pictures_do_not_differ(void **state) {
    (void)state;
    pixels a;
    pattern(a, false);
    assert_true(isinf(psnr(a, a)) && psnr(a, a) > 0);
    assert_near(ssim(a, a), 1, 1e-9);
    assert_near(flip(a, a, 67), 0, 0);
}

static void an_offset_has_the_psnr_of_its_square(void **state) {
    (void)state;
    pixels a, b;
    fill(a, 0.5f);
    fill(b, 0.6f);
    assert_near(psnr(a, b), 20, 1e-4);
    fill(b, 0.51f);
    assert_near(psnr(a, b), 40, 1e-3);
    for (size_t i = 0; i < COUNT; i++) b[i * 3] = b[i * 3 + 1] = 0.5f; // one channel of three
    assert_near(psnr(a, b), 40 + 10 * log10(3), 1e-3);
}

static void flat_pictures_have_the_ssim_of_their_means(void **state) {
    (void)state;
    pixels a, b;
    fill(a, 0.2f);
    fill(b, 0.8f);
    assert_near(ssim(a, b), (2 * 0.2 * 0.8 + 1e-4) / (0.04 + 0.64 + 1e-4), 1e-4);
}

static void an_inverted_picture_is_not_similar(void **state) {
    (void)state;
    pixels a, b;
    pattern(a, false);
    for (size_t i = 0; i < COUNT * 3; i++) b[i] = 1 - a[i];
    assert_true(ssim(a, b) < -0.5);
}

static void patterns_have_the_figures_of_the_papers_filters(void **state) {
    (void)state;
    pixels a, b;
    pattern(a, false);
    pattern(b, true);
    assert_near(psnr(a, b), 10.906446, 1e-4);
    assert_near(ssim(a, b), 0.963000, 1e-5);
    assert_near(flip(a, b, 67), 0.309487, 1e-5);
    assert_near(flip(a, b, 20), 0.339197, 1e-5);
}

static void black_and_white_have_the_flip_of_their_lightness(void **state) {
    (void)state;
    pixels a, b;
    fill(a, 0);
    fill(b, 1);
    assert_near(flip(a, b, 67), 0.967380, 1e-5);
}

static void flip_is_symmetric_and_grows_with_the_change(void **state) {
    (void)state;
    pixels a, b, c;
    pattern(a, false);
    pattern(c, true);
    for (size_t i = 0; i < COUNT * 3; i++) b[i] = 0.5f * (a[i] + c[i]);
    assert_near(flip(a, c, 67), flip(c, a, 67), 1e-9);
    assert_true(flip(a, b, 67) > 0.01);
    assert_true(flip(a, c, 67) > 1.2 * flip(a, b, 67));
}

static void pictures_may_be_smaller_than_a_filter(void **state) {
    (void)state;
    const float dark[3] = {0.2f, 0.2f, 0.2f}, light[3] = {0.8f, 0.8f, 0.8f};
    compare_picture a = {1, 1, dark}, b = {1, 1, light};
    float map[1];
    assert_near(compare_ssim(&a, &b), (2 * 0.2 * 0.8 + 1e-4) / (0.04 + 0.64 + 1e-4), 1e-4);
    assert_near(compare_flip(&a, &b, 1000, map), compare_flip(&a, &b, 1, map), 1e-5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures_do_not_differ),
        cmocka_unit_test(an_offset_has_the_psnr_of_its_square),
        cmocka_unit_test(flat_pictures_have_the_ssim_of_their_means),
        cmocka_unit_test(an_inverted_picture_is_not_similar),
        cmocka_unit_test(patterns_have_the_figures_of_the_papers_filters),
        cmocka_unit_test(black_and_white_have_the_flip_of_their_lightness),
        cmocka_unit_test(flip_is_symmetric_and_grows_with_the_change),
        cmocka_unit_test(pictures_may_be_smaller_than_a_filter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
