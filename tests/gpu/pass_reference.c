// The path tracer against what is known without one.
#include "long_test.h"
#include "pass_test.h"
#include "scene/material.h"

// Samples of an execution are few: llvmpipe ends all loops of a thread after 65535 turns together.
enum { SIZE = 16, PIXELS = SIZE * SIZE, SAMPLES = 4 };

typedef struct picture {      // over all pixels and channels
    double mean[4], error[4]; // the latter is the standard error of the former
} picture;

static picture measure(pass_world *w, const pass *p) {
    picture out = {0};
    float *pixels = world_read(w, pass_output(p, "color"));
    for (int c = 0; c < 4; c++) {
        double sum = 0, squares = 0;
        for (int i = 0; i < PIXELS; i++) sum += (double)pixels[4 * i + c];
        out.mean[c] = sum / PIXELS;
        for (int i = 0; i < PIXELS; i++) squares += pow((double)pixels[4 * i + c] - out.mean[c], 2);
        out.error[c] = sqrt(squares / (PIXELS - 1) / PIXELS);
    }
    mem_free(pixels);
    return out;
}

// Within four standard errors, which must be small enough to mean something.
static void near(picture got, int channel, double wanted) {
    double error = got.error[channel], allowed = 4 * error + 0.001 * wanted + 1e-6;
    if (error > 0.01 * wanted + 1e-6)
        fail_msg("channel %d: %.5f +- %.5f is too noisy", channel, got.mean[channel], error);
    if (fabs(got.mean[channel] - wanted) > allowed)
        fail_msg("channel %d: %.5f +- %.5f, not %.5f", channel, got.mean[channel], error, wanted);
}

static void set(pass_world *w, pass *p, const char *name, float value) {
    gpu_test_ok(pass_set_uniform(p, name, number(w, value)));
}

static void set3(pass_world *w, pass *p, const char *name, float x, float y, float z) {
    gpu_test_ok(pass_set_uniform(p, name, triple(w, x, y, z)));
}

static pass *begin(pass_world *w, gpu *device, const field *(*density)(pass_world *w)) {
    world_open(w, device);
    w->scene.camera.fov = number(w, 1); // all pixels see the same
    pass *p = world_add(w, "reference", NULL, "reference");
    gpu_test_ok(pass_set_field(p, "density", density(w)));
    set(w, p, "samples", SAMPLES);
    set(w, p, "bounces", 1024);
    set3(w, p, "albedo", 1, 1, 1);
    return p;
}

static void white_sky(pass_world *w) {
    w->scene.sky.zenith = w->scene.sky.horizon = triple(w, 1, 1, 1);
    w->scene.sky.strength = number(w, 1);
}

static void sun(pass_world *w, float azimuth, float elevation, float strength) {
    w->scene.sun.azimuth = number(w, azimuth);
    w->scene.sun.elevation = number(w, elevation);
    w->scene.sun.strength = number(w, strength);
}

// A picture of so many samples a pixel. Closes the world.
static picture end(pass_world *w, pass *p, int samples) {
    gpu_test_ok(pass_declare(p));
    world_render(w, SIZE, SIZE, pass_output(p, "color"));
    for (int i = SAMPLES; i < samples; i += SAMPLES) world_frame(w, SIZE, SIZE, 1);
    picture out = measure(w, p);
    world_close(w);
    return out;
}

static const field *slab(pass_world *w) { // of 2 m along the line of sight
    return block(w, 1, 0.7f);
}

static const field *thick(pass_world *w) {
    return block(w, 1, 1.5f);
}

static const field *soft_ball(pass_world *w) {
    const field *shape =
        row(w, "sphere", SET("radius", number(w, 1)), SET("falloff", number(w, 0.8f)));
    return row(w, "mul", SET("a", shape), SET("b", number(w, 4)));
}

// ---- furnaces: whatever does not absorb cannot be told from the sky around it
// ---------------------

typedef struct furnace {
    float extinction[3], anisotropy, bound;
    const char *phase;
    bool lobes;
} furnace;

