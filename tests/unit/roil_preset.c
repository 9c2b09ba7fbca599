// Presets: written, read back, and read from files that are none.
#include "roil_helper.h"

static const char script_text[] =
    "local fx = effect { }\n"
    "local density = param { 'density', 20, min = 0, max = 200 }\n"
    "local on, last = param { 'on', true }, param { 'end', 1 }\n"
    "local look = param { 'look', 'soft', words = { 'soft', 'hard' } }\n"
    "local wind = param { 'wind', {1, 0, 0.5} }\n"
    "local tint = param { 'tint', '#ff8000' }\n"
    "local fire = palette { {0, '#000000'}, {1, '#ffffff'}, space = 'oklab', min = 0, max = 4 }\n"
    "local fade = curve { {0, 1}, {2, 0.25}, period = 4 }\n"
    "local way = curve { {0, {0, 0, 0}}, {1, {1, 2, 3}} }\n"
    "fx.output = march { density = sphere { } * density }\n";

static const roil_setting moved[] = {
    {"density", "30.5"},
    {"on", "false"},
    {"end", "2"},
    {"look", "hard"},
    {"wind", "0.1,0,-3"},
    {"tint", "#123456"},
    {"fire", "0 #ff0000; 0.5 4,2,0.5 0.25; 3 #ffffff"},
    {"fade", "cubic 0 0.3; 1 7"},
    {"way", "linear 0 1,0,0; 3 1,2,3"},
    {"sun.strength", "4"},
    {"march.steps", "64"},
    {"march.albedo", "0.1,0.2,0.3"},
};

static void what_is_written_is_read(void **state) {
    (void)state;
    roil_effect *e = roil_open(script_text, moved, COUNT_OF(moved));
    need(roil_set(e, "camera.fov", "20")); // stays where it is
    need(roil_write_preset(e, "warm-2"));
    char path[PATH_CAP];
    helper_path(path, "e.lua");
    roil_preset *p = roil_read_preset(helper_roil, path, "warm-2");
    need(p);
    assert_int_equal(p->count, COUNT_OF(moved));
    roil_unload(e);
    e = roil_open(script_text, p->settings, p->count);
    for (size_t i = 0; i < COUNT_OF(moved); i++) {
        char *text = roil_control_text(e, moved[i].name);
        assert_string_equal(text, moved[i].value);
        roil_free(text);
    }
    roil_unload(e);
    roil_free_preset(p);
    helper_path(path, "e.presets/warm-2.lua");
    void *data;
    size_t size;
    assert_true(file_read(path, 1 << 20, &data, &size));
    assert_non_null(strstr(data, "-- Preset of e.lua"));
    assert_non_null(strstr(data, "\n  density = 30.5,\n"));
    assert_non_null(strstr(data, "\n  [\"march.steps\"] = 64,\n"));
    assert_null(strstr(data, "camera"));
    mem_free(data);
}

static void presets_are_listed_and_suggested(void **state) {
    (void)state;
    char names[8][64], path[PATH_CAP];
    helper_put("many.presets/b.lua", "return { }");
    helper_put("many.presets/a-1.lua", "return { }");
    helper_put("many.presets/not this.lua", "return { }");
    helper_put("many.presets/c.txt", "");
    helper_path(path, "many.lua");
    assert_int_equal(roil_presets(path, names, 8), 2);
    assert_string_equal(names[0], "a-1");
    assert_string_equal(names[1], "b");
    assert_int_equal(roil_presets(path, names, 1), 2);
    assert_int_equal(roil_presets("/none/none.lua", names, 8), 0);
    refused(roil_read_preset(helper_roil, path, "a_1"), "did you mean 'a-1'?");
    refused(roil_read_preset(helper_roil, path, "zzz"),
            "many.lua has no preset 'zzz'; it has a-1, b");
    refused(roil_read_preset(helper_roil, path, "../b"), "is not a name");
    refused(roil_read_preset(helper_roil, path, "none.lua"), "none.lua");
    helper_path(path, "many.presets/b.lua");
    roil_preset *p = roil_read_preset(helper_roil, "other.lua", path);
    need(p);
    assert_int_equal(p->count, 0);
    roil_free_preset(p);
}

