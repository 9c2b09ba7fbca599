// A loaded effect: what the script said arrives, and its functions answer frame by frame.
#include "script_helper.h"

#include "pass/pass_impl.h"

#include <math.h>

#define END " fx.output = geometry { }"

static effect *load(const char *text) {
    effect *e = helper_load(text);
    if (!e) fail_msg("%s\n  in: %s", err_get(), text);
    return e;
}

static void eval(effect *e, const field *node, double time, float out[4]) {
    field_context context = *effect_pass_host(e)->context;
    context.time = time;
    if (!field_eval(node, &context, (float3){0.3f, 0.2f, 0.1f}, out)) fail_msg("%s", err_get());
}

static float uniform(effect *e, size_t pass_index, const char *name, double time) {
    pass *p = effect_get_pass(e, pass_index);
    size_t index;
    assert_int_equal(pass_find_key(p, name, &index), PASS_UNIFORM);
    float out[4];
    eval(e, pass_get_uniform(p, index), time, out);
    return out[0];
}

static void declarations_arrive(void **state) {
    (void)state;
    effect *e = load("local fx = effect { name = 'burst', fps = 30, frames = 7, first = 3 }"
                     "assert(fx.name == 'burst' and fx.fps == 30 and fx.frames == 7)" END);
    assert_string_equal(effect_get_facts(e)->name, "burst");
    assert_float_equal(effect_get_facts(e)->fps, 30, 0);
    assert_int_equal(effect_get_facts(e)->frames, 7);
    assert_int_equal(effect_get_facts(e)->first, 3);
    assert_int_not_equal(effect_get_picture(e, EFFECT_OUTPUT).id, 0);
    assert_int_equal(effect_get_picture(e, EFFECT_DEPTH).id, 0);
    effect_destroy(e);
}

static double grid_time; // that the last frame asked a grid for

static bool note_time(field_grid *grid, gpu *g, double time) {
    (void)grid, (void)g;
    grid_time = time;
    return true;
}

static void leave_grid(field_grid *grid, gpu *g) {
    (void)grid, (void)g;
}

static double played_at(effect *e, double frame) {
    if (!effect_rehearse(e, frame)) fail_msg("%s", err_get());
    return grid_time;
}

static void a_speed_moved_by_hand_changes_what_comes(void **state) {
    (void)state;
    effect *e = load("local fx = effect { fps = 10, first = 0 } param { 'rate', 1 }" END);
    field_grid grid = {.name = "played", .update = note_time, .destroy = leave_grid};
    effect_add_grid(e, &grid);
    effect_add_clock(e, &grid, field_param(effect_memory(e), 1, 0),
                     field_constant(effect_memory(e), 1, (const float[4]){0}));
    assert_true(fabs(played_at(e, 10) - 1) < 1e-9);
    assert_true(effect_set_value(e, 0, (const float[4]){0.5f}));
    assert_true(fabs(played_at(e, 10) - 1) < 1e-9); // what is on show stays
    assert_true(fabs(played_at(e, 11) - 1.05) < 1e-9);
    assert_true(fabs(played_at(e, 11.5) - 1.075) < 1e-9);
    assert_true(fabs(played_at(e, 4) - 0.2) < 1e-9); // back in time: as if it had never been else
    assert_true(fabs(played_at(e, 10) - 0.5) < 1e-9);
    assert_true(effect_set_value(e, 0, (const float[4]){0}));
    assert_true(fabs(played_at(e, 20) - 0.5) < 1e-9); // stopped
    assert_false(effect_rehearse(e, 1e7));
    assert_non_null(strstr(err_get(), "at most 1000000 frames"));
    effect_destroy(e);
}

