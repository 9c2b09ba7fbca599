// Laying over and the last pass, pixel by pixel.
#include "pass_test.h"

enum { WIDTH = 62, HEIGHT = 8, PIXELS = WIDTH * HEIGHT };

static const char *const tonemaps[] = {"agx", "aces", "reinhard", "exponential", "none"};

static pass *add_ramp(pass_world *w, const char *label, float r, float g, float b) {
    pass *p = world_add(w, NULL, "ramp.comp", label);
    gpu_test_ok(pass_set_uniform(p, "tint", triple(w, r, g, b)));
    gpu_test_ok(pass_declare(p));
    return p;
}

typedef struct look {
    const char *tonemap;
    float tint[3], exposure, saturation, bloom; // bloom 0: none; its picture is twice as bright
    float subtract;
} look;

// `input`, `shown` and `linear` hold 4 * PIXELS numbers each and may be NULL.
static void show(gpu *device, look l, float *input, float *shown, float *linear) {
    pass_world w;
    world_open(&w, device);
    pass *ramp = add_ramp(&w, "ramp", l.tint[0], l.tint[1], l.tint[2]);
    pass *final = world_add(&w, "final", NULL, "final");
    gpu_test_ok(pass_set_option(final, "tonemap", l.tonemap));
    gpu_test_ok(pass_set_uniform(final, "exposure_ev", number(&w, l.exposure)));
    gpu_test_ok(pass_set_uniform(final, "saturation", number(&w, l.saturation)));
    gpu_test_ok(pass_set_uniform(final, "subtract", number(&w, l.subtract)));
    gpu_test_ok(pass_set_image(final, "source", pass_output(ramp, "color")));
    if (l.bloom > 0) {
        pass *bright = add_ramp(&w, "bright", 2 * l.tint[0], 2 * l.tint[1], 2 * l.tint[2]);
        gpu_test_ok(pass_set_image(final, "bloom", pass_output(bright, "color")));
        gpu_test_ok(pass_set_uniform(final, "bloom_intensity", number(&w, l.bloom)));
    }
    gpu_test_ok(pass_declare(final));
    graph_image images[] = {pass_output(ramp, "color"), pass_output(final, "color"),
                            pass_output(final, "linear")};
    for (int i = 0; i < 2; i++) graph_add_output(w.host.graph, images[i]);
    world_render(&w, WIDTH, HEIGHT, images[2]);
    float *out[] = {input, shown, linear};
    for (int i = 0; i < 3; i++) {
        if (!out[i]) continue;
        float *pixels = world_read(&w, images[i]);
        memcpy(out[i], pixels, 4 * PIXELS * sizeof *pixels);
        mem_free(pixels);
    }
    world_close(&w);
}

static void every_tonemap_rises_from_black_to_white(void **state) {
    static float c[4 * PIXELS];
    for (size_t t = 0; t < COUNT_OF(tonemaps); t++) {
        show(*state, (look){tonemaps[t], {1, 1, 1}, 0, 1, 0, 0}, NULL, c, NULL);
        for (uint32_t x = 0; x < WIDTH; x++) {
            const float *here = c + 4 * x;
            for (int k = 0; k < 3; k++) {
                assert_true(here[k] >= 0 && here[k] <= 1);
                if (x > 0 && here[k] < here[k - 4])
                    fail_msg("%s falls at column %u: %g after %g", tonemaps[t], x, (double)here[k],
                             (double)here[k - 4]);
                if (fabsf(here[k] - here[0]) > 0.002f)
                    fail_msg("%s turns grey into colour at column %u", tonemaps[t], x);
            }
        }
        assert_true(c[0] == 0);
        assert_true(c[4 * (WIDTH / 2)] > c[4 * (WIDTH / 3)]);
        if (!(c[4 * (WIDTH - 1)] > 0.9f))
            fail_msg("%s: 32 is shown as %g", tonemaps[t], (double)c[4 * (WIDTH - 1)]);
    }
}

