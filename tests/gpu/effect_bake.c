// Fields baked to grids each frame, without a script: the C interface is enough.
#include "effect_test.h"

enum { SIZE = 33, PIXELS = SIZE * SIZE };

static const uint32_t size32[3] = {32, 32, 32};
static const box3 around = {{-1.05f, -1.05f, -1.05f}, {1.05f, 1.05f, 1.05f}};

static field_grid *add_bake(effect *e, const field *node, const uint32_t size[3], box3 box) {
    return effect_add_bake(e, node,
                           &(effect_bake_desc){.size = {size[0], size[1], size[2]}, .box = box});
}

typedef struct variant {
    uint32_t voxels; // along each side; 0: the field itself
    const char *sampling;
    double frame;
} variant;

// A ball, 0 at its rim and 1 in the middle, whose radius falls from 1 m to 0.5 m in a second.
static const field *shrinking_ball(effect *e) {
    static const curve_key keys[] = {{0, {1}}, {1, {0.5f}}};
    const curve *c =
        curve_create(effect_memory(e), &(curve){CURVE_LINEAR, 1, keys, COUNT_OF(keys), 0});
    gpu_test_ok(c);
    const field *radius = field_curve(effect_memory(e), c);
    return make(e, "sphere", triple(e, 0, 0, 0), radius, radius);
}

static float *march(gpu *device, variant v) {
    effect *e = open_effect(&(effect_desc){.device = device});
    gpu_test_ok(effect_set_timeline(e, 10, 11, 1));
    const field *ball = shrinking_ball(e);
    if (v.voxels) {
        const uint32_t size[3] = {v.voxels, v.voxels, v.voxels};
        field_grid *grid = add_bake(e, ball, size, around);
        gpu_test_ok(grid);
        ball = field_grid_channel(effect_memory(e), grid, 0, 1);
    }
    pass *p = add_march(e, make(e, "mul", ball, number(e, 2)));
    gpu_test_ok(pass_set_option(p, "sampling", v.sampling));
    finish(e, p, SIZE, SIZE);
    gpu_test_ok(effect_render(e, v.frame, false));
    float *pixels = read_picture(e);
    effect_destroy(e);
    return pixels;
}

// Greatest difference of opacity from that of the field itself. The field has kinks at its rim and
// in its middle, which a grid of voxels of size h misses by about h / 8 over a length of some h.
static float worst_error(gpu *device, const float *direct, variant v) {
    float *baked = march(device, v), worst = 0;
    for (int k = 0; k < PIXELS; k++)
        worst = fmaxf(worst, fabsf(baked[4 * k + 3] - direct[4 * k + 3]));
    mem_free(baked);
    return worst;
}

static void baked_field_equals_the_field_itself(void **state) {
    static const struct {
        const char *sampling;
        float tolerance;
    } cases[] = {
        {"linear", 0.012f}, {"quasi_cubic", 0.012f}, {"cubic", 0.018f}}; // B-splines smooth
    for (double frame = 1; frame <= 6; frame += 5) {
        float *direct = march(*state, (variant){0, "linear", frame});
        assert_true(direct[4 * (PIXELS / 2) + 3] > 0.5f);
        for (size_t i = 0; i < COUNT_OF(cases); i++) {
            float coarse = worst_error(*state, direct, (variant){32, cases[i].sampling, frame});
            float fine = worst_error(*state, direct, (variant){64, cases[i].sampling, frame});
            if (!(coarse <= cases[i].tolerance && fine <= 0.6f * coarse))
                fail_msg("%s, frame %g: opacity is off by %g at 32, %g at 64", cases[i].sampling,
                         frame, (double)coarse, (double)fine);
        }
        mem_free(direct);
    }
}

static void four_channels_are_baked_at_once(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    const field *node = field_constant(effect_memory(e), 4, (float[4]){0.5f, 0.25f, 2, 1});
    field_grid *grid = add_bake(e, node, (uint32_t[3]){2, 3, 4}, around);
    gpu_test_ok(grid);
    pass *p = add_march(e, field_grid_channel(effect_memory(e), grid, 3, 1));
    gpu_test_ok(pass_set_field(p, "radiance", field_grid_channel(effect_memory(e), grid, 0, 3)));
    finish(e, p, SIZE, SIZE);
    float alpha = middle(e, 1, SIZE, 3), red = middle(e, 1, SIZE, 0), blue = middle(e, 1, SIZE, 2);
    assert_true(fabs((double)alpha - (1 - exp(-2.1))) < 0.003);
    assert_true(fabsf(red - 0.5f * alpha) < 0.002f && fabsf(blue - 2 * alpha) < 0.004f);
    effect_destroy(e);
}

static size_t place_of(effect *e, const char *label) { // SIZE_MAX: does not run
    const char *names[16];
    size_t count = graph_order(effect_graph(e), names, COUNT_OF(names));
    for (size_t i = 0; i < count; i++)
        if (strcmp(names[i], label) == 0) return i;
    return SIZE_MAX;
}

