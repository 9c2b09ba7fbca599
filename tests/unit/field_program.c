// The generator: what text it writes and what numbers it fills in.
#include "field_build.h"

#include "field/program.h"

static field_grid some_grid(const char *name) {
    return (field_grid){.name = name,
                        .box = {{-1, -1, -1}, {3, 1, 1}},
                        .size = {8, 4, 4},
                        .channel_count = 6,
                        .state = {.active = {{0, -1, -1}, {1, 5, 1}}}};
}

static const field_program *compile(const field_root *roots, size_t count) {
    const field_program *p = field_program_create(build_memory(), roots, count);
    if (!p) fail_msg("%s", err_get());
    return p;
}

static const char *text_of(const field *node) {
    field_root root = {"density", node, node->components, ""};
    return field_program_text(compile(&root, 1));
}

static size_t occurrences(const char *text, const char *part) {
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, part)); at += strlen(part)) count++;
    return count;
}

static const char *need_text(const char *text, const char *part) {
    const char *at = strstr(text, part);
    if (!at) fail_msg("\"%s\" is not in:\n%s", part, text);
    return at;
}

static field *burst(const field_grid *grid, float weight, const char *noise) {
    field *density = field_grid_channel(build_memory(), grid, 0, 1);
    field *detail = row(noise, SET("frequency", number(weight)));
    field *thinned = make("mix", number(1), make("sub", number(1), detail), number(0.5f));
    return make("mul", make("mul", density, thinned), number(weight));
}

static void equal_structure_gives_equal_text(void **state) {
    (void)state;
    field_grid a = some_grid("a"), b = some_grid("b");
    assert_string_equal(text_of(burst(&a, 1, "worley")), text_of(burst(&b, 7, "worley")));
}

static void another_noise_gives_another_text(void **state) {
    (void)state;
    field_grid a = some_grid("a");
    assert_string_not_equal(text_of(burst(&a, 1, "worley")), text_of(burst(&a, 1, "perlin")));
}

static void constants_of_one_value_stay_apart(void **state) {
    (void)state;
    field *x = make("position", NULL);
    field *same = make("add", make("mul", x, number(2)), make("mul", x, number(2)));
    field *other = make("add", make("mul", x, number(2)), make("mul", x, number(3)));
    assert_string_equal(text_of(same), text_of(other));
}

static void noise_is_only_computed_where_the_grid_is_not_zero(void **state) {
    (void)state;
    field_grid grid = some_grid("a");
    const char *text = text_of(burst(&grid, 1, "worley"));
    const char *fetch = need_text(text, "= field_fetch_0_0(p);");
    const char *branch = need_text(fetch, "!= 0.0) {");
    need_text(branch, "noise_worley(p");
    assert_int_equal(occurrences(text, "noise_worley("), 1);
    need_text(text, "#include \"lib/noise.glsl\"");
}

static void ranges_of_noise_are_only_computed_where_the_grid_may_not_be_zero(void **state) {
    (void)state;
    field_grid grid = some_grid("a");
    field *density = field_grid_channel(build_memory(), &grid, 0, 1);
    field *noise = row("worley", SET("seed", number(1))),
          *other = row("perlin", SET("seed", number(1)));
    field *carved = make("sub", density, make("mul", other, make("abs", noise)));
    const char *text = text_of(make("mul", make("mul", noise, carved), density));
    text = need_text(text, "vec2 field_density_range(vec3 low, vec3 high) {");
    const char *fetch = need_text(text, "= field_fetch_range_0_0(p);");
    const char *shared = need_text(fetch, "range_worley(p"); // wanted in two places
    need_text(need_text(shared, "if (!range_is_zero("), "range_perlin(p");
    assert_int_equal(occurrences(text, "range_worley("), 1);
    assert_int_equal(occurrences(text, "range_perlin("), 1);
}

static void shared_products_have_short_ranges(void **state) {
    (void)state;
    field *x =
        make("mul", row("sphere", SET("radius", number(1))), row("perlin", SET("seed", number(0))));
    for (int i = 1; i < 40; i++)
        x = make("add", make("mul", x, row("perlin", SET("seed", number((float)i)))),
                 make("mul", make("abs", x), row("value", SET("seed", number((float)i)))));
    const char *text = need_text(text_of(x), "vec2 field_density_range(");
    assert_int_equal(occurrences(text, "range_perlin("), 40);
    assert_int_equal(occurrences(text, "range_value("), 39);
}

