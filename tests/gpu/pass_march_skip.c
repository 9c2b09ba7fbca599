// The march that skips bricks against the one that takes every sample: the same picture, by fewer
// samples; and rays that have several threads against rays of one.
#include "pass_test.h"

enum { SIZE = 32, VALUES = SIZE * SIZE * 4 };

typedef struct picture {
    float color[VALUES], light[VALUES], reach[SIZE * SIZE];
    uint64_t samples, dense;
} picture;

typedef struct way { // of taking a picture
    bool skips, paper, jitters, lit;
    float tolerance, threads, steps, bricks, early_exit;
} way;

typedef const field *(*make_density)(pass_world *w);

static const field *scaled(pass_world *w, const field *a, float by) {
    return row(w, "mul", SET("a", a), SET("b", number(w, by)));
}

static const field *ball(pass_world *w, float x, float y, float z, float radius) {
    return row(w, "sphere", SET("position", triple(w, x, y, z)), SET("radius", number(w, radius)),
               SET("falloff", number(w, 0.4f * radius)));
}

// ---- densities --------------------------------------------------------------------------------

static const field *two_balls(pass_world *w) {
    return scaled(w,
                  row(w, "add", SET("a", ball(w, -1, 0, 0.6f, 0.5f)),
                      SET("b", ball(w, 0.9f, 2, -0.7f, 0.3f))),
                  6);
}

// Lumps of noise, with holes between, carried by a flow.
static const field *lumps(pass_world *w) {
    const field *noise = row(w, "worley", SET("frequency", number(w, 1.3f)),
                             SET("octaves", number(w, 2)), SET("seed", number(w, 5)));
    const field *flow = row(w, "curl", SET("frequency", number(w, 0.5f)));
    const field *torn =
        row(w, "warp", SET("value", noise), SET("by", flow), SET("amount", number(w, 0.1f)));
    const field *hollow = row(w, "smoothstep", SET("value", torn), SET("low", number(w, 0.62f)),
                              SET("high", number(w, 0.8f)));
    return row(w, "mul", SET("a", scaled(w, ball(w, 0, 0.5f, 0, 1.6f), 9)), SET("b", hollow));
}

static const field *flat(pass_world *w) { // thinner than a brick, and than the steps
    const field *args[FIELD_MAX_ARGS] = {triple(w, 0, 0, 0.2f), triple(w, 3, 3, 0.02f),
                                         number(w, 0)};
    const field *shape = field_make(&w->memory, "box", args, NULL);
    gpu_test_ok(shape);
    return scaled(w, shape, 8);
}

static const field *nothing(pass_world *w) {
    return scaled(w, ball(w, 0, 0, 0, 1), 0);
}

// ---- pictures ---------------------------------------------------------------------------------

static pass *add_march(pass_world *w, make_density density, way o) {
    pass *p = world_add(w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(p, "density", density(w)));
    gpu_test_ok(pass_set_field(p, "radiance", triple(w, 2, 1, 0.5f)));
    gpu_test_ok(pass_set_option(p, "skipping", o.skips ? "on" : "off"));
    if (o.paper) gpu_test_ok(pass_set_option(p, "mode", "paper"));
    if (o.tolerance > 0) gpu_test_ok(pass_set_uniform(p, "tolerance", number(w, o.tolerance)));
    if (o.threads > 0) gpu_test_ok(pass_set_uniform(p, "threads", number(w, o.threads)));
    gpu_test_ok(pass_set_uniform(p, "bricks", number(w, o.bricks > 0 ? o.bricks : 33)));
    gpu_test_ok(pass_set_uniform(p, "steps", number(w, o.steps > 0 ? o.steps : 48)));
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(w, o.early_exit)));
    gpu_test_ok(pass_set_uniform(p, "jitter", number(w, o.jitters)));
    return p;
}

static void take(gpu *device, make_density density, way o, picture *out) {
    pass_world w;
    world_open(&w, device);
    w.host.counters = true;
    if (o.lit) w.scene.sun.strength = number(&w, 2);
    pass *p = add_march(&w, density, o);
    gpu_test_ok(pass_declare(p));
    graph_add_output(w.host.graph, pass_output(p, "transmittance"));
    graph_add_output(w.host.graph, pass_output(p, "reach"));
    world_render(&w, SIZE, SIZE, pass_output(p, "color"));
    uint64_t counted[2];
    gpu_test_ok(pass_read_counters(p, counted));
    out->samples = counted[0];
    out->dense = counted[1];
    float *color = world_read(&w, pass_output(p, "color"));
    float *light = world_read(&w, pass_output(p, "transmittance"));
    float *reach = world_read_depth(&w, pass_output(p, "reach"));
    memcpy(out->color, color, sizeof out->color);
    memcpy(out->light, light, sizeof out->light);
    memcpy(out->reach, reach, sizeof out->reach);
    mem_free(color);
    mem_free(light);
    mem_free(reach);
    world_close(&w);
}

