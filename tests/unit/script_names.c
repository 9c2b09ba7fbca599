// What palettes and curves are called, and which parameters are structure.
#include "script_helper.h"

#include "base/memory.h"

static effect *load(const char *body) {
    char text[4096];
    snprintf(text, sizeof text, "local fx = effect { }\nfx.output = geometry { }\n%s", body);
    effect *e = helper_load(text);
    if (!e) fail_msg("%s", err_get());
    return e;
}

static void expect(const char *body, const char *names) {
    effect *e = load(body);
    strbuf found = {0};
    for (size_t i = 0; i < effect_control_count(e); i++) {
        const effect_control *c = effect_get_control(e, i);
        if (c->kind != EFFECT_CONTROL_PALETTE && c->kind != EFFECT_CONTROL_CURVE) continue;
        strbuf_add(&found, "%s%s", found.length ? " " : "", c->name);
    }
    if (strcmp(strbuf_text(&found), names) != 0)
        fail_msg("%s: is called '%s', not '%s'", body, strbuf_text(&found), names);
    strbuf_free(&found);
    effect_destroy(e);
}

#define STOPS "{ {0, '#000'}, {1, '#fff'} }"

static void variables_and_fields_name_what_they_hold(void **state) {
    (void)state;
    expect("local fire = palette " STOPS, "fire");
    expect("local fire=palette" STOPS, "fire");
    expect("local fire <const> = palette(" STOPS ")", "fire");
    expect("local t = { glow = palette " STOPS ", fade = curve { {0, 1} } }", "glow fade");
    expect("fx = { }; fx.fade = curve { {0, 1}, {2, 3} }", "fade");
    expect("local p = palette\nlocal fire = p " STOPS, "palette");
}

#define AGES "{ {0, 1}, {1, 0.5} }"

static void what_goes_over_age_is_named_as_what_it_is(void **state) {
    (void)state;
    expect("local fading = over_age " AGES, "fading");
    expect("local t = { size = over_age " AGES ", opacity = over_age " AGES " }", "size opacity");
    expect("local t = { size = 2 * over_age " AGES " }", "size");
    expect("for i = 1, 2 do local t = { a = over_age " AGES ", b = over_age " AGES " } end",
           "a b a_2 b_2");
    effect *e = load("local size = over_age " AGES
                     "\nlocal hue = over_age { {0, '#f00'}, {1, {0, 1, 0}} }\n"
                     "local edge = over_age { {0, 1}, {0.5, 1}, {0.5, 0} }");
    const effect_control *size = effect_find_control(e, "size"),
                         *hue = effect_find_control(e, "hue"),
                         *edge = effect_find_control(e, "edge");
    assert_true(effect_control_is_over_age(size) && effect_control_is_over_age(edge));
    assert_string_equal(size->initial, "linear 0 1; 1 0.5");
    assert_int_equal(effect_control_curve(edge)->count, 3);
    assert_true(hue->kind == EFFECT_CONTROL_PALETTE && !effect_control_is_over_age(hue));
    effect_destroy(e);
}

// Of what is given to a call: what that makes, and the key.
static void what_a_call_is_given_is_named_after_both(void **state) {
    (void)state;
    expect("local lamp = point_light { position = {0, 0, 1}, power = curve { {0, 1} } }",
           "lamp_power");
    expect("local lamp <const> = point_light({ position = {0, 0, 1}, power = 3 * curve { {0, 1} } "
           "+ 1 })",
           "lamp_power");
    expect(
        "fx.camera = orbit { distance = curve { {0, 1} }, fov = 30, yaw = 2 * curve { {0, 1} } }",
        "camera_distance camera_yaw");
    expect(
        "local l = point_light { name = 'glow', position = {0, 0, 1}, power = curve { {0, 1} } }",
        "glow_power");
    expect("fx.output = geometry { max_distance = 9 * curve { {0, 1} } }", "max_distance");
    expect("print(point_light { position = {0, 0, 1}, power = curve { {0, 1} } })", "power");
    expect("local a = 2 * curve { {0, 1} }", "a");
    expect("local a = max(2, 1 + curve { {0, 1} })", "a");
    expect("local a = { curve { {0, 1} }, curve { {0, 1} } }", "a a_2");
    expect("local function f() local b = 1; return curve { {0, 1} } end local a = f()", "curve");
    expect("local f = function() return curve { {0, 1} } end\nlocal a = f()", "curve");
}