static void heat(gpu *device, const field *(*density)(pass_world *w), furnace f) {
    pass_world w;
    pass *p = begin(&w, device, density);
    white_sky(&w);
    w.scene.camera.fov = number(&w, 15);
    set3(&w, p, "extinction", f.extinction[0], f.extinction[1], f.extinction[2]);
    set(&w, p, "anisotropy", f.anisotropy);
    if (f.bound > 0) set(&w, p, "majorant_scale", f.bound);
    if (f.phase) gpu_test_ok(pass_set_option(p, "phase", f.phase));
    if (f.lobes) {
        const float weights[4] = {3, 0, 1, 0.5f}, g[4] = {0.8f, 0, -0.5f, 0.1f};
        gpu_test_ok(pass_set_uniform(p, "lobe_weights", field_constant(&w.memory, 4, weights)));
        gpu_test_ok(pass_set_uniform(p, "lobe_anisotropies", field_constant(&w.memory, 4, g)));
    }
    picture got = end(&w, p, 128);
    for (int c = 0; c < 4; c++) near(got, c, 1);
}

static void white_furnace_shows_only_the_sky(void **state) {
    heat(*state, thick, (furnace){.extinction = {1, 1, 1}});
    heat(*state, soft_ball, (furnace){.extinction = {1, 1, 1}});
}

static void coloured_extinction_keeps_the_furnace_white(void **state) {
    heat(*state, soft_ball, (furnace){.extinction = {0.4f, 1, 2}, .anisotropy = 0.3f});
}

static void sharp_phase_functions_keep_the_furnace_white(void **state) {
    if (!sim_long_tests("a furnace of sharp phase functions")) return;
    heat(*state, soft_ball, (furnace){.extinction = {1, 1, 1}, .anisotropy = 0.8f});
    heat(*state, soft_ball,
         (furnace){.extinction = {1, 1, 1}, .anisotropy = 0.8f, .phase = "schlick"});
    heat(*state, soft_ball, (furnace){.extinction = {1, 1, 1}, .lobes = true});
    heat(*state, soft_ball, (furnace){.extinction = {1, 1, 1}, .lobes = true, .phase = "schlick"});
}

static void bounds_that_are_too_low_cost_noise_only(void **state) {
    if (!sim_long_tests("bounds that are too low")) return;
    heat(*state, soft_ball, (furnace){.extinction = {1, 1, 1}, .bound = 0.9f});
    heat(*state, soft_ball, (furnace){.extinction = {0.3f, 0.3f, 0.3f}, .bound = 0.75f});
    heat(*state, soft_ball, (furnace){.extinction = {1, 0.5f, 1}, .bound = 4});
}

static void absorption_takes_light_away(void **state) {
    double last = 1;
    for (float albedo = 0.9f; albedo > 0.2f; albedo -= 0.3f) {
        pass_world w;
        pass *p = begin(&w, *state, thick);
        white_sky(&w);
        set3(&w, p, "albedo", albedo, albedo, albedo);
        picture got = end(&w, p, 64);
        assert_true(got.mean[0] < last - 4 * got.error[0]);
        assert_true(got.mean[0] > exp(-3.0));
        last = got.mean[0];
    }
}

// ---- slabs
// ----------------------------------------------------------------------------------------

static void sky_behind_a_slab_follows_beer_and_lambert(void **state) {
    pass_world w;
    pass *p = begin(&w, *state, slab);
    white_sky(&w);
    set3(&w, p, "albedo", 0, 0, 0);
    set3(&w, p, "extinction", 0.5f, 1, 2);
    picture got = end(&w, p, 512);
    near(got, 0, exp(-0.7));
    near(got, 1, exp(-1.4));
    near(got, 2, exp(-2.8));
    near(got, 3, 1);
}

static void absorption_color_lets_its_colour_through(void **state) {
    pass_world w;
    pass *p = begin(&w, *state, slab);
    white_sky(&w);
    set3(&w, p, "albedo", 0, 0, 0);
    set3(&w, p, "absorption_color", 1, 0.25f, 0);
    picture got = end(&w, p, 256);
    near(got, 0, 1);
    near(got, 1, exp(-0.7));
    near(got, 2, exp(-1.4));
}

static void clear_sky_leaves_the_opacity_of_the_medium(void **state) {
    pass_world w;
    pass *p = begin(&w, *state, slab);
    white_sky(&w);
    set3(&w, p, "albedo", 0, 0, 0);
    set(&w, p, "sky_alpha", 0);
    picture got = end(&w, p, 128);
    near(got, 0, 0);
    near(got, 3, 1 - exp(-1.4));
}

// Of so few points in cells of 6 cm hardly any meets it; its range is met always.
static const field *foil(pass_world *w) { // a tenth of a millimetre thick, in much thin air
    const field *sheet = row(w, "box", SET("position", triple(w, 0, 0.0123f, 0)),
                             SET("size", triple(w, 1.9f, 1e-4f, 1.9f)));
    return row(w, "add", SET("a", row(w, "mul", SET("a", sheet), SET("b", number(w, 2e3f)))),
               SET("b", block(w, 1, 1e-5f)));
}

