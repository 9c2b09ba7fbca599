// Controls through roil.h: what an interface shows, and what it can paste back into a script.
#include "roil_helper.h"

static const char script_text[] =
    "local fx = effect { fps = 10, frames = 50 }\n"
    "local density = param { 'density', 20, min = 0, max = 200, unit = '1/m', help = 'say "
    "\"h\\\\i\"' }\n"
    "local steps = param { 'steps', 16, min = 1, max = 64, integer = true, group = 'cost' }\n"
    "local on = param { 'on', true }\n"
    "local look = param { 'look', 'soft', words = { 'soft', 'a \"b\"' } }\n"
    "local wind = param { 'wind', {1, 0, 0.5}, min = -2, max = 2 }\n"
    "local tint = param { 'tint', '#ff8000' }\n"
    "local hot = param { 'hot', {4, 2, 0.5}, color = true }\n"
    "local size = param { 'size', 0.1, min = 0.01, max = 10, log = true }\n"
    "local fire = palette { {0, '#000000'}, {0.5, {4, 2, 0.5}, 0.8}, {1, '#ffffff'}, space = "
    "'oklab' }\n"
    "local body = palette { blackbody = {500, 3000}, physical = true, reference = 1200 }\n"
    "local keyed = palette { keys = { {0, { {0, '#000'}, {1, '#fff'} }}, {2, { {0, '#f00'}, {1, "
    "'#0f0', 0.5} }} } }\n"
    "local fade = curve { {0, 1}, {2, 0.25}, shape = 'cubic', period = 4 }\n"
    "local way = curve { {0, {0, 0, 0}}, {1, {1, 2, 3}} }\n"
    "local grown = over_age { {0, 0.125}, {0.5, 1} }\n"
    "fx.camera = orbit { target = {0, 0, 1}, distance = 6, yaw = 30 }\n"
    "local m = march { density = sphere { radius = 1 } * density, emission = fire(sphere { "
    "position = {0, 0, "
    "2} "
    "}),\n"
    "                  steps = steps, anisotropy = fade, albedo = {0.25, 0.5, 1} }\n"
    "fx.output = m\n";

static roil_effect *open(void) {
    return roil_open(script_text, NULL, 0);
}

static roil_control control_of(roil_effect *e, const char *name) {
    size_t index;
    roil_control c;
    need(roil_find_control(e, name, &index));
    roil_get_control(e, index, &c);
    assert_string_equal(c.name, name);
    return c;
}

static void control_tells_what_it_is(void **state) {
    (void)state;
    roil_effect *e = open();
    roil_control c = control_of(e, "density");
    assert_true(c.parameter && c.type == ROIL_FLOAT && c.value[0] == 20 && c.max == 200);
    assert_string_equal(c.unit, "1/m");
    assert_string_equal(control_of(e, "steps").group, "cost");
    c = control_of(e, "look");
    assert_true(c.type == ROIL_ENUM && c.word_count == 2 && !c.structural);
    c = control_of(e, "hot");
    assert_true(c.type == ROIL_COLOR && c.value[0] == 4 && c.components == 3);
    assert_true(control_of(e, "size").log_scale);
    assert_int_equal(control_of(e, "fire").type, ROIL_PALETTE);
    c = control_of(e, "way");
    assert_true(c.type == ROIL_CURVE && c.components == 3);
    c = control_of(e, "camera.fov");
    assert_string_equal(c.group, "camera");
    assert_string_equal(c.label, "fov");
    assert_true(c.value[0] == 40 && c.min == 1 && !c.driven);
    assert_int_equal(control_of(e, "sky.zenith").type, ROIL_COLOR);
    c = control_of(e, "march.steps");
    assert_true(c.driven && c.value[0] == 16 && !c.parameter);
    assert_string_equal(c.group, "march");
    assert_true(control_of(e, "march.anisotropy").driven);
    assert_true(control_of(e, "march.anisotropy").value[0] == 0.95f); // within its range
    c = control_of(e, "march.albedo");
    assert_true(c.type == ROIL_COLOR && c.value[2] == 1);
    c = control_of(e, "march.mode");
    assert_true(c.structural && c.type == ROIL_ENUM && c.word_count > 1);
    c = control_of(e, "march.resolution");
    assert_true(c.structural && c.value[0] == 1 && c.max == 1);
    for (size_t i = 0; i < roil_control_count(e); i++) {
        roil_get_control(e, i, &c);
        assert_true(c.label && c.group && c.unit && c.help && !c.moved);
        assert_memory_equal(c.value, c.initial, (size_t)c.components * sizeof *c.value);
    }
    roil_unload(e);
}

