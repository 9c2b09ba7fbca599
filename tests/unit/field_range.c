// Ranges hold what values can be: random expressions of all kinds, random boxes, random points.
#include "field_random.h"

#include "field/range.h"

static const field_context moving = {.time = 1.3};

// Roundings may show a little, where values cancel out.
static void assert_holds(const field *node, box3 box, float3 p, const intervals *in) {
    float v[4];
    if (!field_eval(node, &moving, p, v)) fail_msg("%s", err_get());
    for (int c = 0; c < node->components; c++) {
        float slack = 1e-5f * fmaxf(1, fabsf(v[c]));
        bool above = v[c] >= in->c[c].low - slack || in->c[c].low <= -1e30f;
        bool below = v[c] <= in->c[c].high + slack || in->c[c].high >= 1e30f;
        if ((above && below) || isnan(v[c])) continue;
        strbuf text = {0};
        field_print(node, &text);
        fail_msg("%.9g is not in %.9g to %.9g, at (%g %g %g) in (%g %g %g) to (%g %g %g): %s",
                 (double)v[c], (double)in->c[c].low, (double)in->c[c].high, (double)p.x,
                 (double)p.y, (double)p.z, (double)box.min.x, (double)box.min.y, (double)box.min.z,
                 (double)box.max.x, (double)box.max.y, (double)box.max.z, strbuf_text(&text));
    }
}

static void check(const field *node, uint32_t *seed, int boxes, int points) {
    for (int i = 0; i < boxes; i++) {
        box3 box = random_box(seed);
        intervals in;
        assert_true(field_ranges(node, &moving, box, &in));
        for (int k = 0; k < points; k++) assert_holds(node, box, random_inside(box, seed), &in);
    }
}

static void random_expressions_stay_in_their_ranges(void **state) {
    (void)state;
    uint32_t seed = 20261;
    for (int i = 0; i < 1200; i++)
        check(random_tree(&seed, 1 + i % 4, i % 3 ? 1 : 3), &seed, 6, 16);
}

static void every_kind_stays_in_its_range(void **state) {
    (void)state;
    uint32_t seed = 4;
    for (const field_kind *kind = &field_kinds[KIND_WARP]; kind->name; kind++)
        for (int i = 0; i < 12; i++) {
            int components = kind->components ? kind->components : i % 2 ? 1 : 3;
            field *node = random_kind(&seed, kind, 1, components);
            if (node) check(node, &seed, 12, 24);
        }
}

// What the slopes are good for: boxes that are small beside the cells.
static void noise_is_known_in_small_boxes(void **state) {
    (void)state;
    static const char *const kinds[] = {"perlin", "value", "simplex", "worley"};
    uint32_t seed = 9;
    for (size_t k = 0; k < COUNT_OF(kinds); k++) {
        field *noise = row(kinds[k], SET("octaves", number(1)));
        for (int i = 0; i < 50; i++) {
            float3 p = random_point(&seed, 6);
            intervals in;
            box3 box = {p, {p.x + 0.02f, p.y + 0.02f, p.z + 0.02f}};
            assert_true(field_ranges(noise, &moving, box, &in));
            assert_true(in.c[0].high - in.c[0].low < 0.15f);
        }
    }
}

// Parameters may be what constants may not.
static void noise_may_run_backwards(void **state) {
    (void)state;
    const float params[][4] = {{-1.5f}, {-2}};
    const field_context context = {.params = params, .param_count = 2};
    field *noise = row("perlin", SET("frequency", field_param(build_memory(), 1, 0)),
                       SET("lacunarity", field_param(build_memory(), 1, 1)));
    uint32_t seed = 3;
    for (int i = 0; i < 400; i++) {
        float v[4];
        intervals in;
        box3 box = random_box(&seed);
        assert_true(field_ranges(noise, &context, box, &in));
        assert_true(field_eval(noise, &context, random_inside(box, &seed), v));
        assert_true(v[0] >= in.c[0].low && v[0] <= in.c[0].high);
    }
}

static range1 range_of(const field *node, box3 box) {
    intervals in;
    if (!field_ranges(node, &moving, box, &in)) fail_msg("%s", err_get());
    return in.c[0];
}

static const box3 unit_box = {{1, 2, 3}, {2, 3, 4}};

static void nothing_stays_nothing(void **state) {
    (void)state;
    field *ball = row("sphere", SET("radius", number(1)));
    field *unknown =
        need_field(field_user(build_memory(), &(field_glsl){"a.glsl", "f", 1, 0}, NULL));
    range1 all = range_of(make("mul", ball, unknown), unit_box);
    assert_true(all.low == 0 && all.high == 0);
    all = range_of(make("mul", make("add", ball, number(1)), unknown), unit_box);
    assert_true(all.low <= -1e30f && all.high >= 1e30f);
    // Where a smoothstep ends it is exact, so that what is taken from it is nothing.
    field *far =
        make("sub", number(1),
             make("smoothstep", make("length", make("position", NULL)), number(1), number(2)));
    all = range_of(far, unit_box);
    assert_true(all.low == 0 && all.high == 0);
}

static void a_warp_to_a_place_is_not_widened_by_the_way(void **state) {
    (void)state;
    field *p = make("position", NULL), *z = need_field(field_swizzle(build_memory(), p, "z"));
    field *there = make("warp", z, make("sub", make("mul", p, number(2)), p));
    range1 all = range_of(there, unit_box);
    assert_true(fabsf(all.low - 6) < 1e-4f && fabsf(all.high - 8) < 1e-4f);
}

static void grids_are_unknown_inside_and_nothing_outside(void **state) {
    (void)state;
    field_grid grid = {.name = "g",
                       .box = {{0, 0, 0}, {4, 4, 4}},
                       .channel_count = 1,
                       .state = {.active = {{0, 0, 0}, {4, 4, 2}}}};
    field *d = field_grid_channel(build_memory(), &grid, 0, 1);
    range1 all = range_of(d, unit_box);
    assert_true(all.low == 0 && all.high == 0);
    all = range_of(d, (box3){{1, 1, 1}, {2, 2, 2}});
    assert_true(all.high >= 1e30f);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_expressions_stay_in_their_ranges),
        cmocka_unit_test(every_kind_stays_in_its_range),
        cmocka_unit_test(noise_is_known_in_small_boxes),
        cmocka_unit_test(noise_may_run_backwards),
        cmocka_unit_test(nothing_stays_nothing),
        cmocka_unit_test(a_warp_to_a_place_is_not_widened_by_the_way),
        cmocka_unit_test(grids_are_unknown_inside_and_nothing_outside),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    arena_free(build_memory());
    return failed;
}
