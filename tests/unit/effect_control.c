// Controls: the list of all that can be set by name, and settings that come and go.
#include "effect_helper.h"

static const effect_param gain = {
    .desc = {"gain", VALUE_NUMBER, 1, .value = {0.5f}, .min = 0, .max = 2, .unit = "", .help = ""}};
static const effect_param tint = {.desc = {"tint", VALUE_COLOR, 3, .value = {1, 1, 1}, .min = 0,
                                           .max = 9, .unit = "", .help = ""}};

static palette *add_palette(stage *s, const char *name, const char *expected) {
    static const palette_stop stops[] = {{0, {0, 0, 0, 1}}, {2, {1, 1, 1, 0.5f}}};
    palette *p = palette_create(
        effect_memory(s->e), &(palette_desc){.keys = &(palette_key){0, stops, 2}, .key_count = 1});
    ok(p);
    assert_string_equal(effect_add_palette(s->e, p, name), expected);
    return p;
}

static curve *add_curve(stage *s, const char *name, const char *expected) {
    static const curve_key keys[] = {{0, {1}}, {2, {3}}};
    curve *c = curve_create(effect_memory(s->e), &(curve){CURVE_LINEAR, 1, keys, 2, 4});
    ok(c);
    assert_string_equal(effect_add_curve(s->e, c, name), expected);
    return c;
}

// {0, 1}, {1, 3} over a particle's life, called "size"; returns what fields read of it.
static palette *add_age_curve(stage *s) {
    static const curve_key keys[] = {{0, {1}}, {1, {3}}};
    static const palette_stop stops[] = {{0, {1, 1, 1, 1}}, {1, {3, 3, 3, 1}}};
    arena *memory = effect_memory(s->e);
    palette *p = palette_create(
        memory, &(palette_desc){.keys = &(palette_key){0, stops, 2}, .key_count = 1});
    curve *c = curve_create(memory, &(curve){CURVE_LINEAR, 1, keys, 2, 0});
    ok(p && c);
    assert_string_equal(effect_add_age_curve(s->e, c, p, "size"), "size");
    return p;
}

static const effect_control *control_of(stage *s, const char *name) {
    const effect_control *c = effect_find_control(s->e, name);
    ok(c);
    return c;
}

static void says(stage *s, const char *name, const char *expected) {
    strbuf text = {0};
    effect_print_control(s->e, control_of(s, name), &text);
    assert_string_equal(strbuf_text(&text), expected);
    strbuf_free(&text);
}

static const field *driven(stage *s) {
    const field *node = field_curve(effect_memory(s->e), add_curve(s, "motion", "motion"));
    ok(node);
    return node;
}

// ---- the list ---------------------------------------------------------------------------------

static void list_has_its_order_however_things_are_declared(void **state) {
    stage *s = *state;
    ok(pass_declare(add_march(s, NULL)));
    add_curve(s, "fade", "fade");
    assert_int_equal(effect_add_param(s->e, &gain), 0);
    add_palette(s, "fire", "fire");
    assert_int_equal(effect_add_param(s->e, &tint), 1);
    ok(effect_check_settings(s->e));
    static const char *const first[] = {"gain", "tint", "fade", "fire", "camera.eye"};
    for (size_t i = 0; i < COUNT_OF(first); i++)
        assert_string_equal(effect_get_control(s->e, i)->name, first[i]);
    int before = -1;
    for (size_t i = 4; i < effect_control_count(s->e); i++) {
        const effect_control *c = effect_get_control(s->e, i);
        int now = strncmp(c->name, "march.", 6) == 0 ? 1 : 0;
        assert_true(now >= before);
        before = now;
        assert_true(c->initial && c->initial[0] && !c->moved);
        if (c->kind == EFFECT_CONTROL_SCENE) assert_true(strchr(c->name, '.'));
    }
    assert_string_equal(effect_get_control(s->e, effect_control_count(s->e) - 1)->name,
                        "march.resolution");
}