static void black_stays_black_and_alpha_is_kept(void **state) {
    static float in[4 * PIXELS], c[4 * PIXELS];
    for (size_t t = 0; t < COUNT_OF(tonemaps); t++) {
        show(*state, (look){tonemaps[t], {3, 1, 0.2f}, 2.5f, 1.4f, 0, 0}, in, c, NULL);
        for (uint32_t i = 0; i < PIXELS; i++) {
            assert_true(c[4 * i + 3] == in[4 * i + 3]);
            if (i % WIDTH == 0)
                assert_true(c[4 * i] == 0 && c[4 * i + 1] == 0 && c[4 * i + 2] == 0);
        }
    }
}

static void a_stop_of_exposure_doubles(void **state) {
    static float in[4 * PIXELS], c[4 * PIXELS], linear[4 * PIXELS];
    show(*state, (look){"none", {1, 0.5f, 0.25f}, 1, 1, 0, 0}, in, c, linear);
    for (uint32_t i = 0; i < PIXELS; i++)
        for (uint32_t k = 0; k < 3; k++) {
            float want = fminf(2 * in[4 * i + k], 1);
            assert_true(fabsf(c[4 * i + k] - want) <= want / 1024);
            assert_true(linear[4 * i + k] == in[4 * i + k]); // the EXR's picture is not exposed
        }
}

static void bloom_is_added_with_its_factor(void **state) {
    static float in[4 * PIXELS], c[4 * PIXELS], linear[4 * PIXELS];
    show(*state, (look){"none", {0.01f, 0.02f, 0.03f}, 0, 1, 0.25f, 0}, in, c, linear);
    for (uint32_t i = 0; i < PIXELS; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            float want = in[4 * i + k] * (1 + 0.25f * 2);
            assert_true(fabsf(linear[4 * i + k] - want) <= want / 512 + 1e-6f);
            assert_true(fabsf(c[4 * i + k] - fminf(want, 1)) <= want / 512 + 1e-6f);
        }
        assert_true(c[4 * i + 3] == in[4 * i + 3]);
    }
}

static void saturation_0_is_grey_of_the_same_luminance(void **state) {
    static float in[4 * PIXELS], c[4 * PIXELS];
    show(*state, (look){"none", {0.02f, 0.01f, 0.005f}, 0, 0, 0, 0}, in, c, NULL);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const float *p = in + 4 * i;
        float want = 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
        for (uint32_t k = 0; k < 3; k++)
            assert_true(fabsf(c[4 * i + k] - want) <= want / 512 + 1e-6f);
    }
}

static float as_shown(float v) {
    return v <= 0.0031308f ? 12.92f * v : 1.055f * powf(v, 1 / 2.4f) - 0.055f;
}

static void an_amount_is_subtracted_from_what_is_shown(void **state) {
    static float whole[4 * PIXELS], less[4 * PIXELS], linear[4 * PIXELS];
    const float amounts[] = {0.1f, 0.4f, 1};
    for (size_t t = 0; t < COUNT_OF(tonemaps); t++) {
        for (size_t a = 0; a < COUNT_OF(amounts); a++) {
            look l = {tonemaps[t], {1, 0.5f, 0.25f}, -0.5f, 1.2f, 0, 0};
            static float untouched[4 * PIXELS];
            show(*state, l, NULL, whole, untouched);
            l.subtract = amounts[a];
            show(*state, l, NULL, less, linear);
            for (uint32_t i = 0; i < 4 * PIXELS; i++) {
                float want = whole[i];
                if (i % 4 < 3) {
                    want = fmaxf(as_shown(whole[i]) - amounts[a], 0);
                    assert_true(fabsf(as_shown(less[i]) - want) <= 0.001f);
                } else {
                    assert_true(less[i] == want);
                }
                assert_true(linear[i] == untouched[i]); // the EXR's picture is not what is shown
            }
        }
    }
}

// ---- over -------------------------------------------------------------------------------------

