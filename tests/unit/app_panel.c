// The panel's model: which rows in which sections, what a search finds, values as text.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "app/panel_model.h"
#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static roil_control control(const char *name, const char *label, const char *group) {
    return (roil_control){.name = name,
                          .label = label,
                          .group = group,
                          .type = ROIL_FLOAT,
                          .components = 1,
                          .min = -INFINITY,
                          .max = INFINITY,
                          .unit = "",
                          .help = ""};
}

static roil_control parameter(const char *name, const char *group) {
    roil_control c = control(name, name, group);
    c.parameter = true;
    return c;
}

// "Title: name name; Title: ..." of all that the model holds.
static char *describe(const panel_model *m, const roil_control *controls) {
    strbuf text = {0};
    for (size_t i = 0; i < m->section_count; i++) {
        const panel_section *s = &m->sections[i];
        strbuf_add(&text, "%s%s:", i ? "; " : "", s->title);
        for (size_t k = 0; k < s->count; k++)
            strbuf_add(&text, " %s", controls[m->rows[s->first + k]].name);
    }
    char *copy = mem_copy(strbuf_text(&text), text.length + 1);
    strbuf_free(&text);
    return copy;
}

static void expect(const roil_control *controls, size_t count, const char *search,
                   const char *want) {
    panel_model m = {0};
    panel_model_fill(&m, controls, count, search);
    char *got = count ? describe(&m, controls) : NULL;
    assert_string_equal(got, want);
    mem_free(got);
    panel_model_free(&m);
}

static void ungrouped_parameters_stand_first(void **state) {
    (void)state;
    roil_control c[] = {parameter("wind", "Air"), parameter("density", ""),
                        parameter("soot", "Smoke"), parameter("gusts", "Air"),
                        parameter("steps", "")};
    expect(c, COUNT_OF(c), "", "Parameters: density steps; Air: wind gusts; Smoke: soot");
}

static void sections_follow_the_documented_order(void **state) {
    (void)state;
    roil_control c[] = {
        parameter("density", ""),
        control("fire", "fire", ""),
        control("fade", "fade", ""),
        control("camera.fov", "fov", "camera"),
        control("sun.azimuth", "azimuth", "sun"),
        control("sun.color", "color", "sun"),
        control("sky.strength", "strength", "sky"),
        control("march.steps", "steps", "march"),
        control("final.saturation", "saturation", "final"),
    };
    c[1].type = ROIL_PALETTE;
    c[2].type = ROIL_CURVE;
    expect(c, COUNT_OF(c), "",
           "Parameters: density; fire: fire; fade: fade; Camera: camera.fov; Sun: sun.azimuth "
           "sun.color; Sky: sky.strength; march: march.steps; final: final.saturation");
}

static void options_of_a_pass_precede_its_uniforms(void **state) {
    (void)state;
    roil_control c[] = {control("march.steps", "steps", "march"),
                        control("march.mode", "mode", "march"),
                        control("march.jitter", "jitter", "march"),
                        control("march.resolution", "resolution", "march")};
    c[1].structural = c[3].structural = true;
    expect(c, COUNT_OF(c), "", "march: march.mode march.resolution march.steps march.jitter");
}

static void structural_parameters_keep_their_place(void **state) {
    (void)state;
    roil_control c[] = {parameter("density", ""), parameter("noise", "")};
    c[1].structural = true;
    expect(c, COUNT_OF(c), "", "Parameters: density noise");
}

static void a_group_named_as_a_pass_is_not_mixed_with_it(void **state) {
    (void)state;
    roil_control c[] = {parameter("a", "march"), control("march.steps", "steps", "march")};
    expect(c, COUNT_OF(c), "", "march: a; march: march.steps");
}

static void a_search_takes_words_in_any_order_and_case(void **state) {
    (void)state;
    roil_control c = control("march.shadow_steps", "shadow_steps", "march");
    c.help = "steps towards the Sun from each lit point";
    assert_true(panel_matches(&c, ""));
    assert_true(panel_matches(&c, "  "));
    assert_true(panel_matches(&c, "SHADOW"));
    assert_true(panel_matches(&c, "sun march"));
    assert_true(panel_matches(&c, " lit\tSHADOW_ "));
    assert_false(panel_matches(&c, "shadow moon"));
    c.group = "Lighting";
    assert_true(panel_matches(&c, "lighting"));
}

static void sections_without_a_match_are_left_out(void **state) {
    (void)state;
    roil_control c[] = {parameter("density", ""), parameter("detail", "Noise"),
                        control("march.steps", "steps", "march")};
    expect(c, COUNT_OF(c), "noise", "Noise: detail");
    expect(c, COUNT_OF(c), "de", "Parameters: density; Noise: detail");
    expect(c, COUNT_OF(c), "march", "march: march.steps");
    panel_model m = {0};
    panel_model_fill(&m, c, COUNT_OF(c), "zebra");
    assert_int_equal(m.section_count, 0);
    assert_int_equal(m.row_count, 0);
    panel_model_fill(&m, c, COUNT_OF(c), "");
    assert_int_equal(m.row_count, 3);
    panel_model_fill(&m, NULL, 0, "");
    assert_int_equal(m.section_count, 0);
    panel_model_free(&m);
}

static void sections_count_what_was_moved(void **state) {
    (void)state;
    roil_control c[] = {parameter("density", ""), parameter("steps", ""), parameter("wind", "Air")};
    c[0].moved = c[1].moved = true;
    panel_model m = {0};
    panel_model_fill(&m, c, COUNT_OF(c), "");
    assert_int_equal(m.sections[0].moved, 2);
    assert_int_equal(m.sections[1].moved, 0);
    panel_model_free(&m);
}

