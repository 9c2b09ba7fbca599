// Expressions: the table of kinds, building, evaluation, bounds, printing.
#include "field_build.h"

#include "field/kinds.h"
#include "shared.h"

static const field_context still = {0};

static void refuses(const field *node, const char *part) {
    assert_null(node);
    assert_error(part);
    err_clear();
}

#define try(kind, ...)                                                                             \
    field_make(build_memory(), kind, (const field *const[FIELD_MAX_ARGS]){__VA_ARGS__}, NULL)

// ---- the table --------------------------------------------------------------------------------

static void special_rows_stand_where_the_code_expects_them(void **state) {
    (void)state;
    static const char *const names[KIND_SPECIAL_COUNT] = {
        "constant", "param", "curve",   "call", "time",      "grid",
        "palette",  "glsl",  "swizzle", "warp", "transform", "advect",
        "position", "add",   "sub",     "mul",  "negate"};
    for (int i = 0; i < KIND_SPECIAL_COUNT; i++) assert_string_equal(field_kinds[i].name, names[i]);
}

static void every_row_is_complete(void **state) {
    (void)state;
    static const char *const groups[] = {"value", "source", "noise", "shape", "blast", "operator"};
    for (const field_kind *kind = field_kinds; kind->name; kind++) {
        bool known = false;
        for (size_t i = 0; i < COUNT_OF(groups); i++)
            known = known || strcmp(kind->group, groups[i]) == 0;
        assert_true(known);
        assert_true(kind->summary && strlen(kind->summary) > 3);
        assert_ptr_equal(field_kind_find(kind->name), kind); // names are unique
        bool general = kind - field_kinds >= KIND_SPECIAL_COUNT;
        if (general) assert_true(kind->function && kind->eval);
        if (kind->function) assert_true(kind->ranges && kind->range_function);
        if (kind->spatial || kind->eval) // all that can vary in space
            assert_true(kind->ranges || strcmp(kind->name, "constant") == 0);
        for (size_t i = 0; i < FIELD_MAX_ARGS && kind->args[i].desc.name; i++) {
            const field_arg *arg = &kind->args[i];
            assert_true(arg->desc.help && arg->desc.unit);
            bool limited = arg->desc.min != 0 || arg->desc.max != 0;
            for (int c = 0; c < arg->desc.components && limited; c++)
                assert_true(arg->desc.value[c] >= arg->desc.min &&
                            arg->desc.value[c] <= arg->desc.max);
        }
        for (size_t i = 0; i < FIELD_MAX_OPTIONS && kind->options[i].name; i++)
            assert_true(kind->options[i].words[0] && kind->options[i].words[1] &&
                        kind->options[i].help);
    }
}

static void a_misspelt_kind_gets_a_suggestion(void **state) {
    (void)state;
    assert_null(field_kind_find("wurley"));
    assert_error("did you mean 'worley'?");
    refuses(try("grid", NULL), "cannot be made by its name");
}

// ---- building ---------------------------------------------------------------------------------

static void defaults_fill_what_is_left_out(void **state) {
    (void)state;
    field *n = make("worley", NULL);
    assert_int_equal(kind_arg_count(n), 11);
    assert_true(n->args[0]->value[0] == 1 && n->args[2]->value[0] == 0.5f);
    assert_int_equal(n->components, 1);
    assert_false(n->uniform);
}

static void bad_arguments_are_named(void **state) {
    (void)state;
    field *p = make("position", NULL);
    refuses(row_or_null("perlin", SET("octaves", number(13))),
            "perlin: 'octaves' is 13; accepted: 1 to 12");
    refuses(row_or_null("perlin", SET("frequency", number(NAN))),
            "'frequency' is nan; accepted: 1e-06 to 1e+06 1/m");
    refuses(row_or_null("perlin", SET("seed", p)), "'seed' has 3 components; 1 is accepted");
    refuses(row_or_null("perlin", SET("frequency", make("length", p))),
            "'frequency' varies in space");
    refuses(row_or_null("sphere",
                        SET("position", field_constant(build_memory(), 4, (const float[4]){0}))),
            "3 or a single one");
    refuses(try("add", p), "add: 'b' is missing");
    refuses(try("add", p, field_constant(build_memory(), 4, (const float[4]){0})),
            "'a' has 3 components but 'b' has 4");
    const uint8_t options[FIELD_MAX_OPTIONS] = {3};
    refuses(field_make(build_memory(), "perlin", NULL, options), "option 'fractal' has no word 3");
}

