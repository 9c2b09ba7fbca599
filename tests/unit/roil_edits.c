// Values written back into the script: the file afterwards, byte by byte, and what it loads as.
#include "roil_helper.h"

static const char script_text[] =
    "-- march { steps = 7 } is a comment\n"
    "local fx = effect { }\n"
    "local density = param { 'density', 20, min = 0, max = 200 } -- thick\n"
    "local on, last = param { 'on', true }, param { 'last', 1 }\n"
    "local look = param { 'look', \"soft\", words = { 'soft', 'hard' } }\n"
    "local wind = param { 'wind', {1, 0, 0.5}, help = [[a } in a text]] }\n"
    "local tint = param { 'tint', '#ff8000' }\n"
    "local fire <const> = palette { {0, '#000000'}, {1, '#ffffff'}, space = 'oklab' }\n"
    "local fade = curve {\n"
    "  {0, 1}, -- at first\n"
    "  {2, 0.25},\n"
    "}\n"
    "fx.camera = orbit { target = {0, 0, 1}, distance = 8, yaw = 30, pitch = 10 }\n"
    "fx.sun = sun { strength = 2 }\n"
    "local ball = sphere { }\n"
    "fx.output = march {\n"
    "  density = ball * density, -- as above\n"
    "  steps = 128,\n"
    "  mode = 'physical',\n"
    "  albedo = {1, 1, 1} }\n";

static roil_edits *edits_of(roil_effect *e, const char *control) {
    roil_edits *x = roil_edits_create(e, control);
    need(x);
    return x;
}

static void file_is(const char *expected) {
    char path[PATH_CAP];
    void *data;
    size_t size;
    helper_path(path, "e.lua");
    assert_true(file_read(path, 1 << 20, &data, &size));
    assert_string_equal(data, expected);
    mem_free(data);
}

static void all_kinds_are_written(void **state) {
    (void)state;
    static const roil_setting moved[] = {
        {"density", "30.5"},
        {"on", "false"},
        {"last", "2"},
        {"look", "hard"},
        {"wind", "0.1,0,-3"},
        {"tint", "#123456"},
        {"fire", "0 #ff0000; 0.5 4,2,0.5 0.25; 3 #ffffff"},
        {"fade", "cubic 0 0.3; 1 7"},
        {"camera.distance", "9"},
        {"sun.strength", "4"},
        {"sun.azimuth", "200"}, // which the script leaves open
        {"march.steps", "64"},
        {"march.mode", "paper"},
        {"march.jitter", "0.25"}, // the same
    };
    roil_effect *e = roil_open(script_text, moved, COUNT_OF(moved));
    roil_edits *x = edits_of(e, NULL);
    need(roil_edits_write(x));
    file_is("-- march { steps = 7 } is a comment\n"
            "local fx = effect { }\n"
            "local density = param { 'density', 30.5, min = 0, max = 200 } -- thick\n"
            "local on, last = param { 'on', false }, param { 'last', 2 }\n"
            "local look = param { 'look', \"hard\", words = { 'soft', 'hard' } }\n"
            "local wind = param { 'wind', {0.1, 0, -3}, help = [[a } in a text]] }\n"
            "local tint = param { 'tint', \"#123456\" }\n"
            "local fire <const> = palette { {0, \"#ff0000\"}, {0.5, {4, 2, 0.5}, 0.25}, {3, "
            "\"#ffffff\"}, space = \"oklab\" }\n"
            "local fade = curve {\n"
            "  {0, 0.3},\n"
            "  {1, 7},\n"
            "  shape = \"cubic\",\n"
            "}\n"
            "fx.camera = orbit { target = {0, 0, 1}, distance = 9, yaw = 30, pitch = 10 }\n"
            "fx.sun = sun { strength = 4, azimuth = 200 }\n"
            "local ball = sphere { }\n"
            "fx.output = march {\n"
            "  density = ball * density, -- as above\n"
            "  steps = 64,\n"
            "  mode = \"paper\",\n"
            "  albedo = {1, 1, 1}, jitter = 0.25 }\n");
    char path[PATH_CAP];
    helper_path(path, "e.lua");
    roil_effect *again = roil_load(helper_roil, path, NULL, 0);
    need(again);
    for (size_t i = 0; i < COUNT_OF(moved); i++) {
        char *text = roil_control_text(again, moved[i].name);
        assert_string_equal(text, moved[i].value);
        roil_free(text);
    }
    roil_unload(again);
    need(roil_edits_undo(x));
    file_is(script_text);
    roil_edits_free(x);
    roil_unload(e);
}