static void parameters_take_their_type_from_the_default(void **state) {
    (void)state;
    effect *e =
        load("local fx = effect { }"
             "param { 'a', 2, min = 1, max = 3, unit = 'm', help = 'h', group = 'g', log = true }"
             "param { 'b', 4, integer = true } param { 'c', true }"
             "param { 'd', '#ff0000' } param { 'e', {1, 2, 3} }"
             "param { 'f', 'two', words = {'one', 'two'} }" END);
    static const value_type types[] = {VALUE_NUMBER, VALUE_WHOLE,  VALUE_BOOL,
                                       VALUE_COLOR,  VALUE_NUMBER, VALUE_WORD};
    assert_int_equal(effect_param_count(e), 6);
    for (size_t i = 0; i < 6; i++) assert_int_equal(effect_get_param(e, i)->desc.type, types[i]);
    const effect_param *a = effect_get_param(e, 0), *f = effect_get_param(e, 5);
    assert_string_equal(a->desc.name, "a");
    assert_string_equal(a->desc.unit, "m");
    assert_string_equal(a->desc.help, "h");
    assert_string_equal(a->group, "g");
    assert_true(a->log_scale && a->desc.min == 1 && a->desc.max == 3 && a->value[0] == 2);
    assert_float_equal(effect_get_param(e, 3)->value[0], 1, 0);
    assert_int_equal(f->desc.word_count, 2);
    assert_float_equal(f->value[0], 1, 0);
    effect_destroy(e);
}

static void values_move(void **state) {
    (void)state;
    effect *e = load("local fx = effect { } local p = param { 'p', 3 }\n"
                     "march { density = sphere { }, steps = p * 2 }\n"
                     "march { density = sphere { }, opacity = function(t) return t * t end }\n"
                     "march { density = sphere { }, opacity = curve { {0, 0}, {2, 10} } }\n"
                     "march { density = sphere { }, opacity = function(t) return clamp(t, 0, 1) + "
                     "p:get() end }\n"
                     "march { density = sphere { }, opacity = time + 1 }\n" END);
    assert_float_equal(uniform(e, 0, "steps", 0), 6, 1e-6);
    assert_true(effect_set(e, "p", "5"));
    assert_float_equal(uniform(e, 0, "steps", 0), 10, 1e-6);
    assert_float_equal(uniform(e, 1, "opacity", 3), 9, 1e-6);
    assert_float_equal(uniform(e, 2, "opacity", 1), 5, 1e-6);
    assert_float_equal(uniform(e, 3, "opacity", 7), 6, 1e-6);
    assert_float_equal(uniform(e, 4, "opacity", 2), 3, 1e-6);
    effect_destroy(e);
}

// Whether the noise that is the density of pass `index` has four dimensions.
static bool is_four(effect *e, size_t index) {
    const pass *p = effect_get_pass(e, index);
    size_t slot;
    assert_int_equal(pass_find_key(p, "density", &slot), PASS_FIELD);
    const field *noise = p->fields[slot]->args[1];
    for (size_t i = 0; i < FIELD_MAX_OPTIONS && noise->kind->options[i].name; i++)
        if (strcmp(noise->kind->options[i].name, "dimensions") == 0) return noise->options[i] == 1;
    fail_msg("%s has no dimensions", noise->kind->name);
    return false;
}

static void speed_asks_for_four_dimensions(void **state) {
    (void)state;
    effect *e = load("local fx = effect { } local ball = sphere { }\n"
                     "march { density = ball * perlin { } }\n"
                     "march { density = ball * perlin { speed = 0.5 } }\n"
                     "march { density = ball * worley { speed = 0.5, dimensions = 3 } }\n"
                     "march { density = ball * simplex { dimensions = 4 } }\n"
                     "march { density = ball * value { dimensions = '4' } }" END);
    static const bool four[] = {false, true, false, true, true};
    for (size_t i = 0; i < 5; i++) assert_int_equal(is_four(e, i), four[i]);
    effect_destroy(e);
}