static void single_numbers_widen(void **state) {
    (void)state;
    field *sum = make("add", number(1), vector(1, 2, 3));
    assert_int_equal(sum->components, 3);
    float out[4];
    assert_true(field_eval(sum, &still, (float3){0}, out));
    assert_true(out[0] == 2 && out[1] == 3 && out[2] == 4);
    assert_true(value_at(make("box", NULL, number(2)), 0, (float3){0.9f, 0.9f, -0.9f}) == 1);
}

static void only_what_varies_in_space_is_not_uniform(void **state) {
    (void)state;
    field *p = make("position", NULL), *moving = make("mul", field_time(build_memory()), number(2));
    assert_true(moving->uniform);
    assert_true(make("warp", moving, p)->uniform); // the same wherever it is taken
    assert_false(make("warp", p, vector(1, 0, 0))->uniform);
    assert_false(make("add", moving, p)->uniform);
    assert_true(value_at(make("warp", moving, p), 3, (float3){1, 2, 3}) == 6);
}

static void swizzles_choose_components(void **state) {
    (void)state;
    field *v = vector(1, 2, 3), *s = need_field(field_swizzle(build_memory(), v, "zxx"));
    float out[4];
    assert_true(field_eval(s, &still, (float3){0}, out));
    assert_true(out[0] == 3 && out[1] == 1 && out[2] == 1);
    s = need_field(field_swizzle(build_memory(), s, "rggb")); // of a swizzle
    assert_ptr_equal(s->args[0], v);
    assert_true(field_eval(s, &still, (float3){0}, out));
    assert_true(out[0] == 3 && out[1] == 1 && out[3] == 1);
    refuses(field_swizzle(build_memory(), v, "w"), "'w'");
    refuses(field_swizzle(build_memory(), v, "xy"), "1, 3 or 4 letters");
    refuses(field_swizzle(build_memory(), v, ""), "''");
    refuses(field_swizzle(build_memory(), v, "xyzxyz"), "'xyzxyz'");
}

static void user_functions_are_checked(void **state) {
    (void)state;
    refuses(field_user(build_memory(), &(field_glsl){"a.glsl", "2nd", 1, 0}, NULL), "'2nd'");
    refuses(field_user(build_memory(), &(field_glsl){"a.glsl", "field_x", 1, 0}, NULL),
            "'field_x'");
    refuses(field_user(build_memory(), &(field_glsl){"a\".glsl", "f", 1, 0}, NULL), "#include");
    refuses(field_user(build_memory(), &(field_glsl){"a.glsl", "f", 2, 0}, NULL), "2 components");
    refuses(field_user(build_memory(), &(field_glsl){"a.glsl", "f", 1, 17}, NULL), "17 arguments");
    field *f = need_field(field_user(build_memory(), &(field_glsl){"a.glsl", "f", 1, 0}, NULL));
    float out[4];
    assert_false(field_eval(f, &still, (float3){0}, out));
    assert_error("'f' cannot be evaluated");
}

// ---- evaluation -------------------------------------------------------------------------------

static void values_come_from_the_context(void **state) {
    (void)state;
    const float params[][4] = {{1}, {2, 3, 4}};
    field_context context = {.time = 2.5, .params = params, .param_count = 2};
    float out[4];
    assert_true(field_eval(field_param(build_memory(), 3, 1), &context, (float3){0}, out));
    assert_true(out[0] == 2 && out[2] == 4);
    assert_true(field_eval(field_time(build_memory()), &context, (float3){0}, out));
    assert_true(out[0] == 2.5f);
    assert_false(field_eval(field_param(build_memory(), 1, 2), &context, (float3){0}, out));
    assert_error("parameter 2");
    const curve_key keys[] = {{0, {0}}, {10, {10}}};
    const curve *c = curve_create(build_memory(), &(curve){CURVE_LINEAR, 1, keys, 2, 0});
    assert_true(field_eval(need_field(field_curve(build_memory(), c)), &context, (float3){0}, out));
    assert_true(out[0] == 2.5f);
}