static void what_will_change_is_listed(void **state) {
    (void)state;
    static const roil_setting moved[] = {
        {"on", "false"}, {"last", "2"}, {"fade", "linear 0 3; 1 7"}};
    roil_effect *e = roil_open(script_text, moved, COUNT_OF(moved));
    roil_edit list[4];
    roil_edits *x = edits_of(e, NULL);
    assert_int_equal(roil_edits_list(x, list, 4), 2);
    assert_string_equal(list[0].controls, "on, last");
    assert_int_equal(list[0].line, 4);
    assert_string_equal(list[0].before,
                        "local on, last = param { 'on', true }, param { 'last', 1 }");
    assert_string_equal(list[0].after,
                        "local on, last = param { 'on', false }, param { 'last', 2 }");
    assert_string_equal(list[1].controls, "fade");
    assert_int_equal(list[1].line, 9);
    assert_string_equal(list[1].after,
                        "local fade = curve {\n  {0, 3},\n  {1, 7},\n  shape = \"linear\",\n}");
    roil_edits_free(x);
    x = edits_of(e, "last"); // one alone
    need(roil_edits_write(x));
    assert_int_equal(roil_edits_list(x, list, 4), 1);
    assert_string_equal(list[0].after,
                        "local on, last = param { 'on', true }, param { 'last', 2 }");
    roil_edits_free(x);
    refused(roil_edits_create(e, "lost"), "did you mean 'last'?");
    roil_unload(e);
}

static void a_turned_camera_is_an_orbit_again(void **state) {
    (void)state;
    roil_effect *e = roil_open(script_text, NULL, 0);
    need(roil_set(e, "camera.eye", "5,0,1"));
    need(roil_set(e, "camera.target", "0,0,1"));
    roil_edits *x = edits_of(e, NULL);
    need(roil_edits_write(x));
    roil_edits_free(x);
    roil_unload(e);
    char path[PATH_CAP], line[] = "orbit { target = {0, 0, 1}, distance = 5, yaw = 90, pitch = 0 }";
    void *data;
    size_t size;
    helper_path(path, "e.lua");
    assert_true(file_read(path, 1 << 20, &data, &size));
    if (!strstr(data, line)) fail_msg("%s", (char *)data);
    mem_free(data);
    e = roil_load(helper_roil, path, NULL, 0);
    need(e);
    roil_camera camera;
    need(roil_get_camera(e, &camera));
    assert_float_equal(camera.eye[0], 5, 1e-4);
    assert_float_equal(camera.eye[1], 0, 1e-4);
    roil_unload(e);
}

// Returns why the setting cannot be written into the script.
static void refuses(const char *text, const char *name, const char *value, const char *reason) {
    roil_effect *e = roil_open(text, &(roil_setting){name, value}, 1);
    roil_edit edit;
    roil_edits *x = edits_of(e, NULL);
    assert_int_equal(roil_edits_list(x, &edit, 1), 1);
    if (!edit.refusal || !strstr(edit.refusal, reason))
        fail_msg("%s: \"%s\" is not in: %s", name, reason,
                 edit.refusal ? edit.refusal : edit.after);
    need(roil_edits_write(x));
    file_is(text);
    roil_edits_free(x);
    roil_unload(e);
}

#define HEAD "local fx = effect { }\n"
#define TAIL "fx.output = march { density = sphere { } }\n"

static void what_is_computed_stays(void **state) {
    (void)state;
    refuses(HEAD "local n = 8\nfx.output = march { density = sphere { }, steps = n * 4 }\n",
            "march.steps", "64", "e.lua:3: it is computed there: n * 4");
    refuses(HEAD "local function d(v) return param { 'd', v } end\nlocal x = d(3)\n" TAIL, "d", "4",
            "it is computed there: v");
    refuses(HEAD "for i = 1, 2 do local x = param { 'd' .. i, 2 } end\n" TAIL, "d1", "4",
            "line 2 makes several by one 'param'");
    refuses(HEAD "local p = palette { {0, '#000'}, {1, string.format('#%s', 'fff')} }\n" TAIL, "p",
            "0 #ff0000; 1 #fff", "it is computed there: { {0, '#000'}");
    refuses(HEAD "local t = { 'd', 3 }\nlocal x = param(t)\n" TAIL, "d", "4",
            "line 3 has no call of 'param' with a table of values");
    refuses(HEAD "fx.camera = orbit { distance = math.sqrt(16) }\n" TAIL, "camera.eye", "1,2,3",
            "'distance': it is computed there: math.sqrt(16)");
}