static void what_no_point_has_met_is_seen_all_the_same(void **state) {
    pass_world w;
    pass *p = begin(&w, *state, foil);
    white_sky(&w);
    set3(&w, p, "albedo", 0, 0, 0);
    near(end(&w, p, 128), 0, exp(-0.2));
}

static void glowing_slab_has_the_light_of_its_depth(void **state) {
    pass_world w;
    pass *p = begin(&w, *state, slab);
    set3(&w, p, "albedo", 0, 0, 0);
    gpu_test_ok(pass_set_field(p, "emission", triple(&w, 3, 0, 0)));
    gpu_test_ok(pass_set_field(p, "radiance", triple(&w, 0, 2, 0)));
    picture got = end(&w, p, 256);
    near(got, 0, 3 * (1 - exp(-1.4)) / 0.7);
    near(got, 1, 2 * (1 - exp(-1.4)));
    near(got, 2, 0);
}

static double hg(double cosine, double g) {
    return (1 - g * g) / (4 * 3.14159265358979 * pow(1 + g * g - 2 * g * cosine, 1.5));
}

static void sunlight_scattered_once_has_its_closed_form(void **state) {
    const double s = 0.7, g = 0.3, strength = 5;
    pass_world w;
    pass *p = begin(&w, *state, slab);
    sun(&w, -90, 0, (float)strength); // behind the camera
    set(&w, p, "bounces", 1);
    set(&w, p, "anisotropy", (float)g);
    set3(&w, p, "albedo", 1, 0.5f, 0);
    picture got = end(&w, p, 256);
    double back = strength * hg(-1, g) * (1 - exp(-4 * s)) / 2;
    near(got, 0, back);
    near(got, 1, back / 2);
    near(got, 2, 0);

    p = begin(&w, *state, slab);
    sun(&w, 0, 90, (float)strength); // overhead: through 1 m to the line of sight
    set(&w, p, "bounces", 1);
    set(&w, p, "anisotropy", (float)g);
    near(end(&w, p, 256), 0, strength * hg(0, g) * exp(-s) * (1 - exp(-2 * s)));
}

// A sun of 60 degrees across, seen through a lobe of 30: its mean over the disc.
static void wide_sun_is_the_mean_of_its_disc(void **state) {
    const double s = 0.7, g = 0.8, strength = 5, half = 3.14159265358979 / 6;
    pass_world w;
    pass *p = begin(&w, *state, slab);
    sun(&w, 90, 0, (float)strength); // ahead of the camera, beyond the slab
    w.scene.sun.angle = number(&w, 60);
    set(&w, p, "bounces", 1);
    set(&w, p, "anisotropy", (float)g);
    set(&w, p, "sky_alpha", 0);
    // Over the disc: where the way out is longer by the cosine, as the slab is 2 m thick and wide.
    double sum = 0, count = 0;
    for (int i = 0; i < 400; i++) {
        double cosine = 1 - (i + 0.5) / 400 * (1 - cos(half)), on = 1 / cosine - 1;
        double lost = on > 1e-6 ? (1 - exp(-2 * s * on)) / on : 2 * s;
        sum += hg(cosine, g) * exp(-2 * s) * lost;
        count++;
    }
    near(end(&w, p, 512), 0, strength * 2 / (1 + cos(half)) * sum / count);
}

// ---- surfaces
// -------------------------------------------------------------------------------------

static const field *nothing(pass_world *w) {
    return block(w, 0.5f, 0);
}

static void white_crate_in_a_white_sky_is_white(void **state) {
    for (int medium = 0; medium < 2; medium++) {
        pass_world w;
        pass *p = begin(&w, *state, medium ? soft_ball : nothing);
        white_sky(&w);
        w.scene.camera.fov = number(&w, 30);
        scene_mesh *mesh = world_mesh(&w, "crate.obj");
        mesh->color = triple(&w, 1 / 0.6f, 1 / 0.6f, 1 / 0.6f); // without a material it is grey
        mesh->scale = number(&w, 0.7f);
        mesh->rotation = triple(&w, 30, 20, 40);
        picture got = end(&w, p, 64);
        for (int c = 0; c < 4; c++) near(got, c, 1);
    }
}