static bool twice_the_time(void *user, int function, double time, float out[4]) {
    (void)user;
    if (function == 1) return err_set("line 3: oh");
    out[0] = function == 2 ? NAN : (float)(2 * time);
    return true;
}

static void functions_of_time_are_called_and_may_fail(void **state) {
    (void)state;
    field_context context = {.time = 4, .call = twice_the_time};
    float out[4];
    assert_true(field_eval(field_call(build_memory(), 1, 0), &context, (float3){0}, out));
    assert_true(out[0] == 8);
    assert_false(field_eval(field_call(build_memory(), 1, 1), &context, (float3){0}, out));
    assert_error("line 3: oh");
    assert_false(field_eval(field_call(build_memory(), 1, 2), &context, (float3){0}, out));
    assert_error("not finite");
}

static void shapes_have_their_extent_and_falloff(void **state) {
    (void)state;
    field *ball = row("sphere", SET("position", vector(1, 0, 0)), SET("radius", number(2)),
                      SET("falloff", number(0.5f)));
    assert_true(value_at(ball, 0, (float3){1, 2.01f, 0}) == 0);
    assert_true(fabsf(value_at(ball, 0, (float3){1, 1.75f, 0}) - 0.5f) < 1e-5f);
    assert_true(value_at(ball, 0, (float3){1, 1.4f, 0}) == 1);
    field *hard = row("torus", SET("radius", number(2)), SET("thickness", number(0.5f)));
    assert_true(value_at(hard, 0, (float3){2.4f, 0, 0}) == 1 &&
                value_at(hard, 0, (float3){0, 0, 0}) == 0);
    field *pill = row("capsule", SET("to", vector(0, 0, 4)), SET("radius", number(1)));
    assert_true(value_at(pill, 0, (float3){0.9f, 0, 4}) == 1 &&
                value_at(pill, 0, (float3){0, 0, 5.1f}) == 0);
}

static void operators_are_defined_for_every_number(void **state) {
    (void)state;
    static const float odd[] = {0, -1, 3, 1e30f, -1e30f};
    static const char *const kinds[] = {"div", "pow", "step", "min", "max"};
    for (size_t k = 0; k < COUNT_OF(kinds); k++)
        for (size_t i = 0; i < COUNT_OF(odd); i++)
            assert_false(
                isnan(value_at(make(kinds[k], number(odd[i]), number(0)), 0, (float3){0})));
    assert_true(value_at(make("div", number(3), number(0)), 0, (float3){0}) == 0);
    assert_true(value_at(make("sqrt", number(-4)), 0, (float3){0}) == 0);
    assert_true(isfinite(value_at(make("exp", number(1000)), 0, (float3){0})));
    assert_true(value_at(make("remap", number(5), number(0), number(10), number(1), number(3)), 0,
                         (float3){0}) == 2);
    assert_true(value_at(make("smoothstep", number(0.25f), number(0), number(1)), 0, (float3){0}) ==
                0.15625f);
    assert_true(fabsf(value_at(make("dot", vector(1, 2, 3), vector(4, 5, 6)), 0, (float3){0}) -
                      32) < 1e-6f);
    assert_true(value_at(make("length", vector(2, 3, 6)), 0, (float3){0}) == 7);
}

#define GIVES(VALUE, ...)                                                                          \
    assert_float_equal(value_at(make(__VA_ARGS__), 0, (float3){0}), VALUE, 1e-6f)

// The device and the host have these of one text, so that neither can find a fault of the other.
static void operators_have_their_values(void **state) {
    (void)state;
    GIVES(-3.5f, "div", number(7), number(-2));
    GIVES(8, "pow", number(2), number(3));
    GIVES(0.5f, "pow", number(4), number(-0.5f));
    GIVES(0, "pow", number(-2), number(3));
    GIVES(1, "pow", number(0), number(0));
    GIVES(1, "step", number(1), number(1));
    GIVES(0, "step", number(0.9f), number(1));
    GIVES(0.5f, "smoothstep", number(3), number(1), number(5));
    GIVES(1, "smoothstep", number(9), number(1), number(5));
    GIVES(0, "smoothstep", number(0), number(1), number(5));
    GIVES(0.84375f, "smoothstep", number(2), number(5), number(1));
    GIVES(1, "smoothstep", number(2), number(2), number(2));
    GIVES(0, "smoothstep", number(1), number(2), number(2));
    GIVES(5, "clamp", number(7), number(1), number(5));
    GIVES(1, "clamp", number(-7), number(1), number(5));
    GIVES(3, "mix", number(2), number(6), number(0.25f));
    GIVES(2, "min", number(2), number(6));
    GIVES(6, "max", number(2), number(6));
    GIVES(2.3561945f, "atan", number(1), number(-1));
    GIVES(0, "atan", number(0), number(0));
    GIVES(3, "sqrt", number(9));
    GIVES(7.3890561f, "exp", number(2));
    GIVES(3, "abs", number(-3));
    GIVES(-2, "floor", number(-1.25f));
    GIVES(0.75f, "fract", number(-1.25f));
    GIVES(-3, "negate", number(3));
    GIVES(0.84147098f, "sin", number(1));
    field *soft = row("sphere", SET("radius", number(2)), SET("falloff", number(4)));
    assert_float_equal(value_at(soft, 0, (float3){0.5f, 0, 0}), 0.375f, 1e-6f);
}