static void over_is_premultiplied_compositing(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *back = add_ramp(&w, "back", 1, 0.5f, 0.25f),
         *front = world_add(&w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(front, "density", block(&w, 1, 0.6f)));
    gpu_test_ok(pass_set_field(front, "radiance", triple(&w, 0.2f, 0.4f, 3)));
    gpu_test_ok(pass_declare(front));
    pass *over = world_add(&w, "over", NULL, "over");
    gpu_test_ok(pass_set_image(over, "volume", pass_output(front, "color")));
    gpu_test_ok(pass_set_image(over, "source", pass_output(back, "color")));
    gpu_test_ok(pass_declare(over));
    graph_add_output(w.host.graph, pass_output(front, "color"));
    graph_add_output(w.host.graph, pass_output(back, "color"));
    world_render(&w, WIDTH, HEIGHT, pass_output(over, "color"));
    float *f = world_read(&w, pass_output(front, "color"));
    float *b = world_read(&w, pass_output(back, "color"));
    float *c = world_read(&w, pass_output(over, "color"));
    size_t covered = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        covered += f[4 * i + 3] > 0.1f;
        for (uint32_t k = 0; k < 4; k++) {
            float want = f[4 * i + k] + (1 - f[4 * i + 3]) * b[4 * i + k];
            assert_true(fabsf(c[4 * i + k] - want) <= want / 1024 + 1e-6f);
        }
    }
    assert_true(covered > 0 && covered < PIXELS);
    mem_free(f);
    mem_free(b);
    mem_free(c);
    world_close(&w);
}

// However coarse the volume, an even one covers evenly.
static void coarse_volume_keeps_its_level(void **state) {
    const float scales[] = {0.5f, 0.25f, 0.3f};
    for (size_t s = 0; s < COUNT_OF(scales); s++) {
        pass_world w;
        world_open(&w, *state);
        w.scene.camera.eye = triple(&w, 0, 0, 0); // inside: the volume is everywhere
        w.scene.camera.target = triple(&w, 0, 1, 0);
        pass *back = add_ramp(&w, "back", 0, 0, 0), *front = world_add(&w, "march", NULL, "march");
        gpu_test_ok(pass_set_field(front, "density", block(&w, 1, 1000)));
        gpu_test_ok(pass_set_field(front, "radiance", triple(&w, 1, 0.5f, 0.25f)));
        gpu_test_ok(pass_set_uniform(front, "early_exit", number(&w, 0)));
        gpu_test_ok(pass_set_scale(front, scales[s]));
        gpu_test_ok(pass_declare(front));
        pass *over = world_add(&w, "over", NULL, "over");
        gpu_test_ok(pass_set_image(over, "volume", pass_output(front, "color")));
        gpu_test_ok(pass_set_image(over, "source", pass_output(back, "color")));
        gpu_test_ok(pass_declare(over));
        world_render(&w, WIDTH, HEIGHT, pass_output(over, "color"));
        float *c = world_read(&w, pass_output(over, "color"));
        for (uint32_t i = 0; i < PIXELS; i++) {
            assert_true(fabsf(c[4 * i] - 1) < 0.002f && fabsf(c[4 * i + 2] - 0.25f) < 0.001f);
            assert_true(fabsf(c[4 * i + 3] - 1) < 0.002f);
        }
        mem_free(c);
        world_close(&w);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_tonemap_rises_from_black_to_white),
        cmocka_unit_test(black_stays_black_and_alpha_is_kept),
        cmocka_unit_test(a_stop_of_exposure_doubles),
        cmocka_unit_test(bloom_is_added_with_its_factor),
        cmocka_unit_test(saturation_0_is_grey_of_the_same_luminance),
        cmocka_unit_test(an_amount_is_subtracted_from_what_is_shown),
        cmocka_unit_test(over_is_premultiplied_compositing),
        cmocka_unit_test(coarse_volume_keeps_its_level),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