static void moved_control_remembers_the_scripts_value(void **state) {
    (void)state;
    roil_effect *e = open();
    need(roil_set(e, "march.steps", "99"));
    roil_control c = control_of(e, "march.steps");
    assert_true(c.moved && !c.driven && c.value[0] == 99 && c.initial[0] == 16);
    need(roil_set(e, "steps", "20")); // what drives it when it is reset
    need(roil_reset(e, "march.steps"));
    c = control_of(e, "march.steps");
    assert_true(!c.moved && c.driven && c.value[0] == 20);
    need(roil_set(e, "camera.eye", "1,2,3"));
    c = control_of(e, "camera.eye");
    assert_true(c.value[1] == 2 && fabsf(c.initial[2] - (1 + 6 * sinf(glm_rad(10)))) < 1e-4f);
    roil_unload(e);
}

static void engine_sets_numbers_by_handles(void **state) {
    (void)state;
    roil_effect *e = open();
    size_t density, look, steps;
    const float thick = 42, word = 1, many = 99, wrong[] = {1, 2};
    need(roil_find_control(e, "density", &density) && roil_find_control(e, "look", &look) &&
         roil_find_control(e, "march.steps", &steps));
    need(roil_set_floats(e, density, &thick, 1));
    need(roil_set_floats(e, look, &word, 1));
    need(roil_set_floats(e, steps, &many, 1)); // which a parameter has moved
    assert_true(control_of(e, "density").value[0] == 42 && control_of(e, "density").moved);
    char *text = roil_control_text(e, "look");
    assert_string_equal(text, "a \"b\"");
    roil_free(text);
    roil_control c = control_of(e, "march.steps");
    assert_true(c.value[0] == 99 && c.moved && !c.driven);
    refused(roil_set_floats(e, density, wrong, 2), "density has 1 numbers, not 2");
    refused(roil_set_floats(e, roil_control_count(e), &thick, 1), "there is no control");
    need(roil_reset(e, "density"));
    assert_true(control_of(e, "density").value[0] == 20);
    roil_unload(e);
}

// Every control as Lua, in a script: it loads, and what comes out is what went in.
static void check_lua(roil_effect *e, const char *name, const char *before, const char *after) {
    char *lua = roil_control_lua(e, name), *text = roil_control_text(e, name);
    strbuf script = {0};
    strbuf_add(&script, "local fx = effect { }\n%s%s%s\n", before, lua, after);
    roil_effect *again = roil_open(strbuf_text(&script), NULL, 0);
    char *back = roil_control_text(again, name), *lua_back = roil_control_lua(again, name);
    assert_string_equal(back, text);
    assert_string_equal(lua_back, lua);
    roil_free(back);
    roil_free(lua_back);
    roil_free(lua);
    roil_free(text);
    roil_unload(again);
    strbuf_free(&script);
}

static void check_all_lua(roil_effect *e) {
    for (size_t i = 0; i < roil_control_count(e); i++) {
        roil_control c;
        char before[256];
        roil_get_control(e, i, &c);
        if (c.driven) continue;
        if (c.parameter) {
            check_lua(e, c.name, "", "\nfx.output = geometry { }");
        } else if (c.type == ROIL_PALETTE || c.type == ROIL_CURVE) {
            snprintf(before, sizeof before, "local %s = ", c.name);
            check_lua(e, c.name, before, "\nfx.output = geometry { }");
        } else if (c.field) {
            snprintf(before, sizeof before, "fx.output = geometry { } local %s = sphere { ",
                     c.group);
            check_lua(e, c.name, before, " }");
        } else if (strcmp(c.group, "march") == 0) {
            check_lua(e, c.name, "fx.output = march { density = sphere { }, ", " }");
        } else if (strcmp(c.name, "camera.eye") == 0) {
            if (c.moved)
                check_lua(e, c.name, "fx.output = geometry { } fx.camera = camera { ", " }");
        } else {
            const char *kind = strcmp(c.group, "camera") == 0 ? "orbit" : c.group;
            snprintf(before, sizeof before, "fx.output = geometry { } fx.%s = %s { ", c.group,
                     kind);
            check_lua(e, c.name, before, " }");
        }
    }
}

static void every_control_is_lua_that_loads(void **state) {
    (void)state;
    roil_effect *e = open();
    check_all_lua(e);
    static const char *const sets[][2] = {
        {"density", "33.333"},
        {"look", "a \"b\""},
        {"hot", "0.1,0.2,0.30000001"},
        {"tint", "3,2,1"},
        {"on", "false"},
        {"march.steps", "12"},
        {"camera.eye", "1,2,0.1"},
        {"camera.target", "0,1,0"},
        {"sun.color", "#123456"},
        {"body", "0 #000000; 2 9,8,7 0.1"},
        {"fade", "step 0 7; 1 8"},
        {"grown", "linear 0 7; 0.25 8; 1 0"},
        {"march.albedo", "0.1,0.2,0.3"},
    };
    for (size_t i = 0; i < COUNT_OF(sets); i++) need(roil_set(e, sets[i][0], sets[i][1]));
    check_all_lua(e);
    char *lua = roil_control_lua(e, "density");
    assert_string_equal(lua, "param { \"density\", 33.333, min = 0, max = 200, unit = \"1/m\", "
                             "help = \"say \\\"h\\\\i\\\"\" }");
    roil_free(lua);
    lua = roil_control_lua(e, "fade");
    assert_string_equal(lua, "curve { {0, 7}, {1, 8}, shape = \"step\", period = 4 }");
    roil_free(lua);
    lua = roil_control_lua(e, "grown");
    assert_string_equal(lua, "over_age { {0, 7}, {0.25, 8}, {1, 0} }");
    roil_free(lua);
    lua = roil_control_lua(e, "march.steps");
    assert_string_equal(lua, "steps = 12");
    roil_free(lua);
    roil_unload(e);
}

