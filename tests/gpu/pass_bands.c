// Flat bands of what shines or hides: how many, which, and where nothing is.
#include "pass_test.h"

enum { WIDTH = 62, HEIGHT = 8, PIXELS = WIDTH * HEIGHT };

typedef struct look {
    const char *of;
    float levels, low, high, curve, soften;
} look;

// What is banded, and the bands with their place as their colour.
static void draw(gpu *device, look l, float *in, float *out) {
    pass_world w;
    world_open(&w, device);
    pass *ramp = world_add(&w, NULL, "ramp.comp", "ramp");
    gpu_test_ok(pass_declare(ramp));
    pass *bands = world_add(&w, "bands", NULL, "bands");
    gpu_test_ok(pass_set_image(bands, "source", pass_output(ramp, "color")));
    gpu_test_ok(pass_set_option(bands, "of", l.of));
    const char *const names[] = {"levels", "low", "high", "curve", "soften"};
    const float values[] = {l.levels, l.low, l.high, l.curve, l.soften};
    for (size_t i = 0; i < COUNT_OF(names); i++)
        gpu_test_ok(pass_set_uniform(bands, names[i], number(&w, values[i])));
    gpu_test_ok(pass_set_field(bands, "color", field_make(&w.memory, "position", NULL, NULL)));
    gpu_test_ok(pass_set_field(bands, "opacity", number(&w, 0.5f)));
    gpu_test_ok(pass_declare(bands));
    graph_add_output(w.host.graph, pass_output(ramp, "color"));
    world_render(&w, WIDTH, HEIGHT, pass_output(bands, "image"));
    graph_image images[] = {pass_output(ramp, "color"), pass_output(bands, "image")};
    float *const to[] = {in, out};
    for (int i = 0; i < 2; i++) {
        float *pixels = world_read(&w, images[i]);
        memcpy(to[i], pixels, 4 * PIXELS * sizeof *pixels);
        mem_free(pixels);
    }
    world_close(&w);
}

static void sharp_bands_are_those_of_the_formula(void **state) {
    static const look looks[] = {{"light", 5, 0.01f, 8, 3, 0}, {"opacity", 3, 0.2f, 0.9f, 1, 0}};
    static float in[4 * PIXELS], out[4 * PIXELS];
    for (size_t k = 0; k < COUNT_OF(looks); k++) {
        const look *l = &looks[k];
        bool seen[8] = {false};
        draw(*state, *l, in, out);
        for (int i = 0; i < PIXELS; i++) {
            const float *p = out + 4 * i;
            float value = l->of[0] == 'l' ? in[4 * i] : in[4 * i + 3];
            float share = (value - l->low) / (l->high - l->low);
            if (share < 0) {
                assert_true(p[0] == 0 && p[3] == 0);
                continue;
            }
            int band = (int)(p[1] / 0.5f * (l->levels - 1) + 0.5f); // by its own word
            float from = powf((float)band / l->levels, l->curve);
            float to = powf((float)(band + 1) / l->levels, l->curve);
            assert_true(band >= 0 && band < (int)l->levels);
            assert_true(share >= from - 1e-3f && (share <= to + 1e-3f || band == l->levels - 1));
            assert_true(fabsf(p[0] - 0.5f * ((float)band + 0.5f) / l->levels) < 1e-3f);
            assert_true(p[2] == 0 && fabsf(p[3] - 0.5f) < 1e-3f);
            seen[band] = true;
        }
        for (int b = 0; b < (int)l->levels; b++) assert_true(seen[b]);
    }
}

// Between two bands lies a step of at most a pixel and what is left over of one.
static void soft_edges_go_over_from_band_to_band(void **state) {
    static float in[4 * PIXELS], sharp[4 * PIXELS], soft[4 * PIXELS];
    look l = {"light", 4, 0.01f, 8, 4, 0};
    draw(*state, l, in, sharp);
    l.soften = 1;
    draw(*state, l, in, soft);
    int between = 0;
    for (int x = 2; x < WIDTH - 2; x++) {
        const float *a = sharp + 4 * x, *b = soft + 4 * x;
        bool inside = a[-4] == a[0] && a[0] == a[4];
        if (inside && fabsf(a[0] - b[0]) > 2e-3f)
            fail_msg("column %d is inside a band of %g, but %g", x, (double)a[0], (double)b[0]);
        between += fabsf(a[0] - b[0]) > 2e-3f;
        assert_true(b[4] >= b[0] - 1e-3f);
    }
    assert_true(between >= 3);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(sharp_bands_are_those_of_the_formula),
        cmocka_unit_test(soft_edges_go_over_from_band_to_band),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
