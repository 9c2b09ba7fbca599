// Surfaces under lights and sky, with shadows of meshes and of the volume. The scene is a wall at
// y = 0 that faces the camera, which stands at (0, -5, 0).
#include "pass_test.h"

enum { SIZE = 48, PIXELS = SIZE * SIZE };

static const float wall_color[] = {1, 0.5f, 0.25f}; // of a mesh; its material comes on top

static scene_mesh *add_wall(pass_world *w) {
    scene_mesh *wall = world_mesh(w, "plane.obj");
    wall->scale = number(w, 200); // large, as ground is
    wall->color = triple(w, wall_color[0], wall_color[1], wall_color[2]);
    return wall;
}

static scene_mesh *add_crate(pass_world *w, float half, float x, float y, float z) {
    scene_mesh *crate = world_mesh(w, "crate.obj");
    crate->scale = number(w, half);
    crate->position = triple(w, x, y, z);
    return crate;
}

// A shade of all meshes; `from` (may be NULL) is asked as well.
static pass *add_shade(pass_world *w, pass *from) {
    pass *geometry = world_add(w, "geometry", NULL, "geometry");
    for (size_t i = 0; i < w->mesh_count; i++) gpu_test_ok(pass_add_mesh(geometry, &w->meshes[i]));
    gpu_test_ok(pass_declare(geometry));
    pass *p = world_add(w, "shade", NULL, "shade");
    pass_add_source(p, geometry);
    if (from) pass_add_source(p, from);
    return p;
}

static float *render(pass_world *w, pass *shade) {
    gpu_test_ok(pass_declare(shade));
    world_render(w, SIZE, SIZE, pass_output(shade, "color"));
    return world_read(w, pass_output(shade, "color"));
}

static float *shade(pass_world *w, const char *uniform, float value) {
    pass *p = add_shade(w, NULL);
    if (uniform) gpu_test_ok(pass_set_uniform(p, uniform, number(w, value)));
    return render(w, p);
}

// Where the ray of a pixel meets the wall.
static void wall_point(const pass_world *w, size_t i, double *x, double *z) {
    double u = ((double)(i % SIZE) + 0.5) / SIZE, v = ((double)(i / SIZE) + 0.5) / SIZE;
    *x = 5 * (2 * u - 1) * (double)w->frame.lens.v[0];
    *z = 5 * (1 - 2 * v) * (double)w->frame.lens.v[1];
}

static bool in_square(double x, double z, double cx, double cz, double half) {
    return fabs(x - cx) < half && fabs(z - cz) < half;
}

static void expect_near(float got, double want, double tolerance, const char *what, size_t i) {
    if (!(fabs((double)got - want) <= tolerance))
        fail_msg("%s, pixel (%zu, %zu): %.5f, not %.5f", what, i % SIZE, i / SIZE, (double)got,
                 want);
}

static void shine(pass_world *w, float azimuth, float elevation) { // radiance of the sun: 1
    w->scene.sun.strength = number(w, GLM_PIf);
    w->scene.sun.azimuth = number(w, azimuth);
    w->scene.sun.elevation = number(w, elevation);
}

// What a white wall sends back, for light of irradiance pi at this cosine.
static double lit(const pass_world *w, int channel, double cosine) {
    return cosine * (double)(wall_color[channel] * w->meshes[0].data.parts[0].color[channel]);
}

// ---- light --------------------------------------------------------------------------------------