static const char field_text[] = HEAD
    "local lumps = worley { frequency = 1.5, octaves = 3, seed = 1 }\n"
    "local way = vec(1, 0, 0)\n"
    "fx.output = march { density = sphere { position = {0, 0, 1}, radius = 2 } * lumps,\n"
    "  emission = sphere { position = way, radius = lumps } * box { {0, 0, 0}, {1, 1, 1} } }\n";

static void numbers_of_fields_are_controls(void **state) {
    (void)state;
    static const roil_setting moved[] = {
        {"lumps.frequency", "4"}, {"sphere.position", "0,1,0"}, {"box.size", "2,3,4"}};
    roil_effect *e = roil_open(field_text, moved, COUNT_OF(moved));
    size_t index;
    roil_control c;
    need(roil_find_control(e, "lumps.frequency", &index));
    roil_get_control(e, index, &c);
    assert_true(c.field && c.moved && !c.driven && !c.structural && c.type == ROIL_FLOAT);
    assert_float_equal(c.value[0], 4, 0);
    assert_float_equal(c.initial[0], 1.5, 0);
    assert_string_equal(c.unit, "1/m");
    assert_string_equal(c.group, "lumps");
    refused(roil_find_control(e, "sphere_2.position", &index), "nothing is named"); // a field
    refused(roil_set(e, "lumps.octaves", "99"), "accepted: 1 to 12");
    need(roil_set(e, "lumps.octaves", "5"));
    need(roil_reset(e, "lumps.octaves"));
    char *text = roil_control_text(e, "lumps.octaves");
    assert_string_equal(text, "3");
    roil_free(text);
    roil_edit list[4];
    roil_edits *x = edits_of(e, NULL);
    need(roil_edits_write(x));
    assert_int_equal(roil_edits_list(x, list, 4), 3);
    assert_string_equal(list[0].controls, "box.size");
    assert_non_null(strstr(list[0].refusal, "it is not written there by its name"));
    assert_string_equal(list[1].after,
                        "local lumps = worley { frequency = 4, octaves = 3, seed = 1 }");
    assert_non_null(strstr(list[2].after, "sphere { position = {0, 1, 0}, radius = 2 }"));
    roil_edits_free(x);
    roil_unload(e);
}

static void a_number_becomes_a_parameter(void **state) {
    (void)state;
    roil_effect *e = roil_open(field_text, &(roil_setting){"lumps.frequency", "4"}, 1);
    roil_edit edit;
    roil_edits *x = roil_edits_create_parameter(e, "lumps.frequency");
    need(x);
    need(roil_edits_write(x));
    assert_int_equal(roil_edits_list(x, &edit, 1), 1);
    assert_string_equal(edit.after,
                        "local lumps = worley { frequency = param { \"lumps_frequency\", 4, min = "
                        "1e-06, max = 1e+06, log = true, unit = \"1/m\", help = \"lattice cells "
                        "a metre, of the first octave\" }, octaves = 3, seed = 1 }");
    roil_edits_free(x);
    x = roil_edits_create_parameter(e, "march.steps"); // which the script leaves open
    assert_int_equal(roil_edits_list(x, &edit, 1), 1);
    assert_non_null(strstr(edit.after, ", steps = param { \"march_steps\", 128, min = 1, max = "));
    roil_edits_free(x);
    roil_unload(e);
    char path[PATH_CAP];
    helper_path(path, "e.lua");
    e = roil_load(helper_roil, path, &(roil_setting){"lumps_frequency", "3"}, 1);
    need(e);
    refused(roil_edits_create_parameter(e, "lumps_frequency"), "cannot become a parameter");
    roil_unload(e);
}

static void a_tile_follows_by_another_load(void **state) {
    (void)state;
    roil_effect *e = roil_open(HEAD "local lumps = worley { frequency = 1.5 }:tile()\n"
                                    "fx.output = march { density = sphere { } * lumps }\n",
                               NULL, 0);
    size_t index;
    roil_control c;
    need(roil_find_control(e, "lumps.frequency", &index));
    roil_get_control(e, index, &c);
    assert_true(c.structural);
    roil_unload(e);
}