static void initial_is_what_the_script_says(void **state) {
    stage *s = *state;
    pass *p = add_march(s, NULL);
    ok(pass_set_uniform(p, "steps", number(s, 5)));
    ok(pass_set_uniform(p, "anisotropy", driven(s)));
    ok(pass_declare(p));
    add_palette(s, "fire", "fire");
    assert_int_equal(effect_add_param(s->e, &tint), 0);
    ok(effect_check_settings(s->e));
    static const char *const expected[][2] = {
        {"tint", "#ffffff"},
        {"fire", "0 #000000; 2 #ffffff 0.5"},
        {"motion", "linear 0 1; 2 3"},
        {"camera.eye", "orbit 6 0 10"},
        {"camera.fov", "40"},
        {"sun.color", "#ffffff"},
        {"march.steps", "5"},
        {"march.albedo", "0.5,0.5,0.5"},
        {"march.anisotropy", "curve linear 0 1; 2 3"},
        {"march.mode", "physical"},
        {"march.resolution", "1"},
    };
    for (size_t i = 0; i < COUNT_OF(expected); i++) {
        assert_string_equal(control_of(s, expected[i][0])->initial, expected[i][1]);
        says(s, expected[i][0], expected[i][1]);
    }
}

static void names_are_made_unique(void **state) {
    stage *s = *state;
    palette *p = add_palette(s, "fire", "fire");
    add_palette(s, "fire", "fire_2");
    add_curve(s, "fire", "fire_3");
    effect_param fire = gain;
    fire.desc.name = "fire";
    ok(effect_set(s->e, "fire", "0 #ff0000; 1 #00ff00"));
    assert_int_equal(effect_add_param(s->e, &fire), 0); // a parameter keeps its name
    assert_true(effect_control_palette(control_of(s, "fire_4")) == p);
    assert_false(control_of(s, "fire_4")->moved);
    ok(effect_set(s->e, "fire", "1.5"));
    assert_true(effect_get_param(s->e, 0)->value[0] == 1.5f);
}

static void names_not_known_get_a_suggestion(void **state) {
    stage *s = *state;
    add_palette(s, "fire", "fire");
    ok(effect_check_settings(s->e));
    assert_null(effect_find_control(s->e, "fier"));
    assert_error("did you mean 'fire'?");
    assert_false(effect_reset(s->e, "camera.fow"));
    assert_error("did you mean 'camera.fov'?");
}

// ---- setting and resetting --------------------------------------------------------------------