// ---- text -------------------------------------------------------------------------------------

static void numbers_read_back_the_same(void **state) {
    (void)state;
    static const struct {
        float value;
        const char *text;
    } cases[] = {
        {20, "20"},           {0.1f, "0.1"},    {-2.5f, "-2.5"},          {0, "0"},
        {1234567, "1234567"}, {1e-7f, "1e-07"}, {1.0f / 3, "0.33333334"}, {16777216, "16777216"}};
    char out[PANEL_NUMBER];
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        panel_number(cases[i].value, out);
        assert_string_equal(out, cases[i].text);
    }
    for (uint32_t bits = 1; bits < 0x7f800000; bits += 7654321) {
        float value;
        memcpy(&value, &bits, sizeof value);
        panel_number(value, out);
        assert_true(strtof(out, NULL) == value);
    }
}

typedef void writer(const roil_control *c, const float value[4], strbuf *out);

static void expect_text(writer *write, const roil_control *c, const float value[4],
                        const char *want) {
    strbuf text = {0};
    write(c, value, &text);
    assert_string_equal(strbuf_text(&text), want);
    strbuf_free(&text);
}

static void values_are_written_as_roil_set_takes_them(void **state) {
    (void)state;
    static const char *const words[] = {"soft", "paper"};
    roil_control c = control("c", "c", "");
    const float value[4] = {1, 0.5f, 2, 0.25f};
    expect_text(panel_value_text, &c, value, "1");
    c.type = ROIL_INT;
    expect_text(panel_value_text, &c, value, "1");
    c.type = ROIL_BOOL;
    expect_text(panel_value_text, &c, value, "true");
    expect_text(panel_value_text, &c, (float[4]){0}, "false");
    c.type = ROIL_ENUM;
    c.words = words;
    c.word_count = 2;
    expect_text(panel_value_text, &c, value, "paper");
    expect_text(panel_value_text, &c, (float[4]){7}, "");
    c.type = ROIL_COLOR;
    c.components = 3;
    expect_text(panel_value_text, &c, value, "1,0.5,2");
    c.type = ROIL_VECTOR;
    c.components = 4;
    expect_text(panel_value_text, &c, value, "1,0.5,2,0.25");
    c.type = ROIL_PALETTE;
    expect_text(panel_value_text, &c, value, "");
}

static void values_are_shown_short_and_with_their_unit(void **state) {
    (void)state;
    roil_control c = control("c", "c", "");
    c.unit = "1/m";
    expect_text(panel_value_shown, &c, (float[4]){1.0f / 3}, "0.3333 1/m");
    c.type = ROIL_BOOL;
    expect_text(panel_value_shown, &c, (float[4]){1}, "on");
}

static void expect_help(const roil_control *c, const char *want) {
    strbuf text = {0};
    panel_help_text(c, &text);
    assert_string_equal(strbuf_text(&text), want);
    strbuf_free(&text);
}

static void help_gives_name_range_default_and_unit(void **state) {
    (void)state;
    roil_control c = control("density", "density", "");
    c.initial[0] = 20;
    expect_help(&c, "density, default 20");
    c.help = "how thick it is";
    c.unit = "1/m";
    c.min = 0;
    expect_help(&c, "how thick it is\ndensity, at least 0 1/m, default 20 1/m");
    c.max = 200;
    expect_help(&c, "how thick it is\ndensity, 0 to 200 1/m, default 20 1/m");
    c.structural = true;
    expect_help(&c, "how thick it is\ndensity, 0 to 200 1/m, default 20 1/m\n"
                    "read while the effect loads: a change rebuilds it");
    c.driven = true;
    expect_help(&c, "how thick it is\ndensity, 0 to 200 1/m\n"
                    "moved by the effect file; right click to override");
    c = control("fire", "fire", "");
    c.type = ROIL_PALETTE;
    expect_help(&c, "fire");
}

static float ten_each(const char *text) {
    return 10 * (float)strlen(text);
}

static void long_labels_end_in_dots(void **state) {
    (void)state;
    char out[32];
    assert_true(panel_shorten("density", 70, ten_each, out, sizeof out));
    assert_string_equal(out, "density");
    assert_false(panel_shorten("shadow distance", 100, ten_each, out, sizeof out));
    assert_string_equal(out, "shadow ...");
    assert_false(panel_shorten("shadow distance", 5, ten_each, out, sizeof out));
    assert_string_equal(out, "...");
    assert_false(panel_shorten("aaaa\u00b2bbb", 80, ten_each, out, sizeof out));
    assert_string_equal(out, "aaaa..."); // not half of a letter
    char small[8];
    assert_false(panel_shorten("shadow distance", 1000, ten_each, small, sizeof small));
    assert_string_equal(small, "shad...");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ungrouped_parameters_stand_first),
        cmocka_unit_test(sections_follow_the_documented_order),
        cmocka_unit_test(options_of_a_pass_precede_its_uniforms),
        cmocka_unit_test(structural_parameters_keep_their_place),
        cmocka_unit_test(a_group_named_as_a_pass_is_not_mixed_with_it),
        cmocka_unit_test(a_search_takes_words_in_any_order_and_case),
        cmocka_unit_test(sections_without_a_match_are_left_out),
        cmocka_unit_test(sections_count_what_was_moved),
        cmocka_unit_test(numbers_read_back_the_same),
        cmocka_unit_test(values_are_written_as_roil_set_takes_them),
        cmocka_unit_test(values_are_shown_short_and_with_their_unit),
        cmocka_unit_test(help_gives_name_range_default_and_unit),
        cmocka_unit_test(long_labels_end_in_dots),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
