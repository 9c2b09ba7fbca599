// The stack of slices that face the camera, against what the integral of emission and absorption
// says; and its picture, whose size is its own.
#include "pass_test.h"

enum { SIDE = 64, CENTRE = (SIDE / 2) * SIDE + SIDE / 2 };

typedef struct slab {
    float density, radiance, wall; // wall: depth, 0: none
    int slices;
} slab;

// The centre texel of a block 2 m deep, its near face 4 m away. Slices lie through the box alone,
// so that none is lost.
static void stack_slab(gpu *device, slab s, float out[4]) {
    pass_world w;
    world_open(&w, device);
    pass *p = world_add(&w, "stack", NULL, "stack");
    gpu_test_ok(pass_set_field(p, "density", block(&w, 1, s.density)));
    gpu_test_ok(pass_set_field(p, "radiance", triple(&w, s.radiance, s.radiance / 2, 0)));
    gpu_test_ok(pass_set_uniform(p, "slices", number(&w, (float)s.slices)));
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(&w, 0)));
    gpu_test_ok(pass_set_uniform(p, "ambient", number(&w, 0)));
    gpu_test_ok(pass_set_option(p, "target", "64"));
    if (s.wall > 0) {
        pass *wall = world_add(&w, NULL, "wall.comp", "wall");
        gpu_test_ok(pass_set_uniform(wall, "distance_to", number(&w, s.wall)));
        gpu_test_ok(pass_declare(wall));
        gpu_test_ok(pass_set_image(p, "depth", pass_output(wall, "depth")));
    }
    gpu_test_ok(pass_declare(p));
    world_render(&w, 17, 11, pass_output(p, "color"));
    const gpu_image_desc *size =
        gpu_image_get_desc(graph_get_image(w.host.graph, pass_output(p, "color")));
    assert_int_equal(size->width, SIDE);
    assert_int_equal(size->height, SIDE);
    float *pixels = world_read(&w, pass_output(p, "color"));
    memcpy(out, pixels + CENTRE * 4, 4 * sizeof *out);
    mem_free(pixels);
    world_close(&w);
}

static void near(float got, double wanted) {
    if (fabs((double)got - wanted) > 0.02 * fabs(wanted) + 1e-6)
        fail_msg("%.6f, not %.6f", (double)got, wanted);
}

static void a_slab_follows_beer_and_lambert(void **state) {
    for (float density = 0.05f; density < 5; density *= 3) {
        float c[4];
        stack_slab(*state, (slab){.density = density, .radiance = 2, .slices = 64}, c);
        double opacity = 1 - exp(-2 * (double)density);
        near(c[3], opacity);
        near(c[0], 2 * opacity);
        near(c[1], opacity);
    }
}

static void few_slices_are_as_opaque_as_many(void **state) {
    const int slices[] = {1, 2, 8, 128};
    for (size_t i = 0; i < COUNT_OF(slices); i++) {
        float c[4];
        stack_slab(*state, (slab){.density = 0.7f, .radiance = 1, .slices = slices[i]}, c);
        near(c[3], 1 - exp(-1.4));
    }
}

static void what_lies_behind_a_surface_is_not_seen(void **state) {
    float c[4];
    stack_slab(*state, (slab){.density = 0.5f, .radiance = 1, .slices = 256, .wall = 5}, c);
    near(c[3], 1 - exp(-0.5));
    stack_slab(*state, (slab){.density = 0.5f, .radiance = 1, .slices = 256, .wall = 3}, c);
    assert_float_equal(c[3], 0, 0);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slab_follows_beer_and_lambert),
        cmocka_unit_test(few_slices_are_as_opaque_as_many),
        cmocka_unit_test(what_lies_behind_a_surface_is_not_seen),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