static void warps_and_transforms_move_the_point(void **state) {
    (void)state;
    field *x = need_field(field_swizzle(build_memory(), make("position", NULL), "x"));
    assert_true(value_at(make("warp", x, vector(3, 0, 0), number(2)), 0, (float3){1, 0, 0}) == 7);
    field *ball = make("sphere", NULL, number(1));
    field *placed = make("transform", ball, vector(5, 0, 0), vector(0, 0, 90), vector(2, 1, 1));
    // Twice as long along X, then turned: along Y, then moved.
    assert_true(value_at(placed, 0, (float3){5, 1.9f, 0}) == 1);
    assert_true(value_at(placed, 0, (float3){5, 2.1f, 0}) == 0);
    assert_true(value_at(placed, 0, (float3){6.1f, 0, 0}) == 0);
    field *turned = make("transform", make("box", vector(2, 0, 0)), NULL, vector(0, 90, 90));
    assert_true(value_at(turned, 0, (float3){0, 0, -2}) == 1); // X to -Z about Y; Z then keeps it
}

static void large_graphs_are_evaluated_once(void **state) {
    (void)state;
    field *x = need_field(field_swizzle(build_memory(), make("position", NULL), "x"));
    field *sum = x;
    for (int i = 0; i < 60; i++) sum = make("mul", make("add", sum, sum), number(0.5f));
    assert_true(sum->size == UINT32_MAX);
    assert_true(value_at(sum, 0, (float3){3, 0, 0}) == 3);
    box3 box;
    assert_true(field_bounds(sum, &still, &box));
    const field_grid *grids[1];
    assert_int_equal(field_grids(sum, grids, 1), 0);
    strbuf text = {0};
    field_print(sum, &text);
    assert_true(text.length < 4000);
    strbuf_free(&text);
}

enum { MANY = 600 }; // more than are evaluated together

static bool count_call(void *user, int function, double time, float out[4]) {
    (void)function;
    *out = (float)(2 * time);
    ++*(int *)user;
    return true;
}

static void make_instances(struct instance_entry *out) {
    for (uint32_t i = 0; i < MANY; i++)
        out[i] = (struct instance_entry){.place = {{0.1f * (float)i, (float)(i % 7), 1, 1}},
                                         .state = {{(float)(i % 11), 0.5f, 0, 0}},
                                         .kind = {{0, i, 0, 0}}};
}

static void instances_have_the_values_of_their_places_and_states(void **state) {
    (void)state;
    static struct instance_entry entries[MANY];
    static float values[MANY][4];
    int calls = 0;
    field_context context = {.time = 3, .call = count_call, .user = &calls};
    make_instances(entries);
    field *age = make("sub", field_call(build_memory(), 1, 0),
                      need_field(field_swizzle(build_memory(), make("instance_state", NULL), "x")));
    field *moving = make("warp", make("perlin", NULL), make("vec", age, age, age), number(0.3f));
    field *small = make("mix", make("smoothstep", age, number(-1), number(4)),
                        make("transform", moving, vector(1, 2, 3), vector(0, 0, 90)),
                        make("instance_index", NULL));
    field *large = small;
    for (int i = 0; i < 12; i++) large = make("mul", make("add", large, large), number(0.5f));
    const field *fields[] = {small, large,
                             make("mul", field_call(build_memory(), 1, 0), number(2))};
    for (size_t k = 0; k < COUNT_OF(fields); k++) {
        calls = 0;
        assert_true(field_eval_instances(fields[k], &context, entries, MANY, values));
        assert_in_range(calls, 1, MANY / 2); // for lots of them
        for (uint32_t i = 0; i < MANY; i++) {
            float alone[4];
            context.instance = &entries[i];
            const float *at = entries[i].place.v;
            assert_true(field_eval(fields[k], &context, (float3){at[0], at[1], at[2]}, alone));
            assert_memory_equal(values[i], alone, sizeof *alone);
        }
        context.instance = NULL;
    }
    context.call = twice_the_time;
    assert_false(field_eval_instances(make("mul", age, field_call(build_memory(), 1, 1)), &context,
                                      entries, MANY, values));
    assert_error("line 3: oh");
}

