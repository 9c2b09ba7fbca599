// lib/sky.glsl: radiance, irradiance and drawn directions of both skies.
#include "media/exr.h"
#include "pass_test.h"
#include "scene/sky_image.h"
#include <stdlib.h>
#include <unistd.h>

enum { SIZE = 64, PIXELS = SIZE * SIZE, WIDTH = 256, HEIGHT = 128 };

static const double pi = 3.14159265358979;

static void direction_of(int i, double out[3]) {
    double z = 1 - 2 * (i / SIZE + 0.5) / SIZE, a = 2 * pi * (i % SIZE + 0.5) / SIZE;
    out[0] = sqrt(1 - z * z) * cos(a);
    out[1] = sqrt(1 - z * z) * sin(a);
    out[2] = z;
}

typedef double sky_model(const double d[3]);

static double smooth_sky(const double d[3]) {
    return 2 + d[0] + d[2] / 2;
}

static double sunny_sky(const double d[3]) {
    return 0.3 + (0.6 * d[0] + 0.8 * d[2] > 0.995 ? 60 : 0);
}

static double texel_of(sky_model *model, int i) {
    double a = 2 * pi * ((i % WIDTH + 0.5) / WIDTH - 0.5), t = pi * (i / WIDTH + 0.5) / HEIGHT;
    return model((double[3]){sin(t) * sin(a), sin(t) * cos(a), cos(t)});
}

// Of all texels together, over the sphere.
static double light_of(sky_model *model) {
    double sum = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        double top = pi * (i / WIDTH) / HEIGHT, bottom = pi * (i / WIDTH + 1) / HEIGHT;
        sum += texel_of(model, i) * 2 * pi / WIDTH * (cos(top) - cos(bottom));
    }
    return sum;
}