static void expect_same(const picture *a, const picture *b) {
    assert_memory_equal(a->color, b->color, sizeof a->color);
    assert_memory_equal(a->light, b->light, sizeof a->light);
    assert_memory_equal(a->reach, b->reach, sizeof a->reach);
    assert_int_equal(a->dense, b->dense);
}

// Both ways of one march; the part of the samples that is left.
static double compare(gpu *device, make_density density, way o) {
    static picture all, some;
    o.skips = false;
    take(device, density, o, &all);
    o.skips = true;
    take(device, density, o, &some);
    expect_same(&all, &some);
    assert_true(all.samples > 0 && some.samples <= all.samples);
    return (double)some.samples / (double)all.samples;
}

static void expect_at_most(double got, double wanted) {
    if (got > wanted) fail_msg("%.3f of the samples, not at most %.3f", got, wanted);
}

// ---- tests ------------------------------------------------------------------------------------

static void skipping_changes_no_bit(void **state) {
    expect_at_most(compare(*state, two_balls, (way){0}), 0.15);
    expect_at_most(compare(*state, lumps, (way){.early_exit = 0.1f}), 0.6);
    expect_at_most(compare(*state, lumps, (way){.bricks = 21, .jitters = true}), 0.8);
    expect_at_most(compare(*state, flat, (way){.steps = 200, .bricks = 100}), 1);
    expect_at_most(compare(*state, two_balls, (way){.bricks = 3}), 1);
    expect_at_most(compare(*state, two_balls, (way){.steps = 3, .jitters = true}), 0.5);
}

static void skipping_changes_no_bit_of_lit_smoke(void **state) {
    expect_at_most(compare(*state, two_balls, (way){.lit = true}), 0.3);
    expect_at_most(compare(*state, lumps, (way){.lit = true, .jitters = true}), 0.8);
}

static void skipping_changes_no_bit_in_mode_paper(void **state) {
    expect_at_most(compare(*state, two_balls, (way){.paper = true, .early_exit = 0.1f}), 0.15);
    expect_at_most(compare(*state, lumps, (way){.paper = true, .jitters = true}), 0.7);
}

static void skipping_changes_no_bit_of_steps_of_variable_length(void **state) {
    expect_at_most(compare(*state, two_balls, (way){.tolerance = 0.01f}), 0.7);
    expect_at_most(compare(*state, lumps, (way){.tolerance = 0.01f, .lit = true}), 0.9);
}

static void where_nothing_is_no_samples_are_taken(void **state) {
    static picture p;
    take(*state, nothing, (way){.skips = true}, &p);
    assert_int_equal(p.samples, 0);
    for (int i = 0; i < VALUES; i++) assert_true(p.color[i] == 0);
}

static void expect_near(const picture *a, const picture *b) {
    for (int i = 0; i < VALUES; i++) {
        double far = fabs((double)a->color[i] - (double)b->color[i]);
        if (far > 2e-3) fail_msg("%g and %g", (double)a->color[i], (double)b->color[i]);
    }
}

// Sums in another order, so that they differ by rounding.
static void threads_that_share_a_ray_find_what_one_does(void **state) {
    static picture one, several;
    const way ways[] = {{.skips = true, .early_exit = 0.05f, .lit = true},
                        {.early_exit = 0.05f},
                        {.skips = true, .paper = true, .early_exit = 0.05f, .jitters = true}};
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        way o = ways[i];
        take(*state, lumps, o, &one);
        for (int threads = 2; threads <= 16; threads *= 2) { // at most a subgroup is taken
            o.threads = (float)threads;
            take(*state, lumps, o, &several);
            expect_near(&one, &several);
            assert_true(several.dense == one.dense);
        }
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(skipping_changes_no_bit),
        cmocka_unit_test(skipping_changes_no_bit_of_lit_smoke),
        cmocka_unit_test(skipping_changes_no_bit_in_mode_paper),
        cmocka_unit_test(skipping_changes_no_bit_of_steps_of_variable_length),
        cmocka_unit_test(where_nothing_is_no_samples_are_taken),
        cmocka_unit_test(threads_that_share_a_ray_find_what_one_does),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