static void sun_and_sky_add_up(void **state) {
    for (int tilt = -60; tilt <= 60; tilt += 30) { // of the wall, degrees
        pass_world w;
        world_open(&w, *state);
        add_wall(&w)->rotation = triple(&w, (float)tilt, 0, 0);
        shine(&w, -90, 45);
        w.scene.sky.strength = number(&w, 1);
        w.scene.sky.zenith = triple(&w, 0.2f, 0.4f, 0.8f);
        w.scene.sky.horizon = triple(&w, 0.8f, 0.6f, 0.4f);
        float *c = shade(&w, NULL, 0);
        // The sky is a mean over the hemisphere, by the cosine.
        double a = GLM_PI / 180 * tilt, ny = -cos(a), nz = -sin(a), up = 0, all = 0;
        for (int i = 0; i < 200 * 200; i++) {
            double z = (i / 200 + 0.5) / 100 - 1, angle = 2 * GLM_PI * (i % 200 + 0.5) / 200;
            double cosine = fmax(ny * sqrt(1 - z * z) * cos(angle) + nz * z, 0);
            up += cosine * sqrt(fmax(z, 0));
            all += cosine;
        }
        up /= all;
        const double zenith[] = {0.2, 0.4, 0.8}, horizon[] = {0.8, 0.6, 0.4};
        double sun = fmax((nz - ny) * sqrt(0.5), 0);
        size_t middle = PIXELS / 2 + SIZE / 2;
        for (int i = 0; i < 3; i++) {
            double want = lit(&w, i, sun + horizon[i] + (zenith[i] - horizon[i]) * up);
            expect_near(c[4 * middle + (size_t)i], want, 0.004, "sun and sky", middle);
        }
        assert_true(c[4 * middle + 3] == 1);
        mem_free(c);
        world_close(&w);
    }
}

// A lamp so far from the wall, with a cone of so many degrees; 0: it shines into all directions.
static void light_wall_by(gpu *device, float away, float angle) {
    const double share = gpu_test_is_coarse() ? 0.003 : 0.002;
    pass_world w;
    world_open(&w, device);
    add_wall(&w);
    scene_light light = {
        .kind = angle > 0 ? SCENE_SPOT : SCENE_POINT,
        .position = triple(&w, 0.5f, -away, 0),
        .color = triple(&w, 1, 1, 1),
        .power = number(&w, away * away * 4 * GLM_PIf * GLM_PIf), // pi W/sr at a metre
        .radius = number(&w, 0),
        .target = triple(&w, 0.5f, 0, 0),
        .angle = number(&w, angle),
        .softness = number(&w, 0),
    };
    w.scene.lights = &light;
    w.scene.light_count = 1;
    float *c = shade(&w, NULL, 0);
    double cone = (double)away * tan((double)angle / 2 * GLM_PI / 180);
    size_t outside = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        double x, z, d = (double)away;
        wall_point(&w, i, &x, &z);
        double off = sqrt((x - 0.5) * (x - 0.5) + z * z), squared = off * off + d * d;
        double want = lit(&w, 0, d * d * d / sqrt(squared) / squared);
        if (angle > 0 && fabs(off - cone) < 0.03) continue; // on its edge
        if (angle > 0 && off > cone) want = 0, outside++;
        expect_near(c[4 * i], want, share * want + 1e-6, angle > 0 ? "spot" : "point", i);
    }
    assert_true(angle > 0 ? outside > PIXELS / 4 && outside < PIXELS : outside == 0);
    mem_free(c);
    world_close(&w);
}

static void lamps_fall_off_and_have_cones(void **state) {
    light_wall_by(*state, 1.5f, 0);
    light_wall_by(*state, 1.5f, 60);
    light_wall_by(*state, 100, 0.8f);
}

static void haze_fades_to_the_horizon(void **state) {
    pass_world w;
    world_open(&w, *state);
    add_wall(&w);
    w.scene.sky.strength = number(&w, 1);
    w.scene.sky.zenith = w.scene.sky.horizon = triple(&w, 2, 2, 2);
    float *c = shade(&w, "haze", 0.1f);
    for (size_t i = 0; i < PIXELS; i++) {
        double x, z;
        wall_point(&w, i, &x, &z);
        double kept = exp(-0.1 * sqrt(25 + x * x + z * z));
        expect_near(c[4 * i + 2], 2 * (1 - kept) + kept * lit(&w, 2, 2), 0.005, "haze", i);
    }
    mem_free(c);
    world_close(&w);
}

