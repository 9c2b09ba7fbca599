// Bloom of one size, and the chain that is published with it, against a computation on the host:
// what is bright, a separable blur, what of it is added, exposure and saturation.
#include "pass_test.h"

enum { WIDTH = 62, HEIGHT = 20, PIXELS = WIDTH * HEIGHT };

typedef struct rgb {
    double c[3];
} rgb;

static double luminance(const rgb *v) {
    return 0.2126 * v->c[0] + 0.7152 * v->c[1] + 0.0722 * v->c[2];
}

static void take(const float *pixels, rgb out[PIXELS]) {
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) out[i].c[k] = (double)pixels[4 * i + k];
}

static void extract(rgb v[PIXELS], double threshold, double intensity) {
    for (int i = 0; i < PIXELS; i++) {
        double factor = luminance(&v[i]) > threshold ? intensity : 0;
        for (int k = 0; k < 3; k++) v[i].c[k] *= factor;
    }
}

static int within(int i, int count) {
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

static void blur(const rgb in[PIXELS], rgb out[PIXELS], int across, int down) {
    static const double weights[] = {0.227027, 0.1945946, 0.1216216, 0.054054, 0.016216};
    for (int i = 0; i < PIXELS; i++) {
        out[i] = (rgb){0};
        for (int t = -4; t <= 4; t++) {
            int x = within(i % WIDTH + t * across, WIDTH);
            int y = within(i / WIDTH + t * down, HEIGHT);
            for (int k = 0; k < 3; k++) out[i].c[k] += weights[abs(t)] * in[y * WIDTH + x].c[k];
        }
    }
}

static void blur_all(rgb v[PIXELS], int passes, int spread) {
    static rgb across[PIXELS];
    for (int i = 0; i < passes; i++) {
        blur(v, across, spread, 0);
        blur(across, v, 0, spread);
    }
}

static void compare(const float *got, const rgb want[PIXELS], double tolerance) {
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            double g = (double)got[4 * i + k], w = want[i].c[k];
            if (!(fabs(g - w) <= tolerance * (fabs(w) + 0.01)))
                fail_msg("pixel %d, %d, channel %d: %g, not %g", i % WIDTH, i / WIDTH, k, g, w);
        }
}

static pass *add_ramp(pass_world *w) {
    pass *p = world_add(w, NULL, "ramp.comp", "ramp");
    gpu_test_ok(pass_set_uniform(p, "tint", triple(w, 1, 0.6f, 0.2f)));
    gpu_test_ok(pass_declare(p));
    return p;
}

static pass *add_bright(pass_world *w, pass *picture, float threshold, float intensity) {
    pass *p = world_add(w, "bright", NULL, "bright");
    gpu_test_ok(pass_set_option(p, "mode", "paper"));
    gpu_test_ok(pass_set_uniform(p, "threshold", number(w, threshold)));
    gpu_test_ok(pass_set_uniform(p, "intensity", number(w, intensity)));
    gpu_test_ok(pass_set_image(p, "source", pass_output(picture, "color")));
    gpu_test_ok(pass_declare(p));
    return p;
}

static pass *add_bloom(pass_world *w, pass *bright, float passes, float spread) {
    pass *p = world_add(w, "bloom", NULL, "bloom");
    gpu_test_ok(pass_set_option(p, "mode", "gaussian"));
    gpu_test_ok(pass_set_uniform(p, "passes", number(w, passes)));
    gpu_test_ok(pass_set_uniform(p, "spread", number(w, spread)));
    gpu_test_ok(pass_set_image(p, "source", pass_output(bright, "color")));
    gpu_test_ok(pass_declare(p));
    return p;
}

// With `seen`, somebody else looks at the bright picture, so that it is a pass of its own.
static void blurs_as_published(void **state, int passes, int spread, bool seen) {
    static rgb want[PIXELS];
    pass_world w;
    world_open(&w, *state);
    pass *picture = add_ramp(&w), *bright = add_bright(&w, picture, 0.5f, 1.5f);
    pass *bloom = add_bloom(&w, bright, (float)passes, (float)spread);
    graph_add_output(w.host.graph, pass_output(picture, "color"));
    if (seen) graph_add_output(w.host.graph, pass_output(bright, "color"));
    world_render(&w, WIDTH, HEIGHT, pass_output(bloom, "color"));
    float *in = world_read(&w, pass_output(picture, "color"));
    float *got = world_read(&w, pass_output(bloom, "color"));
    take(in, want);
    extract(want, 0.5, 1.5);
    blur_all(want, passes, spread);
    compare(got, want, 2e-3 * (1 + passes));
    mem_free(in);
    mem_free(got);
    world_close(&w);
}

static void one_pass_is_nine_taps_each_way(void **state) {
    blurs_as_published(state, 1, 1, false);
}

static void five_passes_and_wide_taps(void **state) {
    blurs_as_published(state, 5, 1, true);
    blurs_as_published(state, 2, 3, false);
}

static void the_published_chain(void **state) {
    static rgb picture_of[PIXELS], halo[PIXELS], want[PIXELS], linear[PIXELS];
    pass_world w;
    world_open(&w, *state);
    pass *picture = add_ramp(&w), *bright = add_bright(&w, picture, 0.3f, 2);
    pass *bloom = add_bloom(&w, bright, 5, 1), *final = world_add(&w, "final", NULL, "final");
    gpu_test_ok(pass_set_image(final, "source", pass_output(picture, "color")));
    gpu_test_ok(pass_set_image(final, "bloom", pass_output(bloom, "color")));
    gpu_test_ok(pass_set_option(final, "bloom_mix", "luminance"));
    gpu_test_ok(pass_set_option(final, "tonemap", "none"));
    gpu_test_ok(pass_set_uniform(final, "bloom_intensity", number(&w, 1)));
    gpu_test_ok(pass_set_uniform(final, "saturation", number(&w, 0.9f)));
    gpu_test_ok(pass_set_uniform(final, "exposure_ev", number(&w, log2f(0.7f))));
    gpu_test_ok(pass_declare(final));
    graph_add_output(w.host.graph, pass_output(picture, "color"));
    graph_add_output(w.host.graph, pass_output(final, "linear"));
    world_render(&w, WIDTH, HEIGHT, pass_output(final, "color"));
    float *in = world_read(&w, pass_output(picture, "color"));
    float *got = world_read(&w, pass_output(final, "color"));
    float *got_linear = world_read(&w, pass_output(final, "linear"));
    take(in, picture_of);
    take(in, halo);
    extract(halo, 0.3, 2);
    blur_all(halo, 5, 1);
    for (int i = 0; i < PIXELS; i++) {
        double kept = fmax(1 - 0.5 * luminance(&picture_of[i]), 0);
        rgb sum;
        for (int k = 0; k < 3; k++) sum.c[k] = picture_of[i].c[k] + kept * halo[i].c[k];
        linear[i] = sum;
        double grey = 0.7 * luminance(&sum);
        for (int k = 0; k < 3; k++) want[i].c[k] = fmin(grey + 0.9 * (0.7 * sum.c[k] - grey), 1);
    }
    compare(got_linear, linear, 0.01);
    compare(got, want, 0.01);
    mem_free(in);
    mem_free(got);
    mem_free(got_linear);
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_pass_is_nine_taps_each_way),
        cmocka_unit_test(five_passes_and_wide_taps),
        cmocka_unit_test(the_published_chain),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