static void a_file_that_changed_is_left_alone(void **state) {
    (void)state;
    roil_effect *e = roil_open(script_text, &(roil_setting){"density", "3"}, 1);
    roil_edits *x = edits_of(e, NULL);
    helper_put("e.lua", "-- mine\n");
    refused(roil_edits_write(x), "has changed meanwhile");
    file_is("-- mine\n");
    refused(roil_edits_undo(x), "has changed meanwhile");
    roil_edits_free(x);
    roil_unload(e);
    helper_put("e.lua", script_text);
    e = roil_open(script_text, &(roil_setting){"density", "3"}, 1);
    helper_put("e.lua", "\n"); // lines are other ones
    x = edits_of(e, NULL);
    roil_edit edit;
    assert_int_equal(roil_edits_list(x, &edit, 1), 1);
    assert_non_null(edit.refusal);
    roil_edits_free(x);
    roil_unload(e);
    e = roil_open(HEAD "local x = param { 'x', 1 }\n" TAIL, &(roil_setting){"x", "3"}, 1);
    helper_put("e.lua", HEAD "local x = param { 'x', 2 }\n" TAIL);
    x = edits_of(e, NULL);
    assert_int_equal(roil_edits_list(x, &edit, 1), 1);
    assert_non_null(strstr(edit.refusal, "2, is not what the effect began with"));
    roil_edits_free(x);
    roil_unload(e);
}

static void modules_of_the_effect_are_written(void **state) {
    (void)state;
    helper_put("look.lua", "return { thick = param { 'thick', 3 } }\n");
    roil_effect *e = roil_open("local look = require 'look'\n" HEAD
                               "fx.output = march { density = sphere { } * look.thick }\n",
                               &(roil_setting){"thick", "4"}, 1);
    roil_edits *x = edits_of(e, NULL);
    need(roil_edits_write(x));
    roil_edits_free(x);
    roil_unload(e);
    char path[PATH_CAP];
    void *data;
    size_t size;
    helper_path(path, "look.lua");
    assert_true(file_read(path, 1 << 20, &data, &size));
    assert_string_equal(data, "return { thick = param { 'thick', 4 } }\n");
    mem_free(data);
}

// ---- layers of noise
// ------------------------------------------------------------------------------

static const char layers_text[] =
    "local fx = effect { }\n"
    "local size = param { 'size', 3 }\n"
    "local lumps = layers { {2, 1}, {size, 0.5}, seed = 4, fractal = 'billow' } -- both\n"
    "local dust = layers {\n"
    "  {1, 1}, -- coarse\n"
    "  {4, 0.5}, -- fine\n"
    "  speed = 0.5,\n"
    "}\n"
    "local one = layers { {3, 1} }\n"
    "local list = { {1, 1}, {2, 1} }\n"
    "local made = layers(list)\n"
    "local part = layers { {1, 1}, list[2] }\n"
    "fx.output = march { density = sphere { } * (lumps + dust + one + made + part) }\n";

// Changes a list of layers; of the file's text `before` becomes `after`.
static void layer_changes(const char *list, size_t layer, roil_layer_change how, const char *before,
                          const char *after, const roil_setting *moved, size_t count) {
    roil_effect *e = roil_open(layers_text, moved, count);
    roil_edits *x = roil_edits_create_layer(e, list, layer, how);
    need(x);
    char path[PATH_CAP];
    const char *at = strstr(layers_text, before);
    assert_non_null(at);
    strbuf expected = {0};
    strbuf_add(&expected, "%.*s%s%s", (int)(at - layers_text), layers_text, after,
               at + strlen(before));
    need(roil_edits_write(x));
    file_is(strbuf_text(&expected));
    helper_path(path, "e.lua");
    roil_effect *again = roil_load(helper_roil, path, NULL, 0);
    need(again);
    roil_unload(again);
    need(roil_edits_undo(x));
    file_is(layers_text);
    strbuf_free(&expected);
    roil_edits_free(x);
    roil_unload(e);
}