// ---- shadows of meshes
// ----------------------------------------------------------------------------

static void crate_casts_a_shadow_and_the_wall_none_on_itself(void **state) {
    for (int samples = 0; samples < 2; samples++) {
        pass_world w;
        world_open(&w, *state);
        add_wall(&w);
        add_crate(&w, 0.2f, 0, -1, 0);
        shine(&w, -60, 0);
        float *c = shade(&w, "shadow_samples", (float)samples);
        // The sun comes 30 degrees from the right: the shadow lies to the left, sheared.
        double slope = tan(GLM_PI / 6), left = -0.2 - 1.2 * slope, right = 0.2 - 0.8 * slope;
        double middle = 0.5 * (left + right), half = 0.5 * (right - left);
        size_t dark = 0;
        for (size_t i = 0; i < PIXELS; i++) {
            double x, z, away;
            wall_point(&w, i, &x, &z);
            if (in_square(x, z, 0, 0, 0.28)) continue; // the crate may stand before it
            away = fmax(fabs(x - middle) - half, fabs(z) - 0.2);
            if (fabs(away) < 0.01) continue;
            bool hidden = samples && away < 0;
            expect_near(c[4 * i], hidden ? 0 : lit(&w, 0, cos(GLM_PI / 6)), 0.002, "shadow", i);
            dark += hidden;
        }
        assert_true(samples ? dark > 20 : dark == 0);
        mem_free(c);
        world_close(&w);
    }
}

// How many pixels' light the crate takes from the wall, and how many of them have part of it.
static double lose(gpu *device, float samples, size_t *partly) {
    pass_world w;
    world_open(&w, device);
    add_wall(&w);
    add_crate(&w, 0.2f, 0, -1, 0);
    shine(&w, -45, 0);
    w.scene.sun.angle = number(&w, 10);
    float *c = shade(&w, "shadow_samples", samples);
    double lost = 0, full = lit(&w, 0, sqrt(0.5));
    *partly = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        double x, z, part = (double)c[4 * i] / full;
        wall_point(&w, i, &x, &z);
        if (in_square(x, z, 0, 0, 0.28)) continue;
        lost += 1 - part;
        *partly += part > 0.01 && part < 0.99;
    }
    mem_free(c);
    world_close(&w);
    return lost;
}

static void wide_light_has_soft_shadows_of_the_same_size(void **state) {
    size_t hard_edge, soft_edge;
    double hard = lose(*state, 1, &hard_edge), soft = lose(*state, 32, &soft_edge);
    assert_int_equal(hard_edge, 0);
    assert_true(soft_edge > 30);
    if (fabs(hard - soft) > 0.1 * hard) fail_msg("%.1f pixels are lost, softly %.1f", hard, soft);
}

static void only_what_stands_before_a_light_hides_it(void **state) {
    for (int inside = 0; inside < 2; inside++) { // a crate behind the lamp, or its own bulb
        pass_world w;
        world_open(&w, *state);
        add_wall(&w);
        add_crate(&w, 0.05f, 0, inside ? -1.5f : -4, 0);
        scene_light light = {.kind = SCENE_POINT,
                             .position = triple(&w, 0, -1.5f, 0),
                             .color = triple(&w, 1, 1, 1),
                             .power = number(&w, 4 * GLM_PIf * GLM_PIf),
                             .radius = number(&w, 0.1f)};
        w.scene.lights = &light;
        w.scene.light_count = 1;
        float *c = shade(&w, NULL, 0);
        size_t corner = 0;
        double x, z;
        wall_point(&w, corner, &x, &z);
        double squared = x * x + z * z + 1.5 * 1.5,
               want = lit(&w, 0, 1.5 / squared / sqrt(squared));
        expect_near(c[4 * corner], want, 0.002 * want, inside ? "bulb" : "crate", corner);
        mem_free(c);
        world_close(&w);
    }
}