static void functions_of_time_do_not_gather_memory(void **state) {
    (void)state;
    script_limits limits = {.memory = 4 << 20};
    effect *e =
        helper_load_with("local fx = effect { } local p = param { 'p', {1, 2, 3} }\n"
                         "march { density = sphere { }, albedo = function(t) local v = p:get()\n"
                         "return {saturate(v[1]), smoothstep(0, 1, t), mix(0, 1, 0.5)} end }" END,
                         &limits, NULL, 0);
    assert_non_null(e);
    for (int i = 0; i < 20000; i++) assert_float_equal(uniform(e, 0, "albedo", i), 1, 0);
    effect_destroy(e);
}

static void faults_in_functions_of_time_are_reported(void **state) {
    (void)state;
    static const struct {
        const char *body, *message;
    } cases[] = {
        {"if t > 1 then return 'x' end return 1", "returned a string at 2 s"},
        {"if t > 1 then return 0 / 0 end return 1", "nan at 2 s"},
        {"if t > 1 then error('late') end return 1", "e.lua:2: late"},
        {"if t > 1 then while true do end end return 1", "instruction limit of 100000 exceeded"},
        {"if t > 1 then return p * 2 end return 1", "while the file loads"},
        {"if t > 1 then return perlin { } end return 1", "while the file loads"},
        {"if t > 1 then march { density = sphere { } } end return 1", "while the file loads"},
        {"if t > 1 then return p.x end return 1", "while the file loads"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1000];
        snprintf(text, sizeof text,
                 "local fx = effect { } local p = param { 'p', 1 }\n"
                 "march { density = sphere { }, opacity = function(t) %s end }" END,
                 cases[i].body);
        script_limits limits = {.frame = 100000};
        effect *e = helper_load_with(text, &limits, NULL, 0);
        if (!e) fail_msg("%s", err_get());
        pass *p = effect_get_pass(e, 0);
        size_t index;
        float out[4];
        pass_find_key(p, "opacity", &index);
        field_context context = *effect_pass_host(e)->context;
        assert_true(field_eval(pass_get_uniform(p, index), &context, (float3){0}, out));
        context.time = 2;
        assert_false(field_eval(pass_get_uniform(p, index), &context, (float3){0}, out));
        if (!strstr(err_get(), cases[i].message))
            fail_msg("got: %s\n wanted: %s", err_get(), cases[i].message);
        context.time = 0; // and the next frame is not hurt
        assert_true(field_eval(pass_get_uniform(p, index), &context, (float3){0}, out));
        effect_destroy(e);
    }
}

static void settings_reach_the_script(void **state) {
    (void)state;
    static const effect_setting settings[] = {{"look", "paper", NULL}, {"amount", "7", NULL}};
    effect *e = helper_load_with(
        "local fx = effect { } local amount = param { 'amount', 1 }\n"
        "local look = param { 'look', 'physical', words = {'physical', 'paper'} }\n"
        "assert(look:get() == 'paper' and amount:get() == 7)\n"
        "march { density = sphere { }, mode = look }" END,
        NULL, settings, 2);
    if (!e) fail_msg("%s", err_get());
    pass *p = effect_get_pass(e, 0);
    size_t index;
    assert_int_equal(pass_find_key(p, "mode", &index), PASS_OPTION);
    assert_int_equal(pass_get_option(p, index), 1);
    effect_destroy(e);
}

static void scene_values_arrive_and_others_keep_their_default(void **state) {
    (void)state;
    effect *e = load("local fx = effect { }\n"
                     "fx.camera = orbit { distance = 9, yaw = function(t) return t * 90 end }\n"
                     "fx.sun = sun { elevation = 12 } fx.sky = sky { zenith = '#ff0000' }" END);
    const scene *s = effect_scene(e);
    float out[4];
    assert_null(s->camera.eye);
    eval(e, s->camera.distance, 0, out);
    assert_float_equal(out[0], 9, 0);
    eval(e, s->camera.yaw, 2, out);
    assert_float_equal(out[0], 180, 0);
    eval(e, s->sun.elevation, 0, out);
    assert_float_equal(out[0], 12, 0);
    eval(e, s->sky.zenith, 0, out);
    assert_true(out[0] == 1 && out[1] == 0);
    assert_non_null(s->camera.fov);
    assert_non_null(s->sun.color);
    assert_non_null(s->sky.horizon);
    effect_destroy(e);
    e = load("local fx = effect { } fx.camera = camera { eye = {1, 2, 3} }" END);
    assert_non_null(effect_scene(e)->camera.eye);
    effect_destroy(e);
}