static void calls_over_several_lines_are_found(void **state) {
    (void)state;
    expect("local fire = palette {\n  {0, '#000'},\n  {1, '#fff'},\n}", "fire");
    expect("local fire =\n  palette " STOPS, "fire");
    expect("local fire = palette\n{\n  {0, '#000'}, {1, '#fff'}\n}", "fire");
    expect("local fade = curve {\n {0,\n 1},\n}\nlocal other = curve { {0, 2} }", "fade other");
}

static void what_has_no_variable_is_numbered(void **state) {
    (void)state;
    expect("print(palette " STOPS ")", "palette");
    expect("curve { {0, 1} }", "curve");
    expect("local a = 1\nprint(2 * curve { {0, 1} })", "curve");
    expect("local function make() return palette " STOPS " end\nlocal a, b = make(), make()",
           "palette palette_2");
    expect("assert(nil == curve { {0, 1} } or true)", "curve");
    expect("for i = 1, 3 do local fire = palette " STOPS " end", "fire fire_2 fire_3");
}

static void those_beyond_a_limit_have_no_name(void **state) {
    (void)state;
    effect *e = load("for i = 1, 300 do local c = curve { {0, 1} } end");
    size_t count = 0;
    for (size_t i = 0; i < effect_control_count(e); i++)
        count += effect_get_control(e, i)->kind == EFFECT_CONTROL_CURVE;
    assert_int_equal(count, EFFECT_MAX_RAMPS);
    effect_destroy(e);
}

static void key_wins(void **state) {
    (void)state;
    expect("local a = palette { {0, '#000'}, {1, '#fff'}, name = 'fire' }\n"
           "local fire = curve { {0, 1}, name = 'fire' }",
           "fire fire_2");
    assert_null(helper_load("effect { } palette { {0, '#000'}, {1, '#fff'}, name = 'a b' }"));
    assert_non_null(strstr(err_get(), "palette: name 'a b' is not a name"));
}

static void module_names_by_its_own_lines(void **state) {
    (void)state;
    helper_put("fires.lua", "local m = { }\nm.ember = palette " STOPS "\nreturn m");
    expect("local fire = require('fires').ember", "ember");
}

static void settings_reach_what_a_script_names(void **state) {
    (void)state;
    static const effect_setting settings[] = {{"fire", "0 #ff0000; 1 #00ff00", NULL},
                                              {"fade", "linear 0 5", NULL},
                                              {"camera.fov", "20", NULL}};
    effect *e = helper_load_with("local fx = effect { }\nlocal fire = palette " STOPS
                                 "\nlocal fade = curve { {0, 1} }\nassert(fade:get() == 5)\n"
                                 "fx.camera = orbit { fov = 50 }\nfx.output = geometry { }",
                                 NULL, settings, COUNT_OF(settings));
    if (!e || !effect_check_settings(e)) fail_msg("%s", err_get());
    for (size_t i = 0; i < COUNT_OF(settings); i++)
        assert_string_equal(effect_control_setting(effect_find_control(e, settings[i].name)),
                            settings[i].text);
    assert_string_equal(effect_find_control(e, "camera.fov")->initial, "50");
    assert_true(effect_scene(e)->camera.fov->value[0] == 20);
    effect_destroy(e);
}

static bool structural(effect *e, const char *name) {
    for (size_t i = 0; i < effect_param_count(e); i++)
        if (strcmp(effect_get_param(e, i)->desc.name, name) == 0)
            return effect_get_param(e, i)->structural;
    fail_msg("no parameter %s", name);
    return false;
}

static void parameters_read_while_loading_are_structure(void **state) {
    (void)state;
    effect *e = load("local a, b, c, d, e = param { 'a', 1 }, param { 'b', 1 }, param { 'c', 1 },\n"
                     "  param { 'd', 1 }, param { 'e', 1 }\n"
                     "if a:get() > 0 then (2 * b + c):get() end\n"
                     "fx.sun = sun { strength = function(t) return d:get() end }\n"
                     "fx.update = function(t, dt) e:set(e:get()) end");
    assert_true(structural(e, "a") && structural(e, "b") && structural(e, "c"));
    assert_false(structural(e, "d") || structural(e, "e"));
    effect_destroy(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variables_and_fields_name_what_they_hold),
        cmocka_unit_test(what_goes_over_age_is_named_as_what_it_is),
        cmocka_unit_test(what_a_call_is_given_is_named_after_both),
        cmocka_unit_test(calls_over_several_lines_are_found),
        cmocka_unit_test(what_has_no_variable_is_numbered),
        cmocka_unit_test(those_beyond_a_limit_have_no_name),
        cmocka_unit_test(key_wins),
        cmocka_unit_test(module_names_by_its_own_lines),
        cmocka_unit_test(settings_reach_what_a_script_names),
        cmocka_unit_test(parameters_read_while_loading_are_structure),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