// As a file, as exr_write and sky_image_load have it.
static sky_image *make_sky(pass_world *w, sky_model *model) {
    char folder[] = "/tmp/roil-sky-XXXXXX", path[64];
    gpu_test_ok(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/sky.exr", folder);
    float *values = mem_alloc(WIDTH * HEIGHT * sizeof *values);
    for (int i = 0; i < WIDTH * HEIGHT; i++) values[i] = (float)texel_of(model, i);
    exr_channel channel = {"Y", values, false};
    gpu_test_ok(exr_write(path, &(exr_image){WIDTH, HEIGHT, &channel, 1}));
    sky_image *s = sky_image_load(path, folder, &w->memory);
    unlink(path);
    rmdir(folder);
    mem_free(values);
    gpu_test_ok(s && sky_image_upload(s, w->host.device));
    w->scene.sky.image = s;
    w->scene.sky.strength = number(w, 1);
    return s;
}

static float *probe(pass_world *w, const char *show) {
    pass *p = world_add(w, NULL, "sky_probe.comp", "probe");
    gpu_test_ok(pass_set_option(p, "show", show) && pass_declare(p));
    world_render(w, SIZE, SIZE, pass_output(p, "color"));
    return world_read(w, pass_output(p, "color"));
}

static void close_with(pass_world *w, float *pixels, sky_image *s) {
    mem_free(pixels);
    if (s) sky_image_destroy(s, w->host.device);
    world_close(w);
}

static void near_to(double got, double want, double most, const char *what) {
    if (!(fabs(got - want) <= most)) fail_msg("%s: %g, not %g", what, got, want);
}

// ---- two colours ------------------------------------------------------------------------------

static void open_gradient(pass_world *w, gpu *device) {
    world_open(w, device);
    w->scene.sky.zenith = triple(w, 2, 1, 1);
    w->scene.sky.horizon = triple(w, 0.5f, 1, 1);
    w->scene.sky.strength = number(w, 1);
}

static double gradient(double z) {
    return 0.5 + 1.5 * sqrt(z > 0 ? z : 0);
}

static void gradient_goes_from_horizon_to_zenith(void **state) {
    pass_world w;
    open_gradient(&w, *state);
    float *c = probe(&w, "radiance");
    for (int i = 0; i < PIXELS; i++) {
        double d[3];
        direction_of(i, d);
        near_to((double)c[4 * i], gradient(d[2]), 2e-3, "radiance");
    }
    close_with(&w, c, NULL);
}

// By sums over the sphere.
static void gradients_irradiance_is_its_integral(void **state) {
    pass_world w;
    open_gradient(&w, *state);
    float *c = probe(&w, "irradiance");
    double mean = 0;
    for (int i = 0; i < PIXELS; i += SIZE + 1) {
        double n[3], d[3], sum = 0;
        direction_of(i, n);
        mean = 0;
        for (int k = 0; k < PIXELS; k++) {
            direction_of(k, d);
            double cosine = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
            sum += cosine > 0 ? cosine * gradient(d[2]) * 4 / PIXELS : 0;
            mean += gradient(d[2]) / PIXELS;
        }
        near_to((double)c[4 * i], sum, 0.012, "irradiance over pi");
    }
    near_to((double)c[3], mean, 2e-3, "mean");
    close_with(&w, c, NULL);
}

static void gradient_is_drawn_evenly(void **state) {
    pass_world w;
    open_gradient(&w, *state);
    float *c = probe(&w, "drawn");
    double height = 0;
    for (int i = 0; i < PIXELS; i++) {
        assert_true(c[4 * i + 1] == c[4 * i + 2]);
        near_to((double)c[4 * i + 1], 0.25 / pi, 1e-4, "density");
        height += fabs((double)c[4 * i + 3]) / PIXELS;
    }
    near_to(height, 0.5, 1e-3, "mean height");
    close_with(&w, c, NULL);
}

// ---- a panorama ---------------------------------------------------------------------------------

// Turned by a quarter, what the file has at +X stands at +Y.
static void panorama_stands_where_it_is_turned_to(void **state) {
    pass_world w;
    world_open(&w, *state);
    sky_image *s = make_sky(&w, smooth_sky);
    w.scene.sky.rotation = number(&w, 90);
    w.scene.sky.strength = number(&w, 0.5f);
    float *c = probe(&w, "radiance");
    for (int i = 0; i < PIXELS; i++) {
        double d[3];
        direction_of(i, d);
        near_to((double)c[4 * i], 0.5 * smooth_sky((double[3]){d[1], -d[0], d[2]}), 0.01,
                "radiance");
    }
    close_with(&w, c, s);
}

static void panoramas_irradiance_is_turned_too(void **state) {
    pass_world w;
    world_open(&w, *state);
    sky_image *s = make_sky(&w, smooth_sky);
    w.scene.sky.rotation = number(&w, 90);
    float *c = probe(&w, "irradiance");
    for (int i = 0; i < PIXELS; i++) {
        double n[3];
        direction_of(i, n);
        near_to((double)c[4 * i], 2 + 2.0 / 3 * (n[1] + n[2] / 2), 0.01, "irradiance over pi");
    }
    near_to((double)c[3], 2, 0.01, "mean");
    close_with(&w, c, s);
}

static void density_of_a_panorama_sums_to_one(void **state) {
    pass_world w;
    world_open(&w, *state);
    sky_image *s = make_sky(&w, smooth_sky);
    float *c = probe(&w, "density");
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) sum += 4 * pi * (double)c[4 * i] / PIXELS;
    near_to(sum, 1, 0.002, "sum of the density");
    close_with(&w, c, s);
}

// The light of a small sun, by as many directions as would mostly miss it if they were even.
static void drawn_directions_find_the_sun(void **state) {
    pass_world w;
    world_open(&w, *state);
    sky_image *s = make_sky(&w, sunny_sky);
    w.scene.sky.rotation = number(&w, 33);
    float *c = probe(&w, "drawn");
    int others = 0;
    double sum = 0, want = light_of(sunny_sky);
    for (int i = 0; i < PIXELS; i++) {
        sum += (double)c[4 * i] / PIXELS;
        double own = (double)c[4 * i + 1], asked = (double)c[4 * i + 2];
        others += fabs(own - asked) > 0.01 * own;
    }
    assert_true(others < PIXELS / 200); // on the line between cells it may be either
    near_to(sum, want, 0.02 * want, "light");
    close_with(&w, c, s);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradient_goes_from_horizon_to_zenith),
        cmocka_unit_test(gradients_irradiance_is_its_integral),
        cmocka_unit_test(gradient_is_drawn_evenly),
        cmocka_unit_test(panorama_stands_where_it_is_turned_to),
        cmocka_unit_test(panoramas_irradiance_is_turned_too),
        cmocka_unit_test(density_of_a_panorama_sums_to_one),
        cmocka_unit_test(drawn_directions_find_the_sun),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