static void cheap_factors_come_first_however_written(void **state) {
    (void)state;
    field *noise = row("perlin", SET("seed", number(1)));
    field *ball = row("sphere", SET("radius", number(1)));
    const char *text = text_of(make("mul", noise, ball));
    assert_true(need_text(text, "shape_sphere(p") < need_text(text, "noise_perlin(p"));
}

static void shared_noise_is_computed_once(void **state) {
    (void)state;
    field *noise = row("perlin", SET("seed", number(1)));
    field *again = make("add", make("abs", noise), make("sqrt", noise));
    assert_int_equal(occurrences(text_of(again), "noise_perlin("), 1);
}

static void noise_in_two_products_of_a_sum_is_computed_at_most_once(void **state) {
    (void)state;
    field_grid grid = some_grid("a");
    field *noise = row("perlin", SET("seed", number(1)));
    field *a = field_grid_channel(build_memory(), &grid, 0, 1);
    field *b = field_grid_channel(build_memory(), &grid, 1, 1);
    const char *text = text_of(make("add", make("mul", a, noise), make("mul", b, noise)));
    assert_int_equal(occurrences(text, "noise_perlin("), 1);
    assert_int_equal(occurrences(text, " fields_lazy"), 1 + 2); // made, and called in both blocks
    assert_int_equal(occurrences(text, "!= fields_turn) {"), 1);
    assert_int_equal(occurrences(text, "fields_turn++;"), 1);
}

static void a_field_after_another_reuses_its_noise(void **state) {
    (void)state;
    field_grid grid = some_grid("a");
    field *noise = row("worley", SET("seed", number(1)));
    field *density = make("mul", field_grid_channel(build_memory(), &grid, 0, 1), noise);
    field *heat = make("mul", field_grid_channel(build_memory(), &grid, 1, 1), noise);
    field_root roots[] = {{"density", density, 1, ""}, {"emission", heat, 3, "density"}};
    const char *text = field_program_text(compile(roots, 2));
    assert_int_equal(occurrences(text, "noise_worley("), 1);
    assert_int_equal(occurrences(text, "= field_fetch_0_0(p);"), 1);
    assert_int_equal(occurrences(text, "fields_done"), 0); // no test: it has surely run
    need_text(text, "vec3 field_emission(vec3 p) {");

    roots[1].after = ""; // alone, it computes all by itself
    text = field_program_text(compile(roots, 2));
    assert_int_equal(occurrences(text, "noise_worley("), 2);
    assert_int_equal(occurrences(text, "fields_v"), 0);
}

static void what_may_not_have_run_is_tested_before_reuse(void **state) {
    (void)state;
    field_grid grid = some_grid("a");
    field *noise = row("worley", SET("seed", number(1)));
    field *density = field_grid_channel(build_memory(), &grid, 0, 1);
    field *thick = make("max", make("mul", density, noise), density);
    field_root roots[] = {{"density", thick, 1, ""}, {"emission", noise, 1, "density"}};
    const char *text = field_program_text(compile(roots, 2));
    assert_int_equal(occurrences(text, "noise_worley("), 1);
    const char *emission = need_text(text, "float field_emission");
    assert_int_equal(occurrences(emission, "fields_lazy"), 1);
    assert_int_equal(occurrences(emission, "fields_turn++;"), 0); // it keeps what density computed
}

static void warps_by_one_vector_share_the_point(void **state) {
    (void)state;
    field *swirl = row("curl", SET("seed", number(1))), *amount = number(0.1f);
    field *a = make("warp", row("perlin", SET("seed", number(1))), swirl, amount);
    field *b = make("warp", row("worley", SET("seed", number(1))), swirl, amount);
    const char *text = text_of(make("add", a, b));
    assert_int_equal(occurrences(text, "noise_curl("), 1);
    assert_int_equal(occurrences(text, "vec3 v"), 2); // the vector and the point
    assert_null(strstr(text, "noise_perlin(p"));
}

static void one_fetch_serves_four_channels(void **state) {
    (void)state;
    field_grid grid = some_grid("a");
    field *sum = number(0);
    for (int c = 0; c < 4; c++)
        sum = make("add", sum, field_grid_channel(build_memory(), &grid, c, 1));
    const char *text = text_of(sum);
    assert_int_equal(occurrences(text, "= field_fetch_0_0(p);"), 1);
    assert_int_equal(occurrences(text, "uniform sampler3D field_grid"), 1);
    text = text_of(field_grid_channel(build_memory(), &grid, 3, 3)); // across two images
    need_text(text, ".w, v");
    assert_int_equal(occurrences(text, "uniform sampler3D field_grid"), 2);
}

