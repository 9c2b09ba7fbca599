// Parameters, and setting them, uniforms, options and resolutions from text.
#include "effect_helper.h"

static const char *const words[] = {"low", "middle", "high"};

static const effect_param examples[] = {
    {.desc = {"gain", VALUE_NUMBER, 1, .value = {0.5f}, .min = 0, .max = 2, .unit = "1/m",
              .help = ""}},
    {.desc = {"count", VALUE_WHOLE, 1, .value = {8}, .min = 1, .max = 64, .unit = "", .help = ""}},
    {.desc = {"lit", VALUE_BOOL, 1, .value = {0}, .min = 0, .max = 1, .unit = "", .help = ""}},
    {.desc = {"quality", VALUE_WORD, 1, .value = {1}, .min = 0, .max = 2, .unit = "", .help = "",
              .words = words, .word_count = 3}},
    {.desc = {"wind", VALUE_NUMBER, 3, .value = {1, 0, 0}, .min = -10, .max = 10, .unit = "m/s",
              .help = ""}},
    {.desc = {"tint", VALUE_COLOR, 3, .value = {1, 1, 1}, .min = 0, .max = 100, .unit = "",
              .help = ""}},
};

static void add_examples(stage *s) {
    for (size_t i = 0; i < COUNT_OF(examples); i++)
        assert_int_equal(effect_add_param(s->e, &examples[i]), (int)i);
}

static const float *value_of(stage *s, const char *name) {
    for (size_t i = 0; i < effect_param_count(s->e); i++)
        if (strcmp(effect_get_param(s->e, i)->desc.name, name) == 0)
            return effect_get_param(s->e, i)->value;
    fail_msg("no parameter %s", name);
    return NULL;
}

// ---- parameters -------------------------------------------------------------------------------

static void parameter_begins_with_its_default(void **state) {
    stage *s = *state;
    add_examples(s);
    assert_int_equal(effect_param_count(s->e), COUNT_OF(examples));
    for (size_t i = 0; i < COUNT_OF(examples); i++)
        assert_memory_equal(effect_get_param(s->e, i)->value, examples[i].desc.value,
                            sizeof examples[i].desc.value);
}

static void parameter_is_set_from_text_of_its_type(void **state) {
    stage *s = *state;
    add_examples(s);
    static const struct {
        const char *name, *text;
        float want[3];
    } cases[] = {
        {"gain", "1.25", {1.25f}},
        {"gain", "2e-1", {0.2f}},
        {"count", "16", {16}},
        {"lit", "true", {1}},
        {"lit", "off", {0}},
        {"lit", "yes", {1}},
        {"lit", "0", {0}},
        {"quality", "high", {2}},
        {"quality", "low", {0}},
        {"wind", "1,-2,3", {1, -2, 3}},
        {"wind", "4 5 6", {4, 5, 6}},
        {"tint", "1,0.5,20", {1, 0.5f, 20}},
        {"tint", "#ff0000", {1, 0, 0}},
        {"tint", "#fff", {1, 1, 1}},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        ok(effect_set(s->e, cases[i].name, cases[i].text));
        const float *got = value_of(s, cases[i].name);
        for (int c = 0; c < 3; c++)
            if (fabsf(got[c] - cases[i].want[c]) > 1e-5f)
                fail_msg("%s = %s: component %d is %g", cases[i].name, cases[i].text, c,
                         (double)got[c]);
    }
}

