// Noise as a tile: it repeats, is the noise itself in one period, and is sampled where that is.
#include "field_build.h"

enum { CELLS = 6 };

static const float3 places[] = {{0.3f, 1.7f, -2.2f}, {-4.1f, 0.25f, 3.9f}, {11.5f, -7.3f, 0.6f}};

// A grid that is what it was baked from, without loss.
typedef struct exact_grid {
    field_grid grid;
    const field *content;
    double time;
} exact_grid;

static bool sample(const field_grid *grid, float3 p, int channel, float *out) {
    const exact_grid *exact = (const exact_grid *)grid;
    field_context context = {.time = exact->time};
    float value[4];
    if (!field_eval(exact->content, &context, p, value)) return false;
    *out = value[channel];
    return true;
}

static exact_grid bake(const field_tile *tile) {
    return (exact_grid){.grid = {.box = {{0, 0, 0}, {tile->cells, tile->cells, tile->cells}},
                                 .size = {64, 64, 64},
                                 .channel_count = tile->content->components,
                                 .repeats = true,
                                 .sample = sample},
                        .content = tile->content};
}

static const field *sampled(const field_tile *tile, const exact_grid *baked) {
    const field *grid =
        field_grid_channel(build_memory(), &baked->grid, 0, tile->content->components);
    return need_field(field_tile_sample(build_memory(), tile, grid));
}

static void assert_equal(const field *a, const field *b, double time, float3 by) {
    field_context context = {.time = time};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        float3 p = places[i], q = {p.x + by.x, p.y + by.y, p.z + by.z};
        float x[4], y[4];
        assert_true(field_eval(a, &context, p, x) && field_eval(b, &context, q, y));
        for (int c = 0; c < a->components; c++)
            if (fabsf(x[c] - y[c]) > 2e-3f)
                fail_msg("component %d: %g and %g", c, (double)x[c], (double)y[c]);
    }
}

static field *noise(const char *kind, float octaves, float period) {
    return row(kind, SET("frequency", number(1.5f)), SET("octaves", number(octaves)),
               SET("seed", number(5)), SET("drift", vector(0.5f, -1, 0.25f)),
               SET("period", number(period)));
}

static void tile_of_one_octave_is_the_noise_with_that_period(void **state) {
    (void)state;
    static const char *const kinds[] = {"perlin", "value", "simplex", "worley", "curl"};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        field_tile tile;
        assert_true(field_tile_create(build_memory(), noise(kinds[i], 1, 0), CELLS, 1, &tile));
        exact_grid baked = bake(&tile);
        assert_equal(sampled(&tile, &baked), noise(kinds[i], 1, CELLS), 0, (float3){0, 0, 0});
        baked.time = 1.75; // the drift is not in the tile
        assert_equal(sampled(&tile, &baked), noise(kinds[i], 1, CELLS), 1.75, (float3){0, 0, 0});
    }
}

static void octaves_are_samples_whose_weights_add_up(void **state) {
    (void)state;
    field *n = row("worley", SET("frequency", number(2)), SET("octaves", number(4)),
                   SET("persistence", number(0.7f)), SET("lacunarity", number(2.1f)),
                   SET("amplitude", number(3)));
    field_tile tile;
    assert_true(field_tile_create(build_memory(), n, CELLS, 1, &tile));
    assert_int_equal(tile.samples, 4);
    exact_grid baked = bake(&tile);
    baked.content = number(0.5f);
    assert_true(fabsf(value_at(sampled(&tile, &baked), 0, places[0]) - 1.5f) < 1e-5f);
    // Octaves differ: four equal ones would have the contrast of one.
    baked.content = tile.content;
    double sum = 0, squares = 0, one = 0, one_squares = 0;
    enum { COUNT = 2000 };
    const field *octaves = sampled(&tile, &baked);
    uint32_t seed = 1;
    for (int i = 0; i < COUNT; i++) {
        float3 p = random_point(&seed, 20);
        double all = (double)value_at(octaves, 0, p) / 3;
        double first = (double)value_at(tile.content, 0, p);
        sum += all, squares += all * all, one += first, one_squares += first * first;
    }
    double spread = squares / COUNT - sum * sum / COUNT / COUNT;
    double spread_of_one = one_squares / COUNT - one * one / COUNT / COUNT;
    assert_true(fabs(sum - one) / COUNT < 0.02);
    // Weights 1, 0.7 ... of patterns that know nothing of each other: sum w^2 / (sum w)^2.
    assert_true(fabs(spread / spread_of_one - 0.2884) < 0.05);
}

static void octaves_together_are_the_noise_with_that_period(void **state) {
    (void)state;
    field_tile tile;
    assert_true(field_tile_create(build_memory(), noise("perlin", 3, 0), CELLS, 3, &tile));
    exact_grid baked = bake(&tile);
    assert_equal(sampled(&tile, &baked), noise("perlin", 3, CELLS), 0, (float3){0, 0, 0});
}

static field *swirled(float period) {
    field *by = row("curl", SET("frequency", number(3)), SET("period", number(2 * period)),
                    SET("drift", vector(0.5f, -1, 0.25f)));
    return row("warp", SET("value", noise("worley", 1, period)), SET("by", by),
               SET("amount", number(0.2f)));
}

static void expression_of_noises_repeats_as_a_whole(void **state) {
    (void)state;
    field_tile tile;
    assert_true(field_tile_create(build_memory(), swirled(0), CELLS, 1, &tile));
    assert_int_equal(tile.samples, 1);
    exact_grid baked = bake(&tile);
    assert_equal(sampled(&tile, &baked), swirled(CELLS), 0, (float3){0, 0, 0});
    const float metres = CELLS / 1.5f;
    assert_equal(sampled(&tile, &baked), sampled(&tile, &baked), 0, (float3){metres, -metres, 0});
    baked.time = 2; // both drift alike
    assert_equal(sampled(&tile, &baked), swirled(CELLS), 2, (float3){0, 0, 0});
}

static void what_does_not_repeat_is_refused(void **state) {
    (void)state;
    field_tile tile;
    assert_false(field_tile_create(build_memory(), make("sphere", NULL), CELLS, 1, &tile));
    assert_error("there is no noise in it");
    field *both = row("mul", SET("a", noise("perlin", 1, 0)), SET("b", make("sphere", NULL)));
    assert_false(field_tile_create(build_memory(), both, CELLS, 1, &tile));
    assert_error("'sphere' does not repeat");
}

// Two patterns of an advected tile, and those of the next period, are other parts of it.
static void advected_tile_is_made_anew_from_other_parts(void **state) {
    (void)state;
    field_tile tile;
    assert_true(field_tile_create(build_memory(), noise("perlin", 1, 0), CELLS, 1, &tile));
    exact_grid baked = bake(&tile);
    field *a = row("advect", SET("value", sampled(&tile, &baked)), SET("velocity", vector(0, 0, 0)),
                   SET("period", number(1)));
    const float first = value_at(a, 0.25, places[0]), next = value_at(a, 1.25, places[0]);
    assert_true(fabsf(first - next) > 1e-3f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tile_of_one_octave_is_the_noise_with_that_period),
        cmocka_unit_test(octaves_are_samples_whose_weights_add_up),
        cmocka_unit_test(octaves_together_are_the_noise_with_that_period),
        cmocka_unit_test(expression_of_noises_repeats_as_a_whole),
        cmocka_unit_test(what_does_not_repeat_is_refused),
        cmocka_unit_test(advected_tile_is_made_anew_from_other_parts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