static void sky_is_dimmed_by_what_stands_before_it(void **state) {
    for (int covered = 0; covered < 2; covered++) {
        pass_world w;
        world_open(&w, *state);
        scene_mesh *floor = add_wall(&w);
        floor->rotation = triple(&w, -90, 0, 0);
        floor->position = triple(&w, 0, 0, -1);
        if (covered) {
            scene_mesh *lid = world_mesh(&w, "plane.obj");
            lid->rotation = triple(&w, -90, 0, 0);
            lid->position = triple(&w, 0, 0, 1);
            lid->scale = number(&w, 1000);
        }
        w.scene.sky.strength = number(&w, 1);
        w.scene.sky.zenith = w.scene.sky.horizon = triple(&w, 1, 1, 1);
        float *c = shade(&w, "sky_samples", 16);
        size_t low = PIXELS - SIZE / 2; // the floor, near the camera
        expect_near(c[4 * low], covered ? 0 : lit(&w, 0, 1), 0.01, "floor", low);
        mem_free(c);
        world_close(&w);
    }
}

// ---- the volume
// -----------------------------------------------------------------------------------

static pass *add_lighting(pass_world *w, float density, float emission) {
    pass *p = world_add(w, "lighting", NULL, "lighting");
    gpu_test_ok(pass_set_field(p, "density", block(w, 0.5f, density)));
    gpu_test_ok(pass_set_field(p, "emission", block(w, 0.5f, emission)));
    gpu_test_ok(pass_declare(p));
    return p;
}

static void volume_casts_a_shadow(void **state) {
    pass_world w;
    world_open(&w, *state);
    add_wall(&w)->position = triple(&w, 0, 1, 0);
    shine(&w, -60, 0);
    pass *lighting = add_lighting(&w, 0.8f, 0);
    gpu_test_ok(pass_set_uniform(lighting, "albedo", number(&w, 1)));
    float *c = render(&w, add_shade(&w, lighting));
    double slope = tan(GLM_PI / 6), bright = lit(&w, 0, cos(GLM_PI / 6)), x, z;
    for (size_t i = 0; i < PIXELS; i++) {
        wall_point(&w, i, &x, &z);
        x *= 6.0 / 5; // the wall is a metre farther away here
        z *= 6.0 / 5;
        // Metres of the ray to the sun between y = -0.5 and y = 0.5 for which |x| < 0.5.
        double enter = fmax(0.5, (-0.5 - x) / slope), leave = fmin(1.5, (0.5 - x) / slope);
        double inside = fmax(leave - enter, 0) / cos(GLM_PI / 6);
        if (fabs(fabs(z) - 0.5) < 0.05) continue;
        if (fabs(z) > 0.5) inside = 0;
        expect_near(c[4 * i], bright * exp(-0.8 * inside), 0.03 * bright, "volume", i);
    }
    mem_free(c);
    world_close(&w);
}

static void fire_lights_the_wall(void **state) {
    pass_world w;
    world_open(&w, *state);
    add_wall(&w)->position = triple(&w, 0, 2, 0);
    float *c = render(&w, add_shade(&w, add_lighting(&w, 1e-3f, 3)));
    size_t middle = PIXELS / 2 + SIZE / 2;
    double want = lit(&w, 0, 3.0 / 4 / GLM_PI); // 3 W/sr from a cubic metre, 2 m away
    expect_near(c[4 * middle], want, 0.15 * want, "fire", middle);
    mem_free(c);
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(sun_and_sky_add_up),
        cmocka_unit_test(lamps_fall_off_and_have_cones),
        cmocka_unit_test(haze_fades_to_the_horizon),
        cmocka_unit_test(crate_casts_a_shadow_and_the_wall_none_on_itself),
        cmocka_unit_test(wide_light_has_soft_shadows_of_the_same_size),
        cmocka_unit_test(only_what_stands_before_a_light_hides_it),
        cmocka_unit_test(sky_is_dimmed_by_what_stands_before_it),
        cmocka_unit_test(volume_casts_a_shadow),
        cmocka_unit_test(fire_lights_the_wall),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