static void layers_come_and_go(void **state) {
    (void)state;
    const roil_setting moved[] = {{"lumps.scale_1", "2.5"}, {"lumps.seed", "9"}};
    layer_changes("lumps", 0, ROIL_LAYER_ADD, "{size, 0.5},", "{size, 0.5}, {2 * size, 0.25},",
                  NULL, 0);
    layer_changes("lumps", 2, ROIL_LAYER_DUPLICATE, "{size, 0.5},", "{size, 0.5}, {size, 0.5},",
                  NULL, 0);
    layer_changes("lumps", 1, ROIL_LAYER_REMOVE, "{2, 1}, {size", "{size", NULL, 0);
    layer_changes("lumps", 1, ROIL_LAYER_DUPLICATE, "{2, 1}, {size, 0.5}, seed = 4",
                  "{2.5, 1}, {2.5, 1}, {size, 0.5}, seed = 4", moved, 2);
    layer_changes("lumps", 1, ROIL_LAYER_REMOVE, "{2, 1}, {size", "{size", moved, 2);
    layer_changes("dust", 0, ROIL_LAYER_ADD, "{4, 0.5},", "{4, 0.5},\n  {8, 0.25},", NULL, 0);
    layer_changes("dust", 1, ROIL_LAYER_DUPLICATE, "{1, 1}, -- coarse",
                  "{1, 1},\n  {1, 1}, -- coarse", NULL, 0);
    layer_changes("dust", 2, ROIL_LAYER_REMOVE, "{4, 0.5}, -- fine\n  speed", "speed", NULL, 0);
    layer_changes("one", 0, ROIL_LAYER_ADD, "{3, 1} }", "{3, 1}, {6, 0.5} }", NULL, 0);
}

static void numbers_of_layers_are_written(void **state) {
    (void)state;
    const roil_setting moved[] = {
        {"lumps.strength_2", "0.75"}, {"dust.scale_2", "5"}, {"dust.seed", "8"}};
    roil_effect *e = roil_open(layers_text, moved, COUNT_OF(moved));
    roil_layers all[8];
    assert_int_equal(roil_list_layers(e, all, COUNT_OF(all)), 5);
    assert_string_equal(all[1].name, "dust");
    assert_int_equal(all[1].count, 2);
    roil_edits *x = edits_of(e, NULL);
    roil_edit list[4];
    assert_int_equal(roil_edits_list(x, list, COUNT_OF(list)), 3);
    assert_string_equal(list[0].after,
                        "local lumps = layers { {2, 1}, {size, 0.75}, seed = 4, fractal = 'billow' "
                        "} -- both");
    assert_string_equal(list[1].after, "  {5, 0.5}, -- fine");
    assert_string_equal(list[2].after, "  speed = 0.5, seed = 8,");
    roil_edits_free(x);
    roil_unload(e);
}

static void layers_stay(roil_effect *e, const char *name, size_t layer, roil_layer_change how,
                        const char *why) {
    roil_edits *x = roil_edits_create_layer(e, name, layer, how);
    roil_edit edit;
    need(x);
    assert_int_equal(roil_edits_list(x, &edit, 1), 1);
    assert_non_null(edit.refusal);
    if (!strstr(edit.refusal, why)) fail_msg("%s: %s", name, edit.refusal);
    roil_edits_free(x);
}

static void computed_layers_stay(void **state) {
    (void)state;
    roil_effect *e = roil_open(layers_text, NULL, 0);
    layers_stay(e, "made", 0, ROIL_LAYER_ADD, "has no call of 'layers' with a table");
    layers_stay(e, "part", 0, ROIL_LAYER_ADD, "layer 2 is computed there: list[2]");
    layers_stay(e, "one", 1, ROIL_LAYER_REMOVE, "the last layer stays");
    assert_null(roil_edits_create_layer(e, "none", 1, ROIL_LAYER_ADD));
    assert_null(roil_edits_create_layer(e, "one", 2, ROIL_LAYER_REMOVE));
    assert_non_null(strstr(roil_error(), "'one' has no layer 2; it has 1"));
    roil_unload(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_kinds_are_written),
        cmocka_unit_test(what_will_change_is_listed),
        cmocka_unit_test(a_turned_camera_is_an_orbit_again),
        cmocka_unit_test(what_is_computed_stays),
        cmocka_unit_test(numbers_of_fields_are_controls),
        cmocka_unit_test(a_number_becomes_a_parameter),
        cmocka_unit_test(a_tile_follows_by_another_load),
        cmocka_unit_test(a_file_that_changed_is_left_alone),
        cmocka_unit_test(modules_of_the_effect_are_written),
        cmocka_unit_test(layers_come_and_go),
        cmocka_unit_test(numbers_of_layers_are_written),
        cmocka_unit_test(computed_layers_stay),
    };
    return cmocka_run_group_tests(tests, roil_setup, roil_teardown);
}
