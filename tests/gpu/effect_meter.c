// Automatic exposure: even pictures and ramps of which the mean is known, adaptation, and that the
// last pass exposes by it.
#include "effect_test.h"

enum { WIDTH = 62, HEIGHT = 8, FPS = 10 };

typedef struct stage {
    effect *e;
    pass *source, *meter, *shown;
} stage;

static stage open_stage(gpu *device, const char *shader) {
    effect *e = open_effect(&(effect_desc){.device = device});
    gpu_test_ok(effect_set_timeline(e, FPS, 1000, 1));
    return (stage){e, add(e, NULL, shader), add(e, "meter", NULL), add(e, "final", NULL)};
}

static void build(stage *s) {
    gpu_test_ok(pass_declare(s->source));
    gpu_test_ok(pass_set_image(s->meter, "source", pass_output(s->source, "color")));
    gpu_test_ok(pass_declare(s->meter));
    gpu_test_ok(pass_set_option(s->shown, "tonemap", "none"));
    gpu_test_ok(pass_set_image(s->shown, "source", pass_output(s->source, "color")));
    gpu_test_ok(pass_set_image(s->shown, "exposure", pass_output(s->meter, "exposure")));
    gpu_test_ok(pass_declare(s->shown));
    graph_add_output(effect_graph(s->e), pass_output(s->meter, "exposure"));
    gpu_test_ok(effect_set_picture(s->e, EFFECT_OUTPUT, pass_output(s->shown, "color")));
    gpu_test_ok(effect_build(s->e, WIDTH, HEIGHT));
}

static double stops(const stage *s, int frame) {
    gpu_test_ok(effect_render(s->e, frame, false));
    gpu_image *image = graph_get_image(effect_graph(s->e), pass_output(s->meter, "exposure"));
    float value[2];
    gpu_test_ok(gpu_image_read(effect_pass_host(s->e)->device, image, value, sizeof value));
    return (double)value[0];
}

static void expect(double got, double want, const char *what) {
    if (!(fabs(got - want) < 0.002)) fail_msg("%s: %g stops, not %g", what, got, want);
}

static void even_picture_becomes_the_key(void **state) {
    const float tints[][3] = {{1, 1, 1},          {0.18f, 0.18f, 0.18f}, {0.01f, 0.02f, 0.005f},
                              {40, 10, 3},        {0.9f, 0, 0},          {0, 0, 31},
                              {0.003f, 0, 0.003f}};
    for (size_t i = 0; i < COUNT_OF(tints); i++) {
        const float *t = tints[i];
        stage s = open_stage(*state, "even.comp");
        gpu_test_ok(pass_set_uniform(s.source, "tint", triple(s.e, t[0], t[1], t[2])));
        build(&s);
        double l = 0.2126 * (double)t[0] + 0.7152 * (double)t[1] + 0.0722 * (double)t[2];
        expect(stops(&s, 1), log2(0.18 / l), "even");
        float *pixels = read_picture(s.e);
        for (int k = 0; k < 3; k++) { // the last pass exposes by it
            double want = fmin((double)t[k] * 0.18 / l, 1);
            assert_true(fabs((double)pixels[k] - want) < 0.003 * want + 1e-4);
        }
        mem_free(pixels);
        effect_destroy(s.e);
    }
}

static void exposure_stays_within_its_limits(void **state) {
    stage s = open_stage(*state, "even.comp");
    gpu_test_ok(pass_set_uniform(s.source, "tint", triple(s.e, 100, 100, 100)));
    gpu_test_ok(pass_set_uniform(s.meter, "min_ev", number(s.e, -2.5f)));
    build(&s);
    expect(stops(&s, 1), -2.5, "bright");
    effect_destroy(s.e);
    s = open_stage(*state, "even.comp");
    gpu_test_ok(pass_set_uniform(s.source, "tint", triple(s.e, 0.001f, 0.001f, 0.001f)));
    gpu_test_ok(pass_set_uniform(s.meter, "max_ev", number(s.e, 1.5f)));
    build(&s);
    expect(stops(&s, 1), 1.5, "dark");
    effect_destroy(s.e);
}