static void every_kind_is_set_and_reset(void **state) {
    stage *s = *state;
    pass *p = add_march(s, NULL);
    ok(pass_set_uniform(p, "anisotropy", driven(s)));
    ok(pass_declare(p));
    assert_int_equal(effect_add_param(s->e, &gain), 0);
    add_palette(s, "fire", "fire");
    add_age_curve(s);
    ok(effect_check_settings(s->e));
    static const char *const cases[][2] = {
        {"gain", "1.25"},
        {"fire", "0 #ff0000; 1 4,2,0.5 0.25"},
        {"motion", "cubic 0 2; 1 0; 3 7"},
        {"size", "linear 0 2; 0.25 1; 0.5 7"},
        {"camera.fov", "25"},
        {"camera.target", "1,2,3"},
        {"sun.color", "#ff8000"},
        {"march.steps", "77"},
        {"march.albedo", "0.25,0,1"},
        {"march.anisotropy", "0.5"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const effect_control *c = control_of(s, cases[i][0]);
        ok(effect_set(s->e, c->name, cases[i][1]));
        assert_string_equal(effect_control_setting(c), cases[i][1]);
        says(s, c->name, cases[i][1]);
        ok(effect_reset(s->e, c->name));
        assert_false(c->moved);
        says(s, c->name, c->initial);
        ok(effect_set(s->e, c->name, cases[i][1]));
        ok(effect_set(s->e, c->name, c->initial)); // what the script says is no setting
        assert_false(c->moved);
        says(s, c->name, c->initial);
    }
}

static size_t index_of(stage *s, const char *name) {
    const effect_control *c = control_of(s, name);
    size_t i = 0;
    while (effect_get_control(s->e, i) != c) i++;
    return i;
}

// By numbers as by text: what is kept of the setting is the same.
static void numbers_are_set_without_text(void **state) {
    stage *s = *state;
    ok(pass_declare(add_march(s, NULL)));
    assert_int_equal(effect_add_param(s->e, &gain), 0);
    assert_int_equal(effect_add_param(s->e, &tint), 1);
    add_palette(s, "fire", "fire");
    ok(effect_check_settings(s->e));
    static const struct {
        const char *name;
        float values[4];
        int count;
        const char *text;
    } cases[] = {
        {"gain", {1.25f}, 1, "1.25"},           {"tint", {1, 0.5f, 2}, 3, "1,0.5,2"},
        {"camera.fov", {25}, 1, "25"},          {"camera.target", {1, 2, 3}, 3, "1,2,3"},
        {"march.steps", {77}, 1, "77"},         {"march.albedo", {0.25f, 0, 1}, 3, "0.25,0,1"},
        {"march.anisotropy", {0.5f}, 1, "0.5"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const effect_control *c = control_of(s, cases[i].name);
        ok(effect_set_numbers(s->e, index_of(s, c->name), cases[i].values, cases[i].count));
        assert_true(c->moved);
        assert_string_equal(effect_control_setting(c), cases[i].text);
        says(s, c->name, cases[i].text);
        assert_false(effect_set_numbers(s->e, index_of(s, c->name), cases[i].values, 2));
        assert_error("not 2");
        ok(effect_reset(s->e, c->name));
        assert_null(effect_control_setting(c));
        says(s, c->name, c->initial);
    }
    const float high = 1e6f;
    assert_false(effect_set_numbers(s->e, index_of(s, "gain"), &high, 1));
    assert_error("accepted: 0 to 2");
    assert_false(effect_set_numbers(s->e, index_of(s, "march.mode"), &high, 1));
    assert_error("is structure");
    assert_false(effect_set_numbers(s->e, index_of(s, "fire"), &high, 1));
    assert_error("set by its text");
    assert_false(control_of(s, "gain")->moved);
}

static void what_is_read_over_age_follows_its_curve(void **state) {
    stage *s = *state;
    palette *p = add_age_curve(s);
    float low, high, value[4];
    ok(effect_set(s->e, "size", "linear 0.25 5; 0.5 7; 0.75 1"));
    palette_range(p, &low, &high);
    assert_true(low == 0.25f && high == 0.75f);
    palette_eval(p, 0, 0.5f, value);
    for (int i = 0; i < 3; i++) assert_float_equal(value[i], 7, 0.02);
    static const char *const refused[] = {"linear 0 1; 1 -2", "linear 0 1", "cubic 0 1; 1 2",
                                          "linear 1 1; 0 2"};
    for (size_t i = 0; i < COUNT_OF(refused); i++) {
        assert_false(effect_set(s->e, "size", refused[i]));
        says(s, "size", "linear 0.25 5; 0.5 7; 0.75 1");
        palette_eval(p, 0, 0.5f, value);
        assert_float_equal(value[0], 7, 0.02);
    }
    ok(effect_reset(s->e, "size"));
    palette_eval(p, 0, 0.5f, value);
    assert_float_equal(value[0], 2, 0.02);
}

static void refused_text_changes_nothing(void **state) {
    stage *s = *state;
    ok(pass_declare(add_march(s, NULL)));
    add_palette(s, "fire", "fire");
    add_curve(s, "fade", "fade");
    ok(effect_check_settings(s->e));
    static const char *const cases[][3] = {
        {"fire", "0 #ff0000", "fire: palette: key 1 has 1 stop; 2 to 64"},
        {"fire", "", "fire: palette: key 1 has 0 stops"},
        {"fire", "1 #ff0000; 0 #000", "positions must not fall"},
        {"fade", "cubic 0 1,2", "fade: curve: its values have 1 component"},
        {"fade", "cubic 0 1; 9 2", "outside the period of 4 s"},
        {"camera.fov", "0", "camera.fov is 0; accepted: 1 to 170 degrees"},
        {"camera.fov", "wide", "camera.fov cannot be 'wide'; accepted: a number"},
        {"camera.eye", "1,2", "accepted: three numbers, as 1,0,2.5"},
        {"sun.color", "red", "accepted: #rrggbb or three numbers"},
        {"sun.strength", "-1", "sun.strength is -1; accepted: 0 W/m^2 or more"},
        {"march.steps", "0", "accepted: 1 to 4096"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const effect_control *c = control_of(s, cases[i][0]);
        if (effect_set(s->e, c->name, cases[i][1])) fail_msg("%s was taken", cases[i][1]);
        assert_error(cases[i][2]);
        assert_false(c->moved);
        says(s, c->name, c->initial);
    }
}

static void eye_of_an_orbit_comes_and_goes(void **state) {
    stage *s = *state;
    ok(effect_check_settings(s->e));
    const scene_camera *camera = &effect_scene(s->e)->camera;
    assert_null(camera->eye);
    ok(effect_set(s->e, "camera.eye", "1,2,3"));
    assert_true(camera->eye && camera->eye->value[1] == 2);
    ok(effect_set(s->e, "camera.eye", "4,5,6"));
    assert_true(camera->eye->value[1] == 5);
    ok(effect_reset(s->e, "camera.eye"));
    assert_null(camera->eye);
    ok(effect_set(s->e, "camera.distance", "12"));
    assert_true(camera->distance->value[0] == 12);
}

static void camera_that_stands_has_no_orbit(void **state) {
    stage *s = *state;
    effect_scene(s->e)->camera.eye = field_constant(effect_memory(s->e), 3, (float[4]){1, -8, 2});
    ok(effect_check_settings(s->e));
    assert_string_equal(control_of(s, "camera.eye")->initial, "1,-8,2");
    for (size_t i = 0; i < effect_control_count(s->e); i++)
        assert_string_not_equal(effect_get_control(s->e, i)->name, "camera.yaw");
    assert_false(effect_set(s->e, "camera.yaw", "3"));
    assert_string_equal(err_get(),
                        "camera.yaw: this camera stands at an eye; only an orbit has it");
}

static void dragging_takes_no_memory(void **state) {
    stage *s = *state;
    ok(pass_declare(add_march(s, NULL)));
    add_palette(s, "fire", "fire");
    add_curve(s, "fade", "fade");
    ok(effect_check_settings(s->e));
    static const char *const cases[][3] = {
        {"fire", "0 #ff0000; 1 4,2,0.5", "0 #ff0000; 1 3,2,0.5"},
        {"fade", "linear 0 3; 2 4", "linear 0 1; 1 4"},
        {"camera.eye", "1,2,3", "3,2,1"},
        {"march.steps", "11", "12"},
        {"march.albedo", "1,0,1", "0,1,0.25"},
    };
    const char *before = NULL;
    for (int round = 0; round < 200; round++) {
        for (size_t i = 0; i < COUNT_OF(cases); i++)
            ok(effect_set(s->e, cases[i][0], cases[i][1 + round % 2]));
        if (round < 2) before = arena_alloc(effect_memory(s->e), 16);
    }
    assert_int_equal((char *)arena_alloc(effect_memory(s->e), 16) - before, 16);
    says(s, "march.steps", "12");
}

static void structure_is_marked_and_not_set_later(void **state) {
    stage *s = *state;
    ok(pass_declare(add_march(s, NULL)));
    assert_int_equal(effect_add_param(s->e, &gain), 0);
    assert_false(effect_get_param(s->e, 0)->structural);
    effect_mark_structural(s->e, 0);
    assert_true(effect_get_param(s->e, 0)->structural);
    ok(effect_set(s->e, "gain", "1"));
    assert_false(effect_reset(s->e, "march.mode"));
    assert_error("march.mode is structure");
}

// ---- settings given beforehand ----------------------------------------------------------------

// Declares everything that the settings below name.
static bool declare(stage *s) {
    if (effect_add_param(s->e, &gain) < 0) return false;
    static const palette_stop stops[] = {{0, {0, 0, 0, 1}}, {1, {1, 1, 1, 1}}};
    palette *p = palette_create(
        effect_memory(s->e), &(palette_desc){.keys = &(palette_key){0, stops, 2}, .key_count = 1});
    return effect_add_palette(s->e, p, "fire") && pass_declare(add_march(s, NULL)) &&
           effect_check_settings(s->e);
}

static void settings_reach_every_kind_and_are_told(void **state) {
    stage *s = *state;
    static const effect_setting settings[] = {
        {"gain", "1.5", NULL},         {"fire", "0 #ff0000; 3 #00ff00", NULL},
        {"camera.eye", "1,2,3", NULL}, {"sky.strength", "2", NULL},
        {"march.mode", "paper", NULL}, {"march.resolution", "0.25", NULL},
        {"march.steps", "9", NULL},
    };
    open_with(s, settings, COUNT_OF(settings));
    ok(declare(s));
    for (size_t i = 0; i < COUNT_OF(settings); i++) {
        says(s, settings[i].name, settings[i].text);
        assert_string_equal(effect_control_setting(control_of(s, settings[i].name)),
                            settings[i].text);
    }
    assert_string_equal(control_of(s, "march.mode")->initial, "physical");
    assert_string_equal(control_of(s, "camera.eye")->initial, "orbit 6 0 10");
}

static void wrong_settings_fail(void **state) {
    stage *s = *state;
    static const effect_setting settings[] = {
        {"fire", "red", NULL}, {"camera.fov", "0", NULL}, {"camera.zoom", "2", NULL}};
    static const char *const parts[] = {"fire: palette: stop 1 of 'red' is wrong",
                                        "camera.fov is 0; accepted",
                                        "nothing is named 'camera.zoom'"};
    for (size_t i = 0; i < COUNT_OF(settings); i++) {
        open_with(s, &settings[i], 1);
        assert_false(declare(s));
        assert_error(parts[i]);
    }
}

static void carried_setting_holds_while_the_script_says_the_same(void **state) {
    stage *s = *state;
    static const effect_setting settings[] = {
        {"gain", "1.5", "0.5"},
        {"fire", "0 #ff0000; 3 #00ff00", "0 #000000; 1 #ffffff"},
        {"march.steps", "9", "31"},
        {"march.mode", "paper", "physical"},
        {"sun.strength", "9", "1"},
        {"camera.fov", "20", "40"},
        {"gone", "1", "2"},
        {"march.gone", "1", "2"},
        {"camera.far", "none", "1000"},
    };
    open_with(s, settings, COUNT_OF(settings));
    ok(declare(s));
    says(s, "gain", "1.5");
    says(s, "fire", "0 #ff0000; 3 #00ff00");
    says(s, "march.steps", control_of(s, "march.steps")->initial);
    says(s, "march.mode", "paper");
    says(s, "sun.strength", "2.5");
    says(s, "camera.fov", "20");
    says(s, "camera.far", "1000");
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        STAGE_TEST(list_has_its_order_however_things_are_declared),
        STAGE_TEST(initial_is_what_the_script_says),
        STAGE_TEST(names_are_made_unique),
        STAGE_TEST(names_not_known_get_a_suggestion),
        STAGE_TEST(every_kind_is_set_and_reset),
        STAGE_TEST(numbers_are_set_without_text),
        STAGE_TEST(what_is_read_over_age_follows_its_curve),
        STAGE_TEST(refused_text_changes_nothing),
        STAGE_TEST(eye_of_an_orbit_comes_and_goes),
        STAGE_TEST(camera_that_stands_has_no_orbit),
        STAGE_TEST(dragging_takes_no_memory),
        STAGE_TEST(structure_is_marked_and_not_set_later),
        STAGE_TEST(settings_reach_every_kind_and_are_told),
        STAGE_TEST(wrong_settings_fail),
        STAGE_TEST(carried_setting_holds_while_the_script_says_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