static void blending_grids_have_a_second_sampler(void **state) {
    (void)state;
    field_grid grid = some_grid("a");
    grid.blends = true;
    field_root root = {"density", field_grid_channel(build_memory(), &grid, 5, 1), 1, ""};
    const field_program *p = compile(&root, 1);
    const field_texture *textures;
    assert_int_equal(field_program_textures(p, &textures), 4);
    assert_string_equal(textures[0].glsl_name, "field_grid_0_1");
    assert_string_equal(textures[1].glsl_name, "field_next_0_1");
    assert_int_equal(textures[1].set, 1);
    assert_int_equal(textures[1].image, 1);
    assert_ptr_equal(textures[1].grid, &grid);
    assert_string_equal(textures[2].glsl_name, "field_ranges_0_1");
    assert_string_equal(textures[3].glsl_name, "field_ranges_next_0_1");
    assert_true(!textures[1].ranges && textures[3].ranges && textures[3].set == 1);
    need_text(field_program_text(p), "blend > 0.0 ?");
}

static void numbers_are_evaluated_on_the_host(void **state) {
    (void)state;
    const float params[][4] = {{3}, {1, 2, 3}};
    field_context context = {.time = 2, .params = params, .param_count = 2};
    // One number for the whole subtree that does not vary in space.
    field *factor = make("add", make("mul", field_param(build_memory(), 1, 0), number(10)),
                         field_time(build_memory()));
    field *vectors = make("mul", make("position", NULL), field_param(build_memory(), 3, 1));
    field_root root = {"v", make("mul", vectors, factor), 3, ""};
    const field_program *p = compile(&root, 1);
    assert_int_equal(field_program_block_size(p), 16);
    float block[4];
    assert_true(field_program_fill(p, &context, block));
    assert_true(block[0] == 1 && block[1] == 2 && block[2] == 3);
    assert_true(block[3] == 32); // beside the vector
}

static void single_numbers_share_vec4s(void **state) {
    (void)state;
    field *noise = row("perlin", SET("seed", number(1))); // ten of them and a vector
    field_root root = {"n", noise, 1, ""};
    assert_int_equal(field_program_block_size(compile(&root, 1)), 4 * 16);
}

static void a_grid_fills_its_box(void **state) {
    (void)state;
    field_grid grid = some_grid("a");
    field_root root = {"d", field_grid_channel(build_memory(), &grid, 0, 1), 1, ""};
    const field_program *p = compile(&root, 1);
    assert_int_equal(field_program_block_size(p), 80);
    float b[20];
    assert_true(field_program_fill(p, &(field_context){0}, b));
    assert_true(b[0] == -1 && b[3] == 0 && b[4] == 0.25f && b[5] == 0.5f);
    assert_true(b[8] == 0 && b[12] == 1 && b[13] == 1);  // active, inside of the box
    assert_true(b[16] == 2 && b[17] == 1 && b[18] == 1); // bricks of 4
    grid.state.active = box3_empty();
    assert_true(field_program_fill(p, &(field_context){0}, b));
    assert_true(b[8] > b[12]); // no point is inside
}

static void roots_are_widened_or_lose_alpha(void **state) {
    (void)state;
    const palette_stop stops[] = {{0, {0, 0, 0, 1}}, {1, {1, 1, 1, 1}}};
    const palette_key key = {0, stops, 2};
    const palette *p =
        palette_create(build_memory(), &(palette_desc){.keys = &key, .key_count = 1});
    field *noise = row("perlin", SET("seed", number(1)));
    field_root root = {"e", need_field(field_palette(build_memory(), p, noise)), 3, ""};
    need_text(field_program_text(compile(&root, 1)), ".rgb;");
    root.node = noise;
    need_text(field_program_text(compile(&root, 1)), "return vec3(");
    root.node = make("position", NULL);
    root.components = 1;
    assert_null(field_program_create(build_memory(), &root, 1));
    assert_error("'e' has 3 components; 1 is accepted");
    root = (field_root){"e", noise, 1, "density"};
    assert_null(field_program_create(build_memory(), &root, 1));
    assert_error("'density'");
}

static void user_functions_are_included_once(void **state) {
    (void)state;
    field_glsl glsl = {"fire.glsl", "licks", 1, 1};
    const field *args[] = {number(2)};
    field *a = need_field(field_user(build_memory(), &glsl, args));
    field *b = need_field(field_user(build_memory(), &glsl, args));
    const char *text = text_of(make("add", a, b));
    assert_int_equal(occurrences(text, "#include \"fire.glsl\""), 1);
    assert_int_equal(occurrences(text, "licks(p, field_numbers[0].x)"), 1); // the same call
}