static void passes_get_labels_and_scales(void **state) {
    (void)state;
    effect *e =
        load("local fx = effect { } march { density = sphere { }, resolution = 1/4 }\n"
             "march { density = sphere { }, name = 'far', format = {color = 'rgba32f'} }" END);
    assert_int_equal(effect_pass_count(e), 3);
    assert_string_equal(pass_label(effect_get_pass(e, 0)), "march");
    assert_float_equal(pass_get_scale(effect_get_pass(e, 0)), 0.25f, 0);
    assert_string_equal(pass_label(effect_get_pass(e, 1)), "far");
    graph_image color = pass_output(effect_get_pass(e, 1), "color");
    assert_int_equal(graph_get_desc(effect_graph(e), color)->format, GPU_RGBA32F);
    effect_destroy(e);
}

static void a_users_shader_is_a_pass_like_the_others(void **state) {
    (void)state;
    helper_put("tint.comp", "// Tints a picture.\n"
                            "uniform float strength; //= 0.2 [0, 1] : how much\n"
                            "uniform int kind; //= soft {hard, soft} : how\n"
                            "uniform vec2 shift; //= {0, 0} : where\n"
                            "uniform bool invert; //= false : whether\n"
                            "uniform sampler2D input_; //= input : the picture\n"
                            "uniform sampler2D mask; //= input optional : where\n"
                            "writeonly uniform image2D color; //= output rgba16f : the result\n"
                            "void main() {}\n");
    effect *e = load("local fx = effect { } local img = geometry { }\n"
                     "local a = shader { 'tint.comp', img, strength = 0.5, kind = 'hard' }\n"
                     "local b = shader { 'tint.comp', input = a, invert = true, shift = {1, 2} }\n"
                     "local c = shader('tint.comp', b, img.albedo, { strength = 1 })\n"
                     "local d = shader('tint.comp', history(c))\n"
                     "fx.output = d fx.linear = c.color fx.depth = img.depth");
    assert_int_equal(effect_pass_count(e), 5);
    assert_float_equal(uniform(e, 1, "strength", 0), 0.5, 0);
    assert_float_equal(uniform(e, 1, "kind", 0), 0, 0);
    assert_float_equal(uniform(e, 2, "invert", 0), 1, 0);
    assert_float_equal(uniform(e, 2, "shift", 0), 1, 0);
    assert_float_equal(uniform(e, 3, "strength", 0), 1, 0);
    effect_destroy(e);
    assert_null(helper_load("effect { }\nshader { 'tint.comp', geometry { }, stregth = 1 }"));
    assert_non_null(strstr(err_get(), "e.lua:2: tint.comp: unknown key 'stregth'; did you mean "
                                      "'strength'?"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(declarations_arrive),
        cmocka_unit_test(a_speed_moved_by_hand_changes_what_comes),
        cmocka_unit_test(parameters_take_their_type_from_the_default),
        cmocka_unit_test(values_move),
        cmocka_unit_test(speed_asks_for_four_dimensions),
        cmocka_unit_test(functions_of_time_do_not_gather_memory),
        cmocka_unit_test(faults_in_functions_of_time_are_reported),
        cmocka_unit_test(settings_reach_the_script),
        cmocka_unit_test(scene_values_arrive_and_others_keep_their_default),
        cmocka_unit_test(passes_get_labels_and_scales),
        cmocka_unit_test(a_users_shader_is_a_pass_like_the_others),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