static void march_runs_after_the_bakes_that_it_reads(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    field_grid *first = add_bake(e, shrinking_ball(e), size32, around);
    gpu_test_ok(first);
    // A bake of a bake, and one that nobody reads.
    const field *inner = field_grid_channel(effect_memory(e), first, 0, 1);
    field_grid *second = add_bake(e, make(e, "mul", inner, number(e, 2)), size32, around);
    gpu_test_ok(second && add_bake(e, number(e, 1), size32, around));
    pass *p = add_march(e, field_grid_channel(effect_memory(e), second, 0, 1));
    finish(e, p, SIZE, SIZE);
    size_t march_place = place_of(e, "march");
    assert_true(place_of(e, "bake") < place_of(e, "bake_2"));
    assert_true(place_of(e, "bake_2") < march_place && march_place < SIZE_MAX);
    assert_true(place_of(e, "bake_3") == SIZE_MAX);
    float *direct = march(*state, (variant){32, "quasi_cubic", 1});
    assert_true(fabsf(middle(e, 1, SIZE, 3) - direct[4 * (PIXELS / 2) + 3]) < 0.01f);
    mem_free(direct);
    effect_destroy(e);
}

// Times that the grid was computed.
static uint64_t computed(const field_grid *grid) {
    return grid->state.content;
}

static void what_has_not_changed_is_not_computed_again(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    gpu_test_ok(effect_set_timeline(e, 10, 11, 1));
    const field *factor = param(e, "factor", 1, 10);
    const field *ball = make(e, "sphere", triple(e, 0, 0, 0), number(e, 1), number(e, 1));
    field_grid *still = add_bake(e, make(e, "mul", ball, factor), size32, around);
    gpu_test_ok(still);
    const field *inner = field_grid_channel(effect_memory(e), still, 0, 1);
    field_grid *second = add_bake(e, make(e, "mul", inner, number(e, 2)), size32, around);
    field_grid *moving = add_bake(e, shrinking_ball(e), size32, around);
    gpu_test_ok(second && moving);
    const field *outer = field_grid_channel(effect_memory(e), second, 0, 1);
    const field *other = field_grid_channel(effect_memory(e), moving, 0, 1);
    pass *p = add_march(e, make(e, "add", outer, make(e, "mul", other, number(e, 0))));
    finish(e, p, SIZE, SIZE);

    float once = middle(e, 1, SIZE, 3);
    assert_true(middle(e, 2, SIZE, 3) == once);
    assert_int_equal(computed(still), 1);
    assert_int_equal(computed(second), 1);
    assert_int_equal(computed(moving), 2);

    assert_true(effect_set(e, "factor", "0.5"));
    assert_true(middle(e, 3, SIZE, 3) < 0.9f * once);
    assert_int_equal(computed(still), 2);
    assert_int_equal(computed(second), 2); // what it samples was made anew

    gpu_test_ok(effect_allocate(e, SIZE + 2, SIZE + 2)); // another size of the picture
    middle(e, 4, SIZE + 2, 3);
    middle(e, 9, SIZE + 2, 3); // a jump
    assert_int_equal(computed(still), 2);
    effect_destroy(e);
}

static void one_component_takes_one_channel(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    const field *ball = make(e, "sphere", triple(e, 0, 0, 0), number(e, 1), number(e, 1));
    field_grid *grid = add_bake(e, ball, size32, around);
    gpu_test_ok(grid);
    graph_image image = graph_find_image(effect_graph(e), "bake");
    assert_int_equal(graph_get_desc(effect_graph(e), image)->format, GPU_R16F);
    effect_destroy(e);
}

// Perlin noise of which 4 cells repeat, on a picture of 3 x 3 m: 6 cells, so one and a half tiles.
static float *draw_noise(gpu *device, bool tile, float width) {
    effect *e = open_effect(&(effect_desc){.device = device});
    const field *args[FIELD_MAX_ARGS] = {number(e, 2), number(e, 1)};
    args[9] = number(e, 4); // period
    const field *noise = effect_field(e, "perlin", args);
    if (tile) noise = effect_add_tile(e, noise, &(effect_tile_desc){64, 4, 1, .levels = true});
    gpu_test_ok(noise);
    pass *p = add(e, NULL, "plane.comp");
    gpu_test_ok(pass_set_field(p, "value", noise));
    gpu_test_ok(pass_set_uniform(p, "width", number(e, width)));
    finish(e, p, SIZE, SIZE);
    gpu_test_ok(effect_render(e, 1, false));
    float *pixels = read_picture(e);
    effect_destroy(e);
    return pixels;
}

static void tile_fills_space_and_has_levels(void **state) {
    float *direct = draw_noise(*state, false, 0), *tile = draw_noise(*state, true, 0);
    float *wide = draw_noise(*state, true, 1000);
    double least = 1, most = 0, mean = 0;
    for (int k = 0; k < PIXELS; k++) {
        double want = (double)direct[4 * k];
        if (fabs((double)tile[4 * k] - want) > 0.02)
            fail_msg("pixel %d: %g instead of %g", k, (double)tile[4 * k], want);
        least = fmin(least, want);
        most = fmax(most, want);
        mean += (double)wide[4 * k] / PIXELS;
    }
    assert_true(most - least > 0.3 && fabs(mean - 0.5) < 0.05);
    for (int k = 0; k < PIXELS; k++) assert_true(fabs((double)wide[4 * k] - mean) < 1e-3);
    mem_free(direct);
    mem_free(tile);
    mem_free(wide);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(baked_field_equals_the_field_itself),
        cmocka_unit_test(four_channels_are_baked_at_once),
        cmocka_unit_test(march_runs_after_the_bakes_that_it_reads),
        cmocka_unit_test(what_has_not_changed_is_not_computed_again),
        cmocka_unit_test(one_component_takes_one_channel),
        cmocka_unit_test(tile_fills_space_and_has_levels),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