// The ramp's columns but the first, which is black, are 15 stops from -10 to 5 in even steps.
static double mean_of_ramp(double low, double high) {
    int count = WIDTH - 1;
    double from = low * count, to = high * count, sum = 0;
    for (int i = 0; i < count; i++)
        sum += fmax(fmin(i + 1, to) - fmax(i, from), 0) * (-10 + 15.0 * i / (WIDTH - 2));
    return sum / (to - from);
}

static void percentiles_cut_the_ends(void **state) {
    const float ends[][2] = {{0, 1}, {0.5f, 0.98f}, {0.1f, 0.3f}};
    for (size_t i = 0; i < COUNT_OF(ends); i++) {
        stage s = open_stage(*state, "ramp.comp");
        gpu_test_ok(pass_set_uniform(s.meter, "low", number(s.e, ends[i][0])));
        gpu_test_ok(pass_set_uniform(s.meter, "high", number(s.e, ends[i][1])));
        gpu_test_ok(pass_set_uniform(s.meter, "max_ev", number(s.e, 20)));
        build(&s);
        double want = log2(0.18) - mean_of_ramp((double)ends[i][0], (double)ends[i][1]);
        double got = stops(&s, 1);
        // A bin is an eighth of a stop: that much of one column may be cut elsewhere.
        if (!(fabs(got - want) < 0.02)) fail_msg("%zu: %g stops, not %g", i, got, want);
        effect_destroy(s.e);
    }
}

static void eye_adapts_with_its_time_constants(void **state) {
    static const curve_key keys[] = {// bright for frames 11 to 20
                                     {0.93, {1}},
                                     {0.97, {16}},
                                     {1.93, {16}},
                                     {1.97, {1}}};
    stage s = open_stage(*state, "even.comp");
    const curve *c =
        curve_create(effect_memory(s.e), &(curve){CURVE_LINEAR, 1, keys, COUNT_OF(keys), 0});
    gpu_test_ok(c);
    gpu_test_ok(pass_set_uniform(s.source, "tint", field_curve(effect_memory(s.e), c)));
    gpu_test_ok(pass_set_uniform(s.meter, "darken", number(s.e, 0.5f)));
    gpu_test_ok(pass_set_uniform(s.meter, "brighten", number(s.e, 2)));
    build(&s);
    double rest = log2(0.18), at = rest;
    for (int frame = 1; frame <= 30; frame++) {
        double target = frame > 10 && frame <= 20 ? rest - 4 : rest;
        at += (target - at) * (1 - exp(-1.0 / FPS / (target < at ? 0.5 : 2)));
        expect(stops(&s, frame), at, "adapting");
    }
    effect_destroy(s.e);
}

static void black_changes_nothing(void **state) {
    static const curve_key keys[] = {{0.03, {0}}, {0.07, {1}}, {0.53, {1}}, {0.57, {0}}};
    stage s = open_stage(*state, "even.comp");
    const curve *c =
        curve_create(effect_memory(s.e), &(curve){CURVE_LINEAR, 1, keys, COUNT_OF(keys), 0});
    gpu_test_ok(c);
    gpu_test_ok(pass_set_uniform(s.source, "tint", field_curve(effect_memory(s.e), c)));
    build(&s);
    expect(stops(&s, 1), 0, "black");
    expect(stops(&s, 2), log2(0.18), "the first light"); // at once
    for (int frame = 3; frame <= 12; frame++) expect(stops(&s, frame), log2(0.18), "black again");
    effect_destroy(s.e);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_picture_becomes_the_key),
        cmocka_unit_test(exposure_stays_within_its_limits),
        cmocka_unit_test(percentiles_cut_the_ends),
        cmocka_unit_test(eye_adapts_with_its_time_constants),
        cmocka_unit_test(black_changes_nothing),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
