// Values as text: what each kind takes, what it refuses and how it says so, what is printed.
#include "base_test.h"

#include "base/memory.h"
#include "base/value.h"
#include <math.h>

static const char *const words[] = {"soft", "hard"};

static const value_desc metres = {
    .name = "reach", .components = 1, .value = {0.5f}, .max = 4, .unit = "m"};
static const value_desc count = {"count",  VALUE_WHOLE, .components = 1, .value = {8},
                                 .min = 1, .max = 64,   .unit = ""};
static const value_desc wind = {.name = "wind", .components = 3, .unit = "m/s"};
static const value_desc pair = {
    .name = "pair", .components = 2, .min = -INFINITY, .max = 1, .unit = ""};
static const value_desc tint = {"tint",          VALUE_COLOR, .components = 3, .value = {1, 1, 1},
                                .max = INFINITY, .unit = ""};
static const value_desc lit = {"lit", VALUE_BOOL, .components = 1, .value = {1}, .max = 1};
static const value_desc look = {"look",       VALUE_WORD,     .components = 1,
                                .value = {1}, .words = words, .word_count = 2};

static void text_is_taken_and_printed(void **state) {
    (void)state;
    static const struct {
        const value_desc *desc;
        const char *text;
        float want[3];
        const char *printed;
    } cases[] = {
        {&metres, "0.25", {0.25f}, "0.25"},
        {&metres, "4", {4}, "4"},
        {&count, "16", {16}, "16"},
        {&wind, "1,-2,3.5", {1, -2, 3.5f}, "1,-2,3.5"},
        {&wind, "1 2 3", {1, 2, 3}, "1,2,3"},
        {&wind, "7", {7, 7, 7}, "7,7,7"},
        {&wind, "#fff", {1, 1, 1}, "1,1,1"},
        {&pair, "1,-1e9", {1, -1e9f}, "1,-1e+09"},
        {&tint, "#ff0000", {1, 0, 0}, "#ff0000"},
        {&tint, "4,2,0.5", {4, 2, 0.5f}, "4,2,0.5"},
        {&lit, "off", {0}, "false"},
        {&lit, "yes", {1}, "true"},
        {&look, "hard", {1}, "hard"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        float value[4];
        strbuf text = {0};
        if (!value_parse(cases[i].desc, "x", cases[i].text, value)) fail_msg("%s", err_get());
        for (int c = 0; c < cases[i].desc->components; c++)
            assert_true(value[c] == cases[i].want[c]);
        value_print(cases[i].desc, value, &text);
        assert_string_equal(strbuf_text(&text), cases[i].printed);
        strbuf_free(&text);
    }
}

static void what_is_refused_says_what_is_accepted(void **state) {
    (void)state;
    static const struct {
        const value_desc *desc;
        const char *text, *message;
    } cases[] = {
        {&metres, "far", "x cannot be 'far'; accepted: a number"},
        {&metres, "nan", "x cannot be 'nan'; accepted: a number"},
        {&metres, "1,2", "x cannot be '1,2'; accepted: a number"},
        {&metres, "#fff", "x cannot be '#fff'; accepted: a number"},
        {&metres, "4.5", "x is 4.5; accepted: 0 to 4 m"},
        {&count, "1.5", "x cannot be '1.5'; accepted: a whole number"},
        {&count, "0", "x is 0; accepted: 1 to 64"},
        {&wind, "1,2", "x cannot be '1,2'; accepted: three numbers, as 1,0,2.5"},
        {&pair, "2,0", "x is 2; accepted: 1 or less"},
        {&pair, "1,0,0", "x cannot be '1,0,0'; accepted: two numbers, as 1,0"},
        {&tint, "red", "x cannot be 'red'; accepted: #rrggbb or three numbers, as 1,0.5,0.1"},
        {&tint, "1,1,-2", "x is -2; accepted: 0 or more"},
        {&tint, "#12", "x: '#12' is not a colour; accepted: \"#rgb\", \"#rrggbb\", \"#rrggbbaa\""},
        {&lit, "maybe", "x cannot be 'maybe'; accepted: true, false"},
        {&look, "1", "x cannot be '1'; accepted: soft, hard"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        float value[4];
        if (value_parse(cases[i].desc, "x", cases[i].text, value))
            fail_msg("'%s' was taken", cases[i].text);
        assert_string_equal(err_get(), cases[i].message);
    }
}

static void no_range_takes_any_finite_number(void **state) {
    (void)state;
    assert_int_equal(value_find_wrong(&wind, (float[]){-1e30f, 0, 1e30f}, 3), -1);
    assert_int_equal(value_find_wrong(&wind, (float[]){0, INFINITY, 0}, 3), 1);
    assert_int_equal(value_find_wrong(&tint, (float[]){0, 0, -0.5f}, 3), 2);
    value_refuse(&wind, NAN, "march: '%s'", "wind");
    assert_string_equal(err_get(), "march: 'wind' is nan; accepted: any finite number m/s");
}

static void references_show_defaults_ranges_and_units(void **state) {
    (void)state;
    static const value_desc file = {"file", VALUE_OTHER, .form = "\"a.vdb\""};
    static const value_desc eye = {"eye", VALUE_NUMBER, .components = 3, .unit = "m",
                                   .form = "{x, y, z} m"};
    static const value_desc given = {"at", VALUE_NUMBER, .unit = "", .required = true};
    static const struct {
        const value_desc *desc;
        float now[3];
        bool has;
        const char *text;
    } cases[] = {
        {&metres, {0}, false, "reach = 0.5 [0, 4] m"},
        {&metres, {2}, true, "reach = 2 [0, 4] m"},
        {&wind, {0}, false, "wind = 0, 0, 0 m/s"},
        {&tint, {0}, false, "tint = 1, 1, 1 [0, inf]"},
        {&lit, {0}, false, "lit = true"},
        {&look, {0}, false, "look = soft | hard*"},
        {&look, {0}, true, "look = soft* | hard"},
        {&file, {0}, false, "file = \"a.vdb\""},
        {&eye, {0}, false, "eye = {x, y, z} m"},
        {&eye, {1, 2, 3}, true, "eye = 1, 2, 3 m"},
        {&given, {0}, false, "at"},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        strbuf text = {0};
        value_show(cases[i].desc, NULL, cases[i].has ? cases[i].now : NULL, &text);
        assert_string_equal(strbuf_text(&text), cases[i].text);
        strbuf_free(&text);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_taken_and_printed),
        cmocka_unit_test(what_is_refused_says_what_is_accepted),
        cmocka_unit_test(no_range_takes_any_finite_number),
        cmocka_unit_test(references_show_defaults_ranges_and_units),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