// ---- bounds -----------------------------------------------------------------------------------

static box3 box_of(const field *node) {
    box3 box;
    if (!field_bounds(node, &still, &box)) fail_msg("%s", err_get());
    return box;
}

static void assert_box(const field *node, float3 min, float3 max) {
    box3 b = box_of(node);
    float worst = 0;
    worst = fmaxf(worst, fmaxf(fabsf(b.min.x - min.x), fabsf(b.max.x - max.x)));
    worst = fmaxf(worst, fmaxf(fabsf(b.min.y - min.y), fabsf(b.max.y - max.y)));
    worst = fmaxf(worst, fmaxf(fabsf(b.min.z - min.z), fabsf(b.max.z - max.z)));
    if (!(worst < 1e-4f))
        fail_msg("(%g %g %g) to (%g %g %g)", (double)b.min.x, (double)b.min.y, (double)b.min.z,
                 (double)b.max.x, (double)b.max.y, (double)b.max.z);
}

static void bounds_of_operators(void **state) {
    (void)state;
    field *a = make("box", vector(0, 0, 0), number(2)),
          *b = make("box", vector(1, 0, 0), number(2));
    field *noise = make("perlin", NULL);
    assert_box(a, (float3){-1, -1, -1}, (float3){1, 1, 1});
    assert_box(make("mul", a, b), (float3){0, -1, -1}, (float3){1, 1, 1});
    assert_box(make("mul", a, noise), (float3){-1, -1, -1}, (float3){1, 1, 1});
    assert_box(make("add", a, b), (float3){-1, -1, -1}, (float3){2, 1, 1});
    assert_box(make("max", a, b), (float3){-1, -1, -1}, (float3){2, 1, 1});
    assert_box(make("min", a, b), (float3){0, -1, -1}, (float3){1, 1, 1}); // neither is negative
    assert_box(make("mix", a, b, number(0.5f)), (float3){-1, -1, -1}, (float3){2, 1, 1});
    assert_box(make("div", a, noise), (float3){-1, -1, -1}, (float3){1, 1, 1});
    assert_box(make("smoothstep", a, number(0.1f), number(1)), (float3){-1, -1, -1},
               (float3){1, 1, 1});
    assert_false(box3_is_finite(box_of(make("add", a, number(1)))));
    assert_false(
        box3_is_finite(box_of(make("remap", a, number(0), number(1), number(1), number(0)))));
    assert_false(box3_is_finite(box_of(noise)));
    assert_true(box3_is_empty(box_of(make("mul", noise, number(0)))));
    assert_true(box3_is_empty(box_of(number(0))));
}

static void bounds_of_moved_fields(void **state) {
    (void)state;
    field *a = make("box", vector(0, 0, 0), number(2));
    assert_box(make("warp", a, vector(3, 0, 4), number(0.5f)), (float3){-3.5f, -3.5f, -3.5f},
               (float3){3.5f, 3.5f, 3.5f});
    assert_true(box3_is_finite(box_of(make("warp", a, make("curl", NULL)))));
    assert_false(box3_is_finite(box_of(make("warp", a, make("position", NULL)))));
    // Where no rule of its own says how far a field reaches, its range does.
    field *wave =
        make("vec", make("step", make("perlin", NULL), number(0.5f)), number(0), number(0.5f));
    assert_box(make("warp", a, make("mul", wave, number(2))), (float3){-3, -3, -3},
               (float3){3, 3, 3});
    assert_box(make("transform", a, vector(10, 0, 0), vector(0, 0, 45), vector(1, 1, 3)),
               (float3){10 - sqrtf(2), -sqrtf(2), -3}, (float3){10 + sqrtf(2), sqrtf(2), 3});
}

