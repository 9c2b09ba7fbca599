// The march against what the integral of emission and absorption says.
#include "pass_test.h"

enum { SIZE = 17, CENTRE = (SIZE / 2) * SIZE + SIZE / 2 };

typedef struct slab {
    float density, radiance, emission, wall; // wall: depth, 0: none
    int steps;
    float step_size;
    const char *mode;
} slab;

// The centre pixel of a block 2 m deep, its near face 4 m away.
static void march_slab(gpu *device, slab s, float out[4]) {
    pass_world w;
    world_open(&w, device);
    pass *p = world_add(&w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(p, "density", block(&w, 1, s.density)));
    gpu_test_ok(pass_set_field(p, "radiance", triple(&w, s.radiance, s.radiance / 2, 0)));
    gpu_test_ok(pass_set_field(p, "emission", triple(&w, s.emission, 0, 0)));
    gpu_test_ok(pass_set_uniform(p, "steps", number(&w, (float)s.steps)));
    gpu_test_ok(pass_set_uniform(p, "step_size", number(&w, s.step_size)));
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(&w, 0)));
    gpu_test_ok(pass_set_uniform(p, "shadow_steps", number(&w, 0)));
    if (s.mode) gpu_test_ok(pass_set_option(p, "mode", s.mode));
    if (s.wall > 0) {
        pass *wall = world_add(&w, NULL, "wall.comp", "wall");
        gpu_test_ok(pass_set_uniform(wall, "distance_to", number(&w, s.wall)));
        gpu_test_ok(pass_declare(wall));
        gpu_test_ok(pass_set_uniform(p, "depth_bias", number(&w, 0)));
        gpu_test_ok(pass_set_image(p, "depth", pass_output(wall, "depth")));
    }
    gpu_test_ok(pass_declare(p));
    world_render(&w, SIZE, SIZE, pass_output(p, "color"));
    float *pixels = world_read(&w, pass_output(p, "color"));
    memcpy(out, pixels + CENTRE * 4, 4 * sizeof *out);
    mem_free(pixels);
    world_close(&w);
}

static void near(float got, double wanted, double relative) {
    if (fabs((double)got - wanted) > relative * fabs(wanted) + 1e-6)
        fail_msg("%.6f, not %.6f (+- %g %%)", (double)got, wanted, relative * 100);
}

static void slab_follows_beer_lambert_within_one_percent_at_64_steps(void **state) {
    for (float density = 0.05f; density < 5; density *= 3) {
        float c[4];
        march_slab(*state, (slab){.density = density, .radiance = 2, .steps = 64}, c);
        double opacity = 1 - exp(-2 * (double)density);
        near(c[3], opacity, 0.01);
        near(c[0], 2 * opacity, 0.01);
        near(c[1], opacity, 0.01);
    }
}

static void emission_does_not_depend_on_the_number_of_steps(void **state) {
    double wanted = 3 * (1 - exp(-2 * 0.7)) / 0.7;
    const int steps[] = {1, 4, 16, 64, 256};
    for (size_t i = 0; i < COUNT_OF(steps); i++) {
        float c[4];
        march_slab(*state, (slab){.density = 0.7f, .emission = 3, .steps = steps[i]}, c);
        near(c[0], wanted, 0.005);
    }
}

static void step_size_in_metres_gives_the_same_slab(void **state) {
    const float sizes[] = {0.3f, 0.07f, 0.013f}; // none divides the slab: the last step is shorter
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        float c[4];
        march_slab(*state, (slab){.density = 1, .steps = 1, .step_size = sizes[i]}, c);
        near(c[3], 1 - exp(-2.0), 0.005);
    }
}

static void wall_in_the_slab_cuts_the_ray_exactly(void **state) {
    const float walls[] = {3.9f, 4.5f, 5.0f, 5.25f, 7};
    for (size_t i = 0; i < COUNT_OF(walls); i++) {
        float c[4];
        double seen = fmin(fmax((double)walls[i] - 4, 0), 2);
        march_slab(*state, (slab){.density = 0.8f, .steps = 64, .wall = walls[i]}, c);
        near(c[3], 1 - exp(-0.8 * seen), 0.01);
    }
}

static void paper_mode_is_opacity_over_steps(void **state) {
    // alpha := alpha + (1 - alpha) w o / N over N equal samples, all of density 0.5.
    const int steps[] = {16, 64, 128};
    for (size_t i = 0; i < COUNT_OF(steps); i++) {
        float c[4];
        march_slab(*state,
                   (slab){.density = 0.5f, .radiance = 1, .steps = steps[i], .mode = "paper"}, c);
        double wanted = 1 - pow(1 - 0.5 * 20 / steps[i], steps[i]);
        near(c[3], wanted, 0.01);
        near(c[0], wanted, 0.01);
    }
}

static void camera_inside_the_volume_sees_what_lies_ahead(void **state) {
    pass_world w;
    world_open(&w, *state);
    w.scene.camera.eye = triple(&w, 0, 0, 0);
    w.scene.camera.target = triple(&w, 0, 1, 0);
    pass *p = world_add(&w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(p, "density", block(&w, 1, 1)));
    gpu_test_ok(pass_set_uniform(p, "shadow_steps", number(&w, 0)));
    gpu_test_ok(pass_declare(p));
    world_render(&w, SIZE, SIZE, pass_output(p, "color"));
    float *pixels = world_read(&w, pass_output(p, "color"));
    near(pixels[CENTRE * 4 + 3], 1 - exp(-1.0), 0.01);
    mem_free(pixels);
    world_close(&w);
}

static void two_runs_are_bit_identical(void **state) {
    float pixels[2][SIZE * SIZE * 4];
    for (int run = 0; run < 2; run++) {
        pass_world w;
        world_open(&w, *state);
        pass *p = world_add(&w, "march", NULL, "march");
        gpu_test_ok(pass_set_field(p, "density", block(&w, 1, 1.3f)));
        gpu_test_ok(pass_set_uniform(p, "jitter", number(&w, 1)));
        gpu_test_ok(pass_set_uniform(p, "steps", number(&w, 7)));
        gpu_test_ok(pass_declare(p));
        world_render(&w, SIZE, SIZE, pass_output(p, "color"));
        float *read = world_read(&w, pass_output(p, "color"));
        memcpy(pixels[run], read, sizeof pixels[run]);
        mem_free(read);
        world_close(&w);
    }
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
}

static void density_that_fills_space_is_refused(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *p = world_add(&w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(p, "density", number(&w, 1)));
    assert_false(pass_declare(p));
    assert_non_null(strstr(err_get(), "fills all of space"));
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(slab_follows_beer_lambert_within_one_percent_at_64_steps),
        cmocka_unit_test(emission_does_not_depend_on_the_number_of_steps),
        cmocka_unit_test(step_size_in_metres_gives_the_same_slab),
        cmocka_unit_test(wall_in_the_slab_cuts_the_ray_exactly),
        cmocka_unit_test(paper_mode_is_opacity_over_steps),
        cmocka_unit_test(camera_inside_the_volume_sees_what_lies_ahead),
        cmocka_unit_test(two_runs_are_bit_identical),
        cmocka_unit_test(density_that_fills_space_is_refused),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