static void read_text(const char *text, const char *expected) {
    char path[PATH_CAP];
    helper_put("p.lua", text);
    helper_path(path, "p.lua");
    roil_preset *p = roil_read_preset(helper_roil, "e.lua", path);
    if (!p) fail_msg("%s: %s", text, roil_error());
    strbuf found = {0};
    for (size_t i = 0; i < p->count; i++)
        strbuf_add(&found, "%s=%s|", p->settings[i].name, p->settings[i].value);
    assert_string_equal(strbuf_text(&found), expected);
    strbuf_free(&found);
    roil_free_preset(p);
}

static void every_form_becomes_a_setting(void **state) {
    (void)state;
    read_text("return { b = 1, a = true, ['m.x'] = 'word', c = {1, 2.5, 3} }",
              "a=true|b=1|c=1,2.5,3|m.x=word|");
    read_text("return { p = { {0, '#000000'}, {1, {4, 2, 0.5}, 0.8} } }",
              "p=0 #000000; 1 4,2,0.5 0.8|");
    read_text("return { c = { {0, 1}, {2, 0}, shape = 'cubic' }, d = { {0, 1} } }",
              "c=cubic 0 1; 2 0|d=linear 0 1|");
    read_text("return { c = { {0, {1, 2, 3}}, shape = 'step' } }", "c=step 0 1,2,3|");
    read_text("local x = 2 return { a = x * 21 }", "a=42|");
}

static void what_is_no_preset_is_refused(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"", "a preset returns a table"},
        {"return 3", "a preset returns a table"},
        {"return { 1, 2 }", "a preset has names"},
        {"return { a = function() end }", "'a' must be a number, true or false"},
        {"return { a = { } }", "'a' must be"},
        {"return { a = { 1, 2, 3, 4, 5 } }", "'a' must be"},
        {"return { a = { x = 1 } }", "'a' must be"},
        {"return { a = { {0, '#000'}, {1} } }", "'a' must be"},
        {"return { a = { {0, '#000'}, 3 } }", "'a' must be"},
        {"return { a = { {0, 1}, space = 'oklab' } }", "'a' must be"},
        {"return { a = 0/0 }", "'a' must be of finite numbers"},
        {"return { a = 'x\\ny' }", "'a' must be one line"},
        {"return { ['a b'] = 1 }", "is no name of a control"},
        {"return {", "p.lua:1:"},
        {"param { 'x', 1 } return { }", "param"},
        {"while true do end", "instruction limit"},
        {"local s = 'x' while true do s = s .. s end", "memory limit of 4 MiB for one string"},
        {"return setmetatable({ }, { __index = error, __pairs = error, __len = error })", ""},
        {"return { os = os.exit() }", "os"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        char path[PATH_CAP];
        helper_put("p.lua", cases[i][0]);
        helper_path(path, "p.lua");
        roil_preset *p = roil_read_preset(helper_roil, "e.lua", path);
        if (p && cases[i][1][0]) fail_msg("%s was taken", cases[i][0]);
        if (!p && !strstr(roil_error(), cases[i][1]))
            fail_msg("%s: \"%s\" is not in: %s", cases[i][0], cases[i][1], roil_error());
        roil_free_preset(p);
    }
}

static void names_that_could_leave_the_folder_are_not_written(void **state) {
    (void)state;
    roil_effect *e = roil_open(script_text, NULL, 0);
    static const char *const names[] = {"", "-a", "../a", "a/b", "a.b", "a b", "a\n"};
    for (size_t i = 0; i < COUNT_OF(names); i++)
        refused(roil_write_preset(e, names[i]), "is not a name");
    roil_unload(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read),
        cmocka_unit_test(presets_are_listed_and_suggested),
        cmocka_unit_test(every_form_becomes_a_setting),
        cmocka_unit_test(what_is_no_preset_is_refused),
        cmocka_unit_test(names_that_could_leave_the_folder_are_not_written),
    };
    return cmocka_run_group_tests(tests, roil_setup, roil_teardown);
}