static void text_of_another_type_is_refused_and_changes_nothing(void **state) {
    stage *s = *state;
    add_examples(s);
    static const struct {
        const char *name, *text, *part;
    } cases[] = {
        {"gain", "much", "gain cannot be 'much'; accepted: a number"},
        {"gain", "", "accepted: a number"},
        {"gain", "1,2", "accepted: a number"},
        {"gain", "nan", "accepted: a number"},
        {"gain", "inf", "accepted: a number"},
        {"gain", "1e99", "accepted: a number"},
        {"gain", "0.5m", "accepted: a number"},
        {"gain", "3", "gain is 3; accepted: 0 to 2 1/m"},
        {"gain", "-0.1", "accepted: 0 to 2 1/m"},
        {"count", "1.5", "accepted: a whole number"},
        {"count", "65", "accepted: 1 to 64"},
        {"lit", "maybe", "accepted: true, false"},
        {"lit", "2", "accepted: true, false"},
        {"quality", "medium", "accepted: low, middle, high"},
        {"quality", "1", "accepted: low, middle, high"},
        {"wind", "1,2", "accepted: three numbers"},
        {"wind", "1,2,3,4,5", "accepted: three numbers"},
        {"wind", "1,2,30", "wind is 30; accepted: -10 to 10 m/s"},
        {"tint", "red", "accepted: #rrggbb or three numbers"},
        {"tint", "#ff00", "tint: "},
        {"tint", "#gg0000", "tint: "},
        {"tint", "-1,0,0", "accepted: 0 to 100"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        err_clear();
        if (effect_set(s->e, cases[i].name, cases[i].text))
            fail_msg("%s took '%s'", cases[i].name, cases[i].text);
        assert_error(cases[i].part);
    }
    for (size_t i = 0; i < COUNT_OF(examples); i++)
        assert_memory_equal(effect_get_param(s->e, i)->value, examples[i].desc.value,
                            sizeof examples[i].desc.value);
}

static void bad_declaration_is_refused(void **state) {
    stage *s = *state;
    add_examples(s);
    const effect_param good = {
        .desc = {"x", VALUE_NUMBER, 1, .value = {1}, .min = 0, .max = 2, .unit = "", .help = ""}};
    effect_param bad = good;
    bad.desc.name = "two words";
    assert_int_equal(effect_add_param(s->e, &bad), -1);
    assert_error("parameter name 'two words' is not a name");
    bad = good;
    bad.desc.name = "gain";
    assert_int_equal(effect_add_param(s->e, &bad), -1);
    assert_error("parameter 'gain' is declared twice");
    bad = good;
    bad.desc.min = 3;
    assert_int_equal(effect_add_param(s->e, &bad), -1);
    assert_error("parameter 'x': min 3 is above max 2");
    bad = good;
    bad.desc.value[0] = 5;
    assert_int_equal(effect_add_param(s->e, &bad), -1);
    assert_error("parameter 'x' is 5; accepted: 0 to 2");
    bad = good;
    bad.desc.min = NAN;
    assert_int_equal(effect_add_param(s->e, &bad), -1);
    bad = good;
    bad.desc.value[0] = NAN;
    assert_int_equal(effect_add_param(s->e, &bad), -1);
    assert_int_equal(effect_param_count(s->e), COUNT_OF(examples));
}

static void field_of_a_parameter_has_its_current_value(void **state) {
    stage *s = *state;
    add_examples(s);
    const field *wind = field_param(effect_memory(s->e), 3, 4);
    float out[4];
    for (int i = 0; i < 40; i++) { // values may move when parameters are added
        char name[32];
        snprintf(name, sizeof name, "more_%d", i);
        effect_param more = examples[0];
        more.desc.name = arena_string(effect_memory(s->e), name);
        assert_true(effect_add_param(s->e, &more) > 0);
    }
    ok(effect_set(s->e, "wind", "7,8,9"));
    ok(field_eval(wind, effect_pass_host(s->e)->context, (float3){0, 0, 0}, out));
    assert_true(out[0] == 7 && out[1] == 8 && out[2] == 9);
}

// ---- names ------------------------------------------------------------------------------------

static void unknown_name_gets_the_nearest(void **state) {
    stage *s = *state;
    add_examples(s);
    add_march(s, NULL);
    assert_false(effect_set(s->e, "gian", "1"));
    assert_string_equal(err_get(), "nothing is named 'gian'; did you mean 'gain'?");
    assert_false(effect_set(s->e, "march.stpes", "1"));
    assert_error("march: unknown uniform 'stpes'; did you mean 'steps'?");
    assert_false(effect_set(s->e, "mrach.steps", "1"));
    assert_error("did you mean 'march.steps'?");
    assert_false(effect_set(s->e, "zzzzzzzzzzzzz", "1"));
    assert_error("nothing is named 'zzzzzzzzzzzzz'");
    assert_false(effect_set(s->e, "", "1"));
    assert_false(effect_set(s->e, ".", "1"));
    assert_false(effect_set(s->e, "march.", "1"));
}

static void uniform_of_a_pass_is_set_by_its_label(void **state) {
    stage *s = *state;
    pass *first = add_march(s, NULL), *second = add_march(s, NULL), *third = add_march(s, "smoke");
    assert_string_equal(pass_label(first), "march");
    assert_string_equal(pass_label(second), "march_2");
    ok(effect_set(s->e, "march.steps", "11"));
    ok(effect_set(s->e, "march_2.steps", "22"));
    ok(effect_set(s->e, "smoke.steps", "33"));
    assert_true(uniform_of(first, "steps", 0) == 11);
    assert_true(uniform_of(second, "steps", 0) == 22);
    assert_true(uniform_of(third, "steps", 0) == 33);
    ok(effect_set(s->e, "smoke.albedo", "0.1,0.2,0.3"));
    assert_true(uniform_of(third, "albedo", 2) == 0.3f);
    ok(effect_set(s->e, "smoke.albedo", "#00ff00"));
    assert_true(uniform_of(third, "albedo", 0) == 0 && uniform_of(third, "albedo", 1) == 1);
}

static void uniform_out_of_range_or_of_another_type_is_refused(void **state) {
    stage *s = *state;
    add_march(s, NULL);
    static const struct {
        const char *name, *text, *part;
    } cases[] = {
        {"march.steps", "0", "march.steps is 0; accepted: 1 to 4096"},
        {"march.steps", "many", "march.steps cannot be 'many'; accepted: a whole number"},
        {"march.anisotropy", "-1", "accepted: -0.95 to 0.95"},
        {"march.density", "1", "march.density is a field; only the effect file can set it"},
        {"march.depth", "1", "march.depth is an image; only the effect file can set it"},
        {"march.albedo", "0.1,0.2,3", "march.albedo is 3; accepted: 0 to 1"},
        {"march.mode", "paper", "march.mode is structure"},
        {"march.resolution", "0.5", "march.resolution is structure"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        err_clear();
        if (effect_set(s->e, cases[i].name, cases[i].text))
            fail_msg("%s took '%s'", cases[i].name, cases[i].text);
        assert_error(cases[i].part);
    }
}

static void words_and_toggles_of_a_users_shader_are_set_by_word(void **state) {
    stage *s = *state;
    write_file(s, "shades.comp",
               "uniform int kind;    //= soft {hard, soft, none} : an enumeration\n"
               "uniform bool invert; //= false : a toggle\n"
               "writeonly uniform image2D color; //= output rgba16f : a picture\n"
               "void main() { imageStore(color, ivec2(gl_GlobalInvocationID.xy), "
               "vec4(float(kind), invert ? 1.0 : 0.0, 0.0, 1.0)); }\n");
    pass *p = effect_add_pass(s->e, NULL, "shades.comp", NULL);
    ok(p);
    assert_string_equal(pass_label(p), "shades");
    ok(effect_set(s->e, "shades.kind", "none"));
    ok(effect_set(s->e, "shades.invert", "on"));
    assert_true(uniform_of(p, "kind", 0) == 2 && uniform_of(p, "invert", 0) == 1);
    assert_false(effect_set(s->e, "shades.kind", "sofd"));
    assert_error("shades.kind cannot be 'sofd'; accepted: hard, soft, none");
    assert_false(effect_set(s->e, "shades.invert", "perhaps"));
    assert_error("shades.invert cannot be 'perhaps'; accepted: true, false");
}

// ---- settings given beforehand ------------------------------------------------------------------

static void settings_apply_when_what_they_name_is_declared(void **state) {
    stage *s = *state;
    static const effect_setting settings[] = {
        {"gain", "1.5", NULL},
        {"quality", "low", NULL},
        {"march.steps", "77", NULL},
        {"march.mode", "paper", NULL},
        {"march.resolution", "0.25", NULL},
        {"march.albedo", "0.5,0,1", NULL},
    };
    open_with(s, settings, COUNT_OF(settings));
    assert_false(effect_check_settings(s->e)); // nothing is declared yet
    add_examples(s);
    assert_true(value_of(s, "gain")[0] == 1.5f && value_of(s, "quality")[0] == 0);
    assert_true(effect_get_param(s->e, 0)->desc.value[0] == 0.5f);
    pass *p = add_march(s, NULL);
    ok(pass_set_uniform(p, "steps", number(s, 5))); // the effect's own, which a setting replaces
    ok(pass_declare(p));
    size_t mode;
    assert_int_equal(pass_find_key(p, "mode", &mode), PASS_OPTION);
    assert_string_equal(pass_interface(p)->options[mode].words[pass_get_option(p, mode)], "paper");
    assert_true(pass_get_scale(p) == 0.25f);
    assert_true(uniform_of(p, "steps", 0) == 77 && uniform_of(p, "albedo", 2) == 1);
    ok(effect_check_settings(s->e));
}

// A source that is added later, as `shade` to a `reference`, does not take its place.
static void setting_that_is_the_default_is_not_inherited_over(void **state) {
    stage *s = *state;
    for (int given = 0; given < 2; given++) {
        const effect_setting settings[] = {{"second.steps", "128", NULL}};
        open_with(s, settings, given ? 1 : 0);
        pass *first = add_march(s, "first");
        ok(pass_set_uniform(first, "steps", number(s, 16)) && pass_declare(first));
        pass *second = add_march(s, "second");
        ok(pass_declare(second));
        const effect_control *steps = effect_find_control(s->e, "second.steps");
        assert_string_equal(steps->initial, "128");
        assert_true(given ? steps->moved && strcmp(effect_control_setting(steps), "128") == 0
                          : !steps->moved);
        pass_add_uniforms_of(second, first);
        const value_desc *declared;
        const field *own = pass_get_uniform(second, steps->index);
        const field *inherited = pass_inherited_uniform(second, steps->index, &declared);
        assert_true(inherited && inherited->value[0] == 16);
        assert_true(given ? own && own->value[0] == 128 : !own);
    }
}

static void bad_setting_fails_what_it_names(void **state) {
    stage *s = *state;
    static const struct {
        effect_setting setting;
        const char *part;
    } cases[] = {
        {{"march.steps", "0", NULL}, "march.steps is 0; accepted: 1 to 4096"},
        {{"march.mode", "papre", NULL}, "march.mode cannot be 'papre'; accepted: physical, paper"},
        {{"march.resolution", "2", NULL}, "march.resolution is 2; accepted: 0.001 to 1"},
        {{"march.resolution", "half", NULL},
         "march.resolution cannot be 'half'; accepted: a number"},
        {{"march.density", "3", NULL}, "march.density is a field"},
        {{"march.sampling_", "linear", NULL}, "did you mean 'sampling'?"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        open_with(s, &cases[i].setting, 1);
        pass *p = add_march(s, NULL);
        if (pass_declare(p)) fail_msg("%s", cases[i].setting.name);
        assert_error(cases[i].part);
    }
    const effect_setting gain = {"gain", "200", NULL};
    open_with(s, &gain, 1);
    assert_int_equal(effect_add_param(s->e, &examples[0]), -1);
    assert_error("gain is 200; accepted: 0 to 2 1/m");
}

static void setting_that_names_nothing_is_reported_with_the_nearest(void **state) {
    stage *s = *state;
    static const effect_setting settings[] = {{"gain", "1", NULL}, {"cuont", "3", NULL}};
    open_with(s, settings, COUNT_OF(settings));
    add_examples(s);
    assert_false(effect_check_settings(s->e));
    assert_string_equal(err_get(), "nothing is named 'cuont'; did you mean 'count'?");
}

static void settings_are_copied(void **state) {
    stage *s = *state;
    char name[] = "gain", text[] = "1.75";
    effect_setting setting = {name, text, NULL};
    open_with(s, &setting, 1);
    memset(name, 'x', strlen(name));
    memset(text, 'x', strlen(text));
    setting = (effect_setting){0};
    add_examples(s);
    assert_true(value_of(s, "gain")[0] == 1.75f);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        STAGE_TEST(parameter_begins_with_its_default),
        STAGE_TEST(parameter_is_set_from_text_of_its_type),
        STAGE_TEST(text_of_another_type_is_refused_and_changes_nothing),
        STAGE_TEST(bad_declaration_is_refused),
        STAGE_TEST(field_of_a_parameter_has_its_current_value),
        STAGE_TEST(unknown_name_gets_the_nearest),
        STAGE_TEST(uniform_of_a_pass_is_set_by_its_label),
        STAGE_TEST(uniform_out_of_range_or_of_another_type_is_refused),
        STAGE_TEST(words_and_toggles_of_a_users_shader_are_set_by_word),
        STAGE_TEST(settings_apply_when_what_they_name_is_declared),
        STAGE_TEST(setting_that_is_the_default_is_not_inherited_over),
        STAGE_TEST(bad_setting_fails_what_it_names),
        STAGE_TEST(setting_that_names_nothing_is_reported_with_the_nearest),
        STAGE_TEST(settings_are_copied),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
