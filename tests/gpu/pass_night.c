// lib/night.glsl: how a sky goes over to the night, and what is seen of that.
#include "media/exr.h"
#include "pass_test.h"
#include "scene/sky_image.h"
#include <stdlib.h>
#include <unistd.h>

enum { SIZE = 128, PIXELS = SIZE * SIZE };

static const double pi = 3.14159265358979;

static void open_sky(pass_world *w, gpu *device, float night) {
    world_open(w, device);
    w->scene.sky.zenith = triple(w, 2, 1, 1);
    w->scene.sky.horizon = triple(w, 0.5f, 1, 1);
    w->scene.sky.strength = number(w, 0.5f);
    w->scene.sky.night = night >= 0 ? number(w, night) : NULL;
    w->scene.sky.night_zenith = triple(w, 0.25f, 0.125f, 0);
    w->scene.sky.night_horizon = triple(w, 0.5f, 0, 0);
}

// Of directions evenly spread over the sphere.
static float *probe(pass_world *w, const char *show) {
    pass *p = world_add(w, NULL, "sky_probe.comp", show);
    gpu_test_ok(pass_set_option(p, "show", show) && pass_declare(p));
    world_render(w, SIZE, SIZE, pass_output(p, "color"));
    return world_read(w, pass_output(p, "color"));
}

static float *probe_sky(gpu *device, float night, const char *show) {
    pass_world w;
    open_sky(&w, device, night);
    float *out = probe(&w, show);
    world_close(&w);
    return out;
}

static void near_to(const float *got, const float *a, const float *b, float part) {
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            float want = a[4 * i + k] + part * (b[4 * i + k] - a[4 * i + k]);
            if (!(fabsf(got[4 * i + k] - want) <= 2e-3f))
                fail_msg("pixel %d: %g, not %g", i, (double)got[4 * i + k], (double)want);
        }
}

static void two_colours_go_over_to_the_night(void **state) {
    const char *const shows[] = {"radiance", "irradiance"};
    for (int k = 0; k < 2; k++) {
        float *never = probe_sky(*state, -1, shows[k]), *day = probe_sky(*state, 0, shows[k]);
        float *dusk = probe_sky(*state, 0.25f, shows[k]), *night = probe_sky(*state, 1, shows[k]);
        near_to(day, never, never, 0);
        near_to(dusk, day, night, 0.25f);
        for (int i = 0; k == 0 && i < PIXELS; i++) {
            float z = 1 - 2 * ((float)(i / SIZE) + 0.5f) / SIZE, up = sqrtf(fmaxf(z, 0));
            assert_true(fabsf(night[4 * i] - (0.5f - 0.25f * up)) < 1e-3f);
            assert_true(fabsf(night[4 * i + 1] - 0.125f * up) < 1e-3f);
        }
        mem_free(never);
        mem_free(day);
        mem_free(dusk);
        mem_free(night);
    }
}

// An image of one colour, as a file has it.
static sky_image *make_image(pass_world *w) {
    enum { WIDTH = 8, HEIGHT = 4 };
    char folder[] = "/tmp/roil-night-XXXXXX", path[64];
    gpu_test_ok(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/sky.exr", folder);
    float values[WIDTH * HEIGHT];
    for (int i = 0; i < WIDTH * HEIGHT; i++) values[i] = 3;
    exr_channel channel = {"Y", values, false};
    gpu_test_ok(exr_write(path, &(exr_image){WIDTH, HEIGHT, &channel, 1}));
    sky_image *image = sky_image_load(path, folder, &w->memory);
    unlink(path);
    rmdir(folder);
    gpu_test_ok(image && sky_image_upload(image, w->host.device));
    return image;
}

static void an_image_goes_over_to_the_night(void **state) {
    const char *const shows[] = {"radiance", "irradiance"};
    for (int k = 0; k < 2; k++) {
        float *night = probe_sky(*state, 1, shows[k]);
        pass_world w;
        open_sky(&w, *state, 0.75f);
        sky_image *image = make_image(&w);
        w.scene.sky.image = image;
        w.scene.sky.strength = number(&w, 1);
        float *dusk = probe(&w, shows[k]);
        for (int i = 0; i < PIXELS; i++)
            for (int c = 0; c < 3; c++) {
                float want = 0.25f * 3 + 0.75f * night[4 * i + c];
                assert_true(fabsf(dusk[4 * i + c] - want) < 5e-3f);
            }
        mem_free(night);
        mem_free(dusk);
        sky_image_destroy(image, w.host.device);
        world_close(&w);
    }
}

static float *probe_seen(gpu *device, float night, float stars, float moon) {
    pass_world w;
    open_sky(&w, device, night);
    w.scene.sky.night_zenith = w.scene.sky.night_horizon = triple(&w, 0, 0, 0);
    w.scene.sky.strength = number(&w, 0);
    w.scene.sky.stars = number(&w, stars);
    w.scene.sky.moon = number(&w, moon);
    w.scene.sun.azimuth = number(&w, 130);
    w.scene.sun.elevation = number(&w, 35);
    float *out = probe(&w, "seen");
    world_close(&w);
    return out;
}

static void the_moon_stands_where_the_sun_does(void **state) {
    const double across = 24, a = 130 * pi / 180, e = 35 * pi / 180;
    float *seen = probe_seen(*state, 1, 1, (float)across);
    for (int i = 0; i < PIXELS; i++) {
        double z = 1 - 2 * (i / SIZE + 0.5) / SIZE, azimuth = 2 * pi * (i % SIZE + 0.5) / SIZE;
        double side = sqrt(1 - z * z), toward = side * cos(azimuth - a) * cos(e) + z * sin(e);
        double away = acos(fmin(toward, 1)) * 180 / pi;
        if (away < across / 2 - 1) assert_true(seen[4 * i + 1] > 0.45f);
        if (away > 3 * across) assert_true(seen[4 * i + 1] < 0.45f);
    }
    mem_free(seen);
}

static void stars_shine_above_by_their_factor(void **state) {
    float *one = probe_seen(*state, 1, 1, 0), *two = probe_seen(*state, 1, 2, 0);
    float *day = probe_seen(*state, 0, 1, 0);
    int lit = 0, low = 0;
    for (int i = 0; i < PIXELS; i++) {
        float light = one[4 * i + 1];
        assert_true(fabsf(two[4 * i + 1] - 2 * light) <= 2e-3f * light + 1e-5f);
        assert_true(day[4 * i + 1] == 0);
        lit += light > 0.001f;
        low += light > 0 && i / SIZE > SIZE / 2 + 2;
    }
    assert_true(lit > 50);
    assert_int_equal(low, 0);
    mem_free(one);
    mem_free(two);
    mem_free(day);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_colours_go_over_to_the_night),
        cmocka_unit_test(an_image_goes_over_to_the_night),
        cmocka_unit_test(the_moon_stands_where_the_sun_does),
        cmocka_unit_test(stars_shine_above_by_their_factor),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