// A wall sees half of the sky: of the gradient, whose part of the zenith is the root of the height,
// the cosine-weighted mean is B(3/4, 3/2) / pi.
static void gradient_of_the_sky_lights_a_wall(void **state) {
    for (int hazy = 0; hazy < 2; hazy++) {
        pass_world w;
        pass *p = begin(&w, *state, nothing);
        w.scene.sky.horizon = triple(&w, 1, 0, 2);
        w.scene.sky.zenith = triple(&w, 0, 1, 2);
        w.scene.sky.strength = number(&w, 1);
        set(&w, p, "haze", hazy ? 0.2f : 0); // over 5 m
        world_mesh(&w, "plane.obj");
        picture got = end(&w, p, 256);
        double kept = hazy ? exp(-1) : 1;
        near(got, 0, kept * 0.6 * (1 - 0.305104) + (1 - kept));
        near(got, 1, kept * 0.6 * 0.305104);
        near(got, 2, kept * 0.6 * 2 + (1 - kept) * 2);
    }
}

// A lamp of 0.5 m before a grey wall: at its middle it is as bright as a point.
static void glowing_sphere_lights_a_wall_as_a_point_does(void **state) {
    pass_world w;
    pass *p = begin(&w, *state, nothing);
    scene_light lamp = {.kind = SCENE_POINT,
                        .position = triple(&w, 0, -2, 1),
                        .color = triple(&w, 1, 1, 1),
                        .power = number(&w, 100),
                        .radius = number(&w, 0.5f)};
    w.scene.lights = &lamp;
    w.scene.light_count = 1;
    world_mesh(&w, "plane.obj");
    double irradiance = 100 / (4 * 3.14159265358979) / 5 * (2 / sqrt(5));
    near(end(&w, p, 64), 0, 0.6 / 3.14159265358979 * irradiance);
}

// As far as smoke lets it through, and no light besides: nothing else is lit by it.
static void what_a_material_gives_off_is_seen(void **state) {
    pass_world w;
    pass *p = begin(&w, *state, nothing);
    const scene_material glow = {.emission = triple(&w, 3, 2, 0.5f)};
    scene_mesh_set_material(world_mesh(&w, "plane.obj"), &glow, &w.memory);
    picture got = end(&w, p, 4);
    near(got, 0, 3);
    near(got, 1, 2);
    near(got, 2, 0.5);
}

// What was gathered before is of another scene.
static void a_material_that_changes_begins_anew(void **state) {
    pass_world w;
    pass *p = begin(&w, *state, nothing);
    scene_material glow = {.emission = triple(&w, 3, 3, 3)};
    scene_mesh_set_material(world_mesh(&w, "plane.obj"), &glow, &w.memory);
    gpu_test_ok(pass_declare(p));
    world_render(&w, 8, 8, pass_output(p, "color"));
    uint32_t samples;
    for (uint32_t still = 1; still <= 2; still++) {
        assert_true(pass_samples(p, &samples) && samples == still * SAMPLES);
        world_frame(&w, 8, 8, 1);
    }
    glow.emission = triple(&w, 1, 1, 1);
    world_frame(&w, 8, 8, 1);
    assert_true(pass_samples(p, &samples) && samples == SAMPLES);
    float *c = world_read(&w, pass_output(p, "color"));
    for (int i = 0; i < 8 * 8; i++) assert_true(fabsf(c[4 * i] - 1) < 0.01f);
    mem_free(c);
    world_close(&w);
}

// ---- beside the march
// -----------------------------------------------------------------------------

static void march_without_approximations_shows_the_same(void **state) {
    pass_world w;
    pass *p = begin(&w, *state, soft_ball);
    sun(&w, 200, 30, 4);
    set(&w, p, "bounces", 1);
    set(&w, p, "sky_alpha", 0);
    picture traced = end(&w, p, 128);

    world_open(&w, *state);
    w.scene.camera.fov = number(&w, 1);
    sun(&w, 200, 30, 4);
    p = world_add(&w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(p, "density", soft_ball(&w)));
    set3(&w, p, "albedo", 1, 1, 1);
    set(&w, p, "ambient", 0);
    set(&w, p, "early_exit", 0);
    set(&w, p, "steps", 256);
    set(&w, p, "shadow_steps", 64);
    picture marched = end(&w, p, 0);
    for (int c = 0; c < 4; c++) near(traced, c, marched.mean[c]);
}

