// How many samples the march takes and what they cost in error; where what it shows lies; shadows
// from the cache of the pass lighting against its own.
#include "pass_test.h"

enum { SIZE = 17, CENTRE = (SIZE / 2) * SIZE + SIZE / 2, PIXELS = SIZE * SIZE };

static void near(double got, double wanted, double relative) {
    if (fabs(got - wanted) > relative * fabs(wanted) + 1e-6)
        fail_msg("%.6f, not %.6f (+- %g %%)", got, wanted, relative * 100);
}

static const field *ball(pass_world *w, float y, float radius) {
    return row(w, "sphere", SET("position", triple(w, 0, y, 0)), SET("radius", number(w, radius)),
               SET("falloff", number(w, 0.5f * radius)));
}

static const field *sum(pass_world *w, const field *a, const field *b) {
    return row(w, "add", SET("a", a), SET("b", b));
}

static pass *add_march(pass_world *w, const field *density, float steps) {
    pass *p = world_add(w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(p, "density", density));
    gpu_test_ok(pass_set_uniform(p, "steps", number(w, steps)));
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(w, 0)));
    return p;
}

// The red channel of the picture, and its samples. Closes the world.
static uint64_t render(pass_world *w, pass *p, float red[PIXELS]) {
    uint64_t counted[2];
    gpu_test_ok(pass_declare(p));
    world_render(w, SIZE, SIZE, pass_output(p, "color"));
    gpu_test_ok(pass_read_counters(p, counted));
    float *pixels = world_read(w, pass_output(p, "color"));
    for (int i = 0; i < PIXELS; i++) red[i] = pixels[4 * i];
    mem_free(pixels);
    world_close(w);
    return counted[0];
}

// ---- steps of variable length -----------------------------------------------------------------

// Two small fires far behind each other, with nothing between, where even steps are taken too. A
// sharp one glows from its edge on.
static uint64_t two_fires(gpu *device, bool sharp, float steps, float tolerance,
                          float red[PIXELS]) {
    pass_world w;
    world_open(&w, device);
    w.host.counters = true;
    const field *fires = sum(&w, ball(&w, 0, 0.6f), ball(&w, 9, 1.5f));
    const field *density = number(&w, sharp ? 20 : 3);
    pass *p = add_march(&w, row(&w, "mul", SET("a", fires), SET("b", density)), steps);
    gpu_test_ok(pass_set_option(p, "skipping", "off"));
    gpu_test_ok(pass_set_field(p, sharp ? "emission" : "radiance", triple(&w, 4, 1, 0)));
    gpu_test_ok(pass_set_uniform(p, "tolerance", number(&w, tolerance)));
    return render(&w, p, red);
}

static double worst(const float a[PIXELS], const float b[PIXELS]) {
    double most = 0;
    for (int i = 0; i < PIXELS; i++) most = fmax(most, fabs((double)a[i] - (double)b[i]));
    return most;
}

static void tolerance_bounds_the_error(void **state) {
    float exact[PIXELS], got[PIXELS];
    const float tolerances[] = {0.02f, 0.005f, 0.001f};
    two_fires(*state, false, 4096, 0, exact);
    for (size_t i = 0; i < COUNT_OF(tolerances); i++) {
        two_fires(*state, false, 128, tolerances[i], got);
        double error = worst(exact, got); // of some steps together, in a picture of half floats
        if (error > 4 * (double)tolerances[i] + 0.002)
            fail_msg("off by %g at a tolerance of %g", error, (double)tolerances[i]);
    }
}

static void variable_steps_take_fewer_samples_for_less_error(void **state) {
    float exact[PIXELS], even[PIXELS], variable[PIXELS];
    two_fires(*state, true, 4096, 0, exact);
    uint64_t even_samples = two_fires(*state, true, 64, 0, even);
    uint64_t samples = two_fires(*state, true, 64, 0.01f, variable);
    if (samples > even_samples * 3 / 4)
        fail_msg("%u samples, not much less than %u", (unsigned)samples, (unsigned)even_samples);
    if (worst(exact, variable) > worst(exact, even))
        fail_msg("off by %g, even steps by %g", worst(exact, variable), worst(exact, even));
}

static void variable_steps_end_where_nothing_is_good_enough(void **state) {
    float red[PIXELS];
    uint64_t samples = two_fires(*state, false, 16, 1e-9f, red);
    assert_true(samples > 0 && samples < (uint64_t)PIXELS * 16 * 8 * 3);
}

// ---- samples ----------------------------------------------------------------------------------