static void text_that_is_said_can_be_set(void **state) {
    (void)state;
    roil_effect *e = open();
    for (size_t i = 0; i < roil_control_count(e); i++) {
        roil_control c;
        roil_get_control(e, i, &c);
        if (strcmp(c.label, "resolution") == 0 || (c.structural && !c.parameter)) continue;
        char *text = roil_control_text(e, c.name);
        need(roil_set(e, c.name, text));
        char *again = roil_control_text(e, c.name);
        assert_string_equal(text, again);
        roil_free(text);
        roil_free(again);
    }
    roil_unload(e);
}

static void palette_and_curve_are_taken_apart_and_put_together(void **state) {
    (void)state;
    roil_effect *e = open();
    roil_palette p;
    need(roil_get_palette(e, "fire", &p));
    assert_true(p.count == 3 && p.stops[1].color[0] == 4 && p.stops[1].color[3] == 0.8f &&
                p.min == 0 && p.max == 1 && !p.keyed);
    p.stops[1].at = 0.25f;
    char *text = roil_palette_text(&p);
    assert_string_equal(text, "0 #000000; 0.25 4,2,0.5 0.8; 1 #ffffff");
    need(roil_set(e, "fire", text));
    roil_free(text);
    need(roil_get_palette(e, "fire", &p));
    assert_true(p.stops[1].at == 0.25f);
    need(roil_get_palette(e, "body", &p));
    assert_true(p.count == 0 && p.min == 500 && p.max == 3000);
    need(roil_get_palette(e, "keyed", &p));
    assert_true(p.count == 2 && p.keyed);
    float colors[3][4];
    need(roil_sample_palette(e, "keyed", 2, colors, 3));
    assert_true(colors[0][0] > 0.98f && colors[2][1] > 0.98f && colors[2][0] < 0.02f);

    roil_curve c;
    need(roil_get_curve(e, "fade", &c));
    assert_true(c.count == 2 && c.components == 1 && c.period == 4);
    assert_string_equal(c.shape, "cubic");
    assert_false(c.over_age);
    roil_curve grown;
    need(roil_get_curve(e, "grown", &grown));
    assert_true(grown.over_age && grown.count == 2 && grown.keys[0].value[0] == 0.125f);
    refused(roil_set(e, "grown", "cubic 0 1; 1 2"), "linear");
    c.keys[1].value[0] = 0.5f;
    text = roil_curve_text(&c);
    assert_string_equal(text, "cubic 0 1; 2 0.5");
    need(roil_set(e, "fade", text));
    roil_free(text);
    float values[2][4];
    need(roil_sample_curve(e, "fade", (double[]){0, 3}, values, 2));
    assert_true(values[0][0] == 1 && values[1][0] == 0.5f);
    refused(roil_get_curve(e, "fire", &c), "'fire' is no curve");
    refused(roil_get_palette(e, "density", &p), "'density' is no palette");
    refused(roil_get_palette(e, "fier", &p), "did you mean 'fire'?");
    roil_unload(e);
}

static void camera_and_bounds_are_known(void **state) {
    (void)state;
    roil_effect *e = open();
    roil_camera camera;
    need(roil_get_camera(e, &camera));
    assert_true(camera.target[2] == 1 && camera.fov == 40);
    assert_true(fabsf(glm_vec3_distance(camera.eye, camera.target) - 6) < 1e-4f);
    float low[3], high[3];
    need(roil_get_bounds(e, low, high));
    for (int i = 0; i < 3; i++) assert_true(low[i] == -1 && high[i] == 1);
    need(roil_set(e, "density", "0"));
    refused(roil_get_bounds(e, low, high), "no volume");
    roil_unload(e);
    e = roil_open("local fx = effect { } fx.output = geometry { }", NULL, 0);
    refused(roil_get_bounds(e, low, high), "no volume");
    roil_unload(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(control_tells_what_it_is),
        cmocka_unit_test(moved_control_remembers_the_scripts_value),
        cmocka_unit_test(engine_sets_numbers_by_handles),
        cmocka_unit_test(every_control_is_lua_that_loads),
        cmocka_unit_test(text_that_is_said_can_be_set),
        cmocka_unit_test(palette_and_curve_are_taken_apart_and_put_together),
        cmocka_unit_test(camera_and_bounds_are_known),
    };
    return cmocka_run_group_tests(tests, roil_setup, roil_teardown);
}