static void reach_beside_the_medium_is_that_of_the_scene(void **state) {
    pass_world w;
    pass *p = begin(&w, *state, thick);
    w.scene.camera.fov = number(&w, 60);
    pass *wall = world_add(&w, NULL, "wall.comp", "wall");
    gpu_test_ok(pass_set_uniform(wall, "distance_to", number(&w, 20)));
    gpu_test_ok(pass_declare(wall));
    gpu_test_ok(pass_set_image(p, "depth", pass_output(wall, "depth")) && pass_declare(p));
    world_render(&w, SIZE, SIZE, pass_output(p, "reach"));
    float *reach = world_read_depth(&w, pass_output(p, "reach"));
    const float corner = 20 * sqrtf(1 + 2 * powf(w.frame.lens.v[1] * (SIZE - 1) / SIZE, 2));
    assert_true(fabsf(reach[0] - corner) < 0.01f);
    assert_true(reach[SIZE / 2 * SIZE + SIZE / 2] < 6); // in the medium
    mem_free(reach);
    world_close(&w);
}

// ---- gathering
// ------------------------------------------------------------------------------------

static double noise_of(gpu *device, int samples) {
    pass_world w;
    pass *p = begin(&w, device, thick);
    white_sky(&w);
    return end(&w, p, samples).error[0];
}

static void noise_falls_with_the_root_of_the_samples(void **state) {
    double ratio = noise_of(*state, 16) / noise_of(*state, 256);
    if (fabs(ratio - 4) > 0.8) fail_msg("16 times the samples: noise / %.2f, not / 4", ratio);
}

static uint32_t samples_of(const pass *p) {
    uint32_t samples = 0;
    assert_true(pass_samples(p, &samples));
    return samples;
}

static void picture_begins_anew_when_something_changes(void **state) {
    pass_world w;
    pass *p = begin(&w, *state, thick);
    white_sky(&w);
    gpu_test_ok(pass_declare(p));
    world_render(&w, SIZE, SIZE, pass_output(p, "color"));
    float *first = world_read(&w, pass_output(p, "color"));
    world_frame(&w, SIZE, SIZE, 1);
    float *more = world_read(&w, pass_output(p, "color"));
    assert_int_equal(samples_of(p), 2 * SAMPLES);
    assert_memory_not_equal(first, more, PIXELS * 4 * sizeof *first);
    mem_free(more);

    w.scene.sky.strength = number(&w, 2);
    world_frame(&w, SIZE, SIZE, 1);
    picture twice = measure(&w, p);
    assert_int_equal(samples_of(p), SAMPLES);
    assert_true(fabs(twice.mean[0] - 2) < 4 * twice.error[0] && twice.error[0] < 0.1);

    w.scene.sky.strength = number(&w, 1); // as before: the same bits
    for (int i = 0; i < 2; i++) {
        w.host.fresh = i == 1;
        world_frame(&w, SIZE, SIZE, 1);
        float *again = world_read(&w, pass_output(p, "color"));
        assert_memory_equal(first, again, PIXELS * 4 * sizeof *first);
        mem_free(again);
    }
    mem_free(first);
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_furnace_shows_only_the_sky),
        cmocka_unit_test(coloured_extinction_keeps_the_furnace_white),
        cmocka_unit_test(sharp_phase_functions_keep_the_furnace_white),
        cmocka_unit_test(bounds_that_are_too_low_cost_noise_only),
        cmocka_unit_test(absorption_takes_light_away),
        cmocka_unit_test(what_no_point_has_met_is_seen_all_the_same),
        cmocka_unit_test(sky_behind_a_slab_follows_beer_and_lambert),
        cmocka_unit_test(absorption_color_lets_its_colour_through),
        cmocka_unit_test(clear_sky_leaves_the_opacity_of_the_medium),
        cmocka_unit_test(glowing_slab_has_the_light_of_its_depth),
        cmocka_unit_test(sunlight_scattered_once_has_its_closed_form),
        cmocka_unit_test(wide_sun_is_the_mean_of_its_disc),
        cmocka_unit_test(white_crate_in_a_white_sky_is_white),
        cmocka_unit_test(gradient_of_the_sky_lights_a_wall),
        cmocka_unit_test(glowing_sphere_lights_a_wall_as_a_point_does),
        cmocka_unit_test(what_a_material_gives_off_is_seen),
        cmocka_unit_test(a_material_that_changes_begins_anew),
        cmocka_unit_test(march_without_approximations_shows_the_same),
        cmocka_unit_test(reach_beside_the_medium_is_that_of_the_scene),
        cmocka_unit_test(noise_falls_with_the_root_of_the_samples),
        cmocka_unit_test(picture_begins_anew_when_something_changes),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