static uint64_t samples_from(gpu *device, float y, float red[PIXELS]) {
    pass_world w;
    world_open(&w, device);
    w.host.counters = true;
    w.scene.camera.eye = triple(&w, 0, y, 0);
    w.scene.camera.target = triple(&w, 0, y + 1, 0);
    pass *p = add_march(&w, block(&w, 50, 0.01f), 32);
    gpu_test_ok(pass_set_field(p, "radiance", triple(&w, 1, 1, 1)));
    return render(&w, p, red);
}

static void camera_inside_the_volume_costs_no_more_than_outside(void **state) {
    float outside[PIXELS], inside[PIXELS];
    assert_int_equal(samples_from(*state, -60, outside), PIXELS * 32); // fills the picture
    assert_int_equal(samples_from(*state, 0, inside), PIXELS * 32);
    assert_true(outside[CENTRE] > inside[CENTRE] && inside[CENTRE] > 0.3f);
}

// ---- reach ------------------------------------------------------------------------------------

static float reach_of(gpu *device, float density, int pixel) {
    pass_world w;
    world_open(&w, device);
    pass *wall = world_add(&w, NULL, "wall.comp", "wall");
    gpu_test_ok(pass_set_uniform(wall, "distance_to", number(&w, 20)));
    gpu_test_ok(pass_declare(wall));
    pass *p = add_march(&w, block(&w, 1, density), 256);
    gpu_test_ok(pass_set_image(p, "depth", pass_output(wall, "depth")));
    gpu_test_ok(pass_declare(p));
    world_render(&w, SIZE, SIZE, pass_output(p, "reach"));
    float *texels = world_read_depth(&w, pass_output(p, "reach"));
    float found = texels[pixel];
    mem_free(texels);
    world_close(&w);
    return found;
}

static void reach_is_where_the_opacity_lies(void **state) {
    near((double)reach_of(*state, 0.01f, CENTRE), 5, 0.01);
    near((double)reach_of(*state, 5, CENTRE), 4.2, 0.01);
    assert_true(reach_of(*state, 5, 0) > 20.1f); // beside the block: the wall, farther off-centre
}

// ---- shadows from the cache -------------------------------------------------------------------

static pass *lit_ball(pass_world *w, gpu *device) {
    world_open(w, device);
    w->scene.sun.strength = number(w, 20);
    w->scene.sun.azimuth = number(w, 20);
    w->scene.sun.elevation = number(w, 30);
    const field *density = row(w, "mul", SET("a", ball(w, 0, 1.5f)), SET("b", number(w, 2)));
    pass *p = add_march(w, density, 64);
    gpu_test_ok(pass_set_uniform(p, "shadow_steps", number(w, 64)));
    return p;
}

static void use_cache(pass_world *w, pass *p, float near_steps) {
    pass *lighting = world_add(w, "lighting", NULL, "lighting");
    size_t density;
    assert_int_equal(pass_find_key(p, "density", &density), PASS_FIELD);
    gpu_test_ok(pass_set_field(lighting, "density", pass_get_field(p, density)));
    gpu_test_ok(pass_set_option(lighting, "shadow_resolution", "32"));
    gpu_test_ok(pass_declare(lighting));
    gpu_test_ok(pass_set_image(p, "lights", pass_output(lighting, "lights")));
    gpu_test_ok(pass_set_image(p, "shadow", pass_output(lighting, "shadow")));
    gpu_test_ok(pass_set_uniform(p, "near_steps", number(w, near_steps)));
}

static void cached_shadows_are_those_of_steps_to_the_light(void **state) {
    float stepped[PIXELS], cached[PIXELS];
    pass_world w;
    pass *p = lit_ball(&w, *state);
    render(&w, p, stepped);
    const float near_steps[] = {0, 4};
    for (size_t n = 0; n < COUNT_OF(near_steps); n++) {
        p = lit_ball(&w, *state);
        use_cache(&w, p, near_steps[n]);
        render(&w, p, cached);
        double most = 0;
        for (int i = 0; i < PIXELS; i++) most = fmax(most, (double)stepped[i]);
        double error = worst(stepped, cached);
        assert_true(most > 0.1);
        if (error > 0.03 * most) fail_msg("off by %g of %g", error, most);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(tolerance_bounds_the_error),
        cmocka_unit_test(variable_steps_take_fewer_samples_for_less_error),
        cmocka_unit_test(variable_steps_end_where_nothing_is_good_enough),
        cmocka_unit_test(camera_inside_the_volume_costs_no_more_than_outside),
        cmocka_unit_test(reach_is_where_the_opacity_lies),
        cmocka_unit_test(cached_shadows_are_those_of_steps_to_the_light),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
