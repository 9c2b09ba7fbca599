// Every tone map beside the same in double precision on the host, from its source, and where the
// saturation acts.
#include "pass_test.h"

enum { WIDTH = 62, HEIGHT = 4 };

typedef struct color {
    double v[3];
} color;

static color times(const double m[3][3], color c) { // rows of m
    color out;
    for (int i = 0; i < 3; i++) out.v[i] = m[i][0] * c.v[0] + m[i][1] * c.v[1] + m[i][2] * c.v[2];
    return out;
}

static double luminance(color c) {
    return 0.2126 * c.v[0] + 0.7152 * c.v[1] + 0.0722 * c.v[2];
}

static color none(color c) {
    return c;
}

static color display(color c) { // IEC 61966-2-1: what a display makes of it
    for (int i = 0; i < 3; i++) {
        double v = fmin(fmax(c.v[i], 0), 1);
        c.v[i] = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    }
    return c;
}

static color exponential(color c) {
    for (int i = 0; i < 3; i++) c.v[i] = 1 - exp(-c.v[i]);
    return c;
}

static color reinhard(color c) { // equation 4 with white at 4
    double l = luminance(c), factor = (1 + l / 16) / (1 + l);
    for (int i = 0; i < 3; i++) c.v[i] *= factor;
    return c;
}

static color aces(color c) { // BakingLab, ACES.hlsl
    const double in[3][3] = {
        {0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}};
    const double out[3][3] = {{1.60475, -0.53108, -0.07367},
                              {-0.10208, 1.10813, -0.00605},
                              {-0.00327, -0.07276, 1.07602}};
    c = times(in, c);
    for (int i = 0; i < 3; i++) {
        double v = c.v[i];
        c.v[i] = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    }
    return times(out, c);
}

static color agx(color c) { // "Minimal AgX implementation"
    const double in[3][3] = {{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                             {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                             {0.0423756549057051, 0.0784336, 0.879142973793104}};
    const double out[3][3] = {{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                              {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                              {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}};
    const double poly[] = {-0.00232, 0.1191, 0.4298, -6.868, 31.96, -40.14, 15.5};
    c = times(in, c);
    for (int i = 0; i < 3; i++) {
        double x = (fmax(log2(fmax(c.v[i], 1e-10)), -12.47393) + 12.47393) / (4.026069 + 12.47393);
        double sum = 0;
        for (int k = 6; k >= 0; k--) sum = sum * fmin(x, 1) + poly[k];
        c.v[i] = sum;
    }
    c = times(out, c);
    for (int i = 0; i < 3; i++) c.v[i] = pow(fmax(c.v[i], 0), 2.2);
    return c;
}

typedef struct tonemap {
    const char *name;
    color (*map)(color c);
} tonemap;

static const tonemap tonemaps[] = {
    {"none", none},         {"display", display}, {"exponential", exponential},
    {"reinhard", reinhard}, {"aces", aces},       {"agx", agx}};

static color saturated(color c, double saturation) {
    double grey = luminance(c);
    for (int i = 0; i < 3; i++) c.v[i] = fmax(grey + saturation * (c.v[i] - grey), 0);
    return c;
}

// A ramp of 15 stops by the pass and by the host; `place`: where the saturation acts.
static void compare(gpu *device, tonemap t, const float tint[3], float saturation,
                    const char *place) {
    pass_world w;
    world_open(&w, device);
    pass *ramp = world_add(&w, NULL, "ramp.comp", "ramp");
    gpu_test_ok(pass_set_uniform(ramp, "tint", triple(&w, tint[0], tint[1], tint[2])));
    gpu_test_ok(pass_declare(ramp));
    pass *final = world_add(&w, "final", NULL, "final");
    gpu_test_ok(pass_set_option(final, "tonemap", t.name));
    gpu_test_ok(pass_set_option(final, "saturate", place));
    gpu_test_ok(pass_set_uniform(final, "saturation", number(&w, saturation)));
    gpu_test_ok(pass_set_image(final, "source", pass_output(ramp, "color")));
    gpu_test_ok(pass_declare(final));
    graph_add_output(w.host.graph, pass_output(ramp, "color"));
    world_render(&w, WIDTH, HEIGHT, pass_output(final, "color"));
    float *in = world_read(&w, pass_output(ramp, "color"));
    float *shown = world_read(&w, pass_output(final, "color"));
    bool first = strcmp(place, "scene") == 0;
    for (uint32_t x = 0; x < WIDTH; x++) {
        color c = {{(double)in[4 * x], (double)in[4 * x + 1], (double)in[4 * x + 2]}};
        if (first) c = saturated(c, (double)saturation);
        c = t.map(c);
        for (int i = 0; i < 3; i++) c.v[i] = fmax(c.v[i], 0);
        if (!first) c = saturated(c, (double)saturation);
        for (int i = 0; i < 3; i++) {
            double want = fmin(c.v[i], 1), got = (double)shown[4 * x + (uint32_t)i];
            if (!(fabs(got - want) < 0.002))
                fail_msg("%s, column %u, channel %d: %g, not %g", t.name, x, i, got, want);
        }
    }
    mem_free(in);
    mem_free(shown);
    world_close(&w);
}

static void every_tonemap_is_what_its_source_says(void **state) {
    const float tints[][3] = {{1, 1, 1}, {1, 0.3f, 0.05f}, {0, 0.1f, 1}};
    for (size_t t = 0; t < COUNT_OF(tonemaps); t++)
        for (size_t i = 0; i < COUNT_OF(tints); i++)
            compare(*state, tonemaps[t], tints[i], 1, "scene");
}

static void saturation_acts_before_or_after(void **state) {
    const char *places[] = {"scene", "display"};
    for (size_t i = 0; i < COUNT_OF(places); i++) {
        compare(*state, tonemaps[2], (const float[3]){1, 0.3f, 0.05f}, 0.9f, places[i]);
        compare(*state, tonemaps[5], (const float[3]){1, 0.3f, 0.05f}, 1.5f, places[i]);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_tonemap_is_what_its_source_says),
        cmocka_unit_test(saturation_acts_before_or_after),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