// Each step uses the one before twice, in two products: 2^200 if written out.
static void shared_products_do_not_explode(void **state) {
    (void)state;
    field *x = row("perlin", SET("seed", number(1)));
    for (int i = 0; i < 60; i++)
        x = make("add", make("mul", x, row("perlin", SET("seed", number((float)i)))),
                 make("mul", x, row("value", SET("seed", number((float)i)))));
    const char *text = text_of(x);
    assert_true(strlen(text) < 200000);
    field *y = make("position", NULL);
    for (int i = 0; i < 200; i++) y = make("mul", y, y);
    assert_true(strlen(text_of(y)) < 100000);
}

// One chain written to the left, one to the right: each noise is a factor, and none is lost.
static void products_of_any_length_are_written(void **state) {
    (void)state;
    enum { COUNT = 120 };
    field *left = row("sphere", SET("radius", number(2))), *right = left;
    for (int i = 0; i < COUNT; i++) {
        left = make("mul", left, row("perlin", SET("seed", number((float)i))));
        right = make("mul", row("perlin", SET("seed", number((float)i))), right);
    }
    assert_int_equal(occurrences(text_of(left), "noise_perlin("), COUNT);
    assert_int_equal(occurrences(text_of(right), "noise_perlin("), COUNT);
    assert_int_equal(occurrences(text_of(make("mul", left, right)), "noise_perlin("), 2 * COUNT);
}

static void too_large_expressions_are_refused(void **state) {
    (void)state;
    field *sum = number(0), *deep;
    for (int i = 0; i < 100; i++) {
        field *part = make("position", NULL);
        for (int k = 0; k < 50; k++) part = make("add", part, number((float)k));
        sum = make("add", sum, part);
    }
    field_root root = {"d", sum, 3, ""};
    err_clear();
    assert_null(field_program_create(build_memory(), &root, 1));
    assert_error("more than 4096");
    deep = number(1);
    for (int i = 0; i < 254; i++) deep = make("add", deep, number(1));
    deep = make("add", deep, number(1));
    const field *args[] = {deep, deep};
    assert_null(field_make(build_memory(), "add", args, NULL));
    assert_error("deeper than 256");
}

// Many points from few nodes: every warp of a warp is another point.
static void too_many_points_are_refused(void **state) {
    (void)state;
    field *x = make("position", NULL);
    for (int i = 0; i < 13; i++) {
        field *a = make("warp", x, make("mul", x, number(2)));
        x = make("add", a, make("warp", x, make("mul", x, number(3))));
    }
    field_root root = {"d", x, 3, ""};
    err_clear();
    assert_null(field_program_create(build_memory(), &root, 1));
    assert_error("more than 4096");
}

static void lua_errors_end_the_filling(void **state) {
    (void)state;
    field_root root = {"d", field_call(build_memory(), 1, 3), 1, ""};
    float block[4];
    assert_false(field_program_fill(compile(&root, 1), &(field_context){0}, block));
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_structure_gives_equal_text),
        cmocka_unit_test(another_noise_gives_another_text),
        cmocka_unit_test(constants_of_one_value_stay_apart),
        cmocka_unit_test(noise_is_only_computed_where_the_grid_is_not_zero),
        cmocka_unit_test(ranges_of_noise_are_only_computed_where_the_grid_may_not_be_zero),
        cmocka_unit_test(shared_products_have_short_ranges),
        cmocka_unit_test(cheap_factors_come_first_however_written),
        cmocka_unit_test(shared_noise_is_computed_once),
        cmocka_unit_test(noise_in_two_products_of_a_sum_is_computed_at_most_once),
        cmocka_unit_test(a_field_after_another_reuses_its_noise),
        cmocka_unit_test(what_may_not_have_run_is_tested_before_reuse),
        cmocka_unit_test(warps_by_one_vector_share_the_point),
        cmocka_unit_test(one_fetch_serves_four_channels),
        cmocka_unit_test(blending_grids_have_a_second_sampler),
        cmocka_unit_test(numbers_are_evaluated_on_the_host),
        cmocka_unit_test(single_numbers_share_vec4s),
        cmocka_unit_test(a_grid_fills_its_box),
        cmocka_unit_test(roots_are_widened_or_lose_alpha),
        cmocka_unit_test(user_functions_are_included_once),
        cmocka_unit_test(shared_products_do_not_explode),
        cmocka_unit_test(products_of_any_length_are_written),
        cmocka_unit_test(too_large_expressions_are_refused),
        cmocka_unit_test(too_many_points_are_refused),
        cmocka_unit_test(lua_errors_end_the_filling),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    arena_free(build_memory());
    return failed;
}
