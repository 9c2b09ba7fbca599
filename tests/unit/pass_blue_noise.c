// The texture of blue noise: its histogram, and its spectra in space and in time.
#include "base/memory.h"
#include "pass/blue_noise.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h> // wants the headers above

enum { SIZE = BLUE_NOISE_SIZE, FRAMES = BLUE_NOISE_FRAMES, SLICE = SIZE * SIZE };

typedef struct number { // complex
    double re, im;
} number;

// The transform of `count` numbers, `stride` apart, in place.
static void transform(number *at, int count, int stride) {
    number out[SIZE] = {{0, 0}};
    for (int k = 0; k < count; k++)
        for (int i = 0; i < count; i++) {
            double turn = -2 * 3.14159265358979 * (k * i % count) / count;
            double c = cos(turn), s = sin(turn);
            out[k].re += c * at[i * stride].re - s * at[i * stride].im;
            out[k].im += s * at[i * stride].re + c * at[i * stride].im;
        }
    for (int k = 0; k < count; k++) at[k * stride] = out[k];
}

static double value(int texel) {
    return (blue_noise_texels[texel] + 0.5) / 256 - 0.5;
}

static double power(number n) {
    return n.re * n.re + n.im * n.im;
}

// Signed frequency in cycles a texel.
static double frequency(int k) {
    return (double)(k < SIZE / 2 ? k : k - SIZE) / SIZE;
}

// Mean power, over that of white noise of the same values, of the frequencies in each band (cycles
// a texel, above edges[b] up to edges[b + 1]) of one slice.
static void slice_power(int slice, const double edges[], int bands, double out[]) {
    static number plane[SLICE];
    int count[8] = {0};
    for (int i = 0; i < SLICE; i++) plane[i] = (number){value(slice * SLICE + i), 0};
    for (int i = 0; i < SIZE; i++) transform(plane + i * SIZE, SIZE, 1);
    for (int i = 0; i < SIZE; i++) transform(plane + i, SIZE, SIZE);
    memset(out, 0, (size_t)bands * sizeof *out);
    for (int i = 1; i < SLICE; i++) {
        double f = hypot(frequency(i % SIZE), frequency(i / SIZE));
        for (int b = 0; b < bands; b++) {
            if (!(f > edges[b] && f <= edges[b + 1])) continue;
            out[b] += power(plane[i]) * 12 / SLICE; // uniform noise varies by 1/12
            count[b]++;
        }
    }
    for (int b = 0; b < bands; b++) out[b] /= count[b];
}

static void every_slice_holds_each_value_equally_often(void **state) {
    (void)state;
    for (int slice = 0; slice < FRAMES; slice++) {
        int count[256] = {0};
        for (int i = 0; i < SLICE; i++) count[blue_noise_texels[slice * SLICE + i]]++;
        for (int v = 0; v < 256; v++) assert_int_equal(count[v], SLICE / 256);
    }
}

static void every_slice_is_blue(void **state) {
    (void)state;
    const double edges[] = {0, 0.1, 0.2, 0.35, 0.5};
    for (int slice = 0; slice < FRAMES; slice++) {
        double bands[4];
        slice_power(slice, edges, 4, bands);
        assert_true(bands[0] < 0.005);
        assert_true(bands[1] < 0.05);
        assert_true(bands[2] > 0.5);
        assert_true(bands[3] > 1);
    }
}

// The mean over all texels of the power of each one's sequence.
static void every_texel_is_blue_in_time(void **state) {
    (void)state;
    double sum[FRAMES] = {0};
    for (int texel = 0; texel < SLICE; texel++) {
        number series[FRAMES];
        for (int i = 0; i < FRAMES; i++) series[i] = (number){value(i * SLICE + texel), 0};
        transform(series, FRAMES, 1);
        for (int i = 0; i < FRAMES; i++) sum[i] += power(series[i]) * 12 / FRAMES / SLICE;
    }
    for (int i = 0; i <= 4; i++) assert_true(sum[i] < 0.2); // up to an eighth of a cycle a frame
    for (int i = 8; i <= FRAMES / 2; i++) assert_true(sum[i] > 1);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_slice_holds_each_value_equally_often),
        cmocka_unit_test(every_slice_is_blue),
        cmocka_unit_test(every_texel_is_blue_in_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