static void bounds_of_grids_are_what_is_active(void **state) {
    (void)state;
    field_grid grid = {.name = "g",
                       .box = {{0, 0, 0}, {4, 4, 4}},
                       .channel_count = 2,
                       .state = {.active = {{1, 1, 1}, {9, 2, 2}}}};
    field *a = field_grid_channel(build_memory(), &grid, 0, 1),
          *b = field_grid_channel(build_memory(), &grid, 1, 1);
    assert_box(a, (float3){1, 1, 1}, (float3){4, 2, 2});
    const field_grid *grids[2];
    assert_int_equal(field_grids(make("add", a, b), grids, 2), 1);
    assert_ptr_equal(grids[0], &grid);
    float out[4];
    assert_false(field_eval(a, &still, (float3){0}, out));
    assert_error("'g' keeps no values");
}

static void bounds_of_shapes_hold_all_that_is_not_zero(void **state) {
    (void)state;
    field *shapes[] = {
        row("sphere", SET("radius", number(1.3f)), SET("falloff", number(1))),
        row("capsule", SET("from", vector(-1, 1, 0)), SET("radius", number(0.4f))),
        row("torus", SET("radius", number(1.1f)), SET("thickness", number(0.3f))),
        row("box", SET("size", vector(1, 2, 0.5f)), SET("position", vector(0.3f, 0, 0))),
        make("transform", row("torus", SET("radius", number(1))), vector(0.1f, 0.2f, 0),
             vector(40, 20, 10), number(0.7f)),
        make("warp", row("sphere", SET("radius", number(0.5f))), make("curl", NULL), number(0.1f)),
    };
    for (size_t s = 0; s < COUNT_OF(shapes); s++) {
        box3 b = box_of(shapes[s]);
        uint32_t seed = 5;
        for (int i = 0; i < 5000; i++) {
            float3 p = random_point(&seed, 5);
            if (value_at(shapes[s], 0, p) == 0) continue;
            assert_true(p.x >= b.min.x && p.x <= b.max.x && p.y >= b.min.y && p.y <= b.max.y &&
                        p.z >= b.min.z && p.z <= b.max.z);
        }
    }
}

static void expressions_print_on_one_line(void **state) {
    (void)state;
    field_grid grid = {.name = "burst", .channel_count = 1};
    field *d = field_grid_channel(build_memory(), &grid, 0, 1);
    strbuf text = {0};
    field_print(make("mul", d, make("add", number(2), field_param(build_memory(), 1, 3))), &text);
    assert_string_equal(strbuf_text(&text), "mul(burst[0], add(2, param 3))");
    strbuf_free(&text);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(special_rows_stand_where_the_code_expects_them),
        cmocka_unit_test(every_row_is_complete),
        cmocka_unit_test(a_misspelt_kind_gets_a_suggestion),
        cmocka_unit_test(defaults_fill_what_is_left_out),
        cmocka_unit_test(bad_arguments_are_named),
        cmocka_unit_test(single_numbers_widen),
        cmocka_unit_test(only_what_varies_in_space_is_not_uniform),
        cmocka_unit_test(swizzles_choose_components),
        cmocka_unit_test(user_functions_are_checked),
        cmocka_unit_test(values_come_from_the_context),
        cmocka_unit_test(functions_of_time_are_called_and_may_fail),
        cmocka_unit_test(shapes_have_their_extent_and_falloff),
        cmocka_unit_test(operators_are_defined_for_every_number),
        cmocka_unit_test(operators_have_their_values),
        cmocka_unit_test(warps_and_transforms_move_the_point),
        cmocka_unit_test(large_graphs_are_evaluated_once),
        cmocka_unit_test(instances_have_the_values_of_their_places_and_states),
        cmocka_unit_test(bounds_of_operators),
        cmocka_unit_test(bounds_of_moved_fields),
        cmocka_unit_test(bounds_of_grids_are_what_is_active),
        cmocka_unit_test(bounds_of_shapes_hold_all_that_is_not_zero),
        cmocka_unit_test(expressions_print_on_one_line),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    arena_free(build_memory());
    return failed;
}
