// `from`: what a pass takes from others, and what it keeps its own.
#include "script_helper.h"

#define HEAD                                                                                       \
    "local fx = effect { name = 'from' }\n"                                                        \
    "local ball = sphere { radius = 1 }\n"
#define TAIL "fx.output = b.color\nreturn fx\n"

static char said[256];

// The text of a control, as `roil info params` has it.
static const char *value_of(effect *e, const char *name) {
    const effect_control *c = effect_find_control(e, name);
    if (!c) fail_msg("%s", err_get());
    strbuf text = {0};
    effect_print_control(e, c, &text);
    snprintf(said, sizeof said, "%s", strbuf_text(&text));
    strbuf_free(&text);
    return said;
}

static effect *load(const char *text, const effect_setting *settings, size_t count) {
    effect *e = helper_load_with(text, NULL, settings, count);
    if (!e) fail_msg("%s", err_get());
    if (!effect_check(e)) fail_msg("%s", err_get());
    return e;
}

static void refused(const char *text, const char *message) {
    assert_null(helper_load(text));
    if (!strstr(err_get(), message)) fail_msg("\"%s\" is not in: %s", message, err_get());
}

static const char marches[] =
    HEAD "local a = march { name = 'a', density = ball, steps = 33, jitter = 0.5,\n"
         "                  sampling = 'cubic' }\n"
         "local b = march { name = 'b', from = a, jitter = 0.25 }\n" TAIL;

static void what_is_not_given_is_taken(void **state) {
    (void)state;
    effect *e = load(marches, NULL, 0);
    assert_string_equal(value_of(e, "b.steps"), "33");
    assert_string_equal(value_of(e, "b.sampling"), "cubic");
    assert_string_equal(value_of(e, "b.early_exit"), value_of(e, "a.early_exit"));
    size_t index;
    pass *a = effect_get_pass(e, 0), *b = effect_get_pass(e, 1);
    assert_int_equal(pass_find_key(b, "density", &index), PASS_FIELD);
    assert_ptr_equal(pass_get_field(b, index), pass_get_field(a, index));
    effect_destroy(e);
}

static void what_is_given_stays(void **state) {
    (void)state;
    effect *e = load(marches, NULL, 0);
    assert_string_equal(value_of(e, "b.jitter"), "0.25");
    effect_destroy(e);
    e = load(HEAD "local a = march { name = 'a', density = ball, sampling = 'cubic' }\n"
                  "local b = march { name = 'b', from = a, sampling = 'quasi_cubic' }\n" TAIL,
             NULL, 0);
    assert_string_equal(value_of(e, "b.sampling"), "quasi_cubic"); // though it is the default
    effect_destroy(e);
}

static void numbers_follow_their_source(void **state) {
    (void)state;
    effect *e = load(marches, NULL, 0);
    assert_true(effect_set(e, "a.steps", "44"));
    assert_string_equal(value_of(e, "b.steps"), "44");
    assert_true(effect_set(e, "b.steps", "7"));
    assert_true(effect_set(e, "a.steps", "55"));
    assert_string_equal(value_of(e, "b.steps"), "7");
    assert_true(effect_reset(e, "b.steps"));
    assert_string_equal(value_of(e, "b.steps"), "55");
    effect_destroy(e);
}

static void settings_are_given_too(void **state) {
    (void)state;
    const effect_setting settings[] = {{"b.sampling", "linear", NULL}, {"a.steps", "12", NULL}};
    effect *e = load(marches, settings, 2);
    assert_string_equal(value_of(e, "b.sampling"), "linear");
    assert_string_equal(value_of(e, "a.sampling"), "cubic");
    assert_string_equal(value_of(e, "b.steps"), "12");
    effect_destroy(e);
}

static void setting_of_an_option_is_taken(void **state) {
    (void)state;
    const effect_setting settings[] = {{"a.sampling", "linear", NULL}};
    effect *e = load(marches, settings, 1);
    assert_string_equal(value_of(e, "b.sampling"), "linear");
    effect_destroy(e);
}

static void sources_are_asked_in_order(void **state) {
    (void)state;
    effect *e = load(HEAD "local a = march { name = 'a', density = ball, steps = 33 }\n"
                          "local c = march { name = 'c', density = ball * 2, steps = 44 }\n"
                          "local d = march { name = 'd', from = {c, a} }\n"
                          "local b = march { name = 'b', from = {d, a} }\n" TAIL,
                     NULL, 0);
    assert_string_equal(value_of(e, "d.steps"), "44");
    assert_string_equal(value_of(e, "b.steps"), "44"); // along the chain
    assert_true(effect_set(e, "c.steps", "5"));
    assert_string_equal(value_of(e, "b.steps"), "5");
    effect_destroy(e);
}

static void option_without_that_word_is_not_taken(void **state) {
    (void)state;
    effect *e = load(HEAD "local a = march { name = 'a', density = ball, mode = 'paper' }\n"
                          "local c = march { name = 'c', density = ball }\n"
                          "local b = bright { name = 'b', a, from = {c, a} }\n"
                          "local d = bright { name = 'd', a, from = a }\n" TAIL,
                     NULL, 0);
    assert_string_equal(value_of(e, "b.mode"), "paper"); // c has it as `physical`
    assert_string_equal(value_of(e, "d.mode"), "paper");
    effect_destroy(e);
}

static void images_are_wired_by_name(void **state) {
    (void)state;
    effect *e = load(
        HEAD "local a = geometry { name = 'a' }\n"
             "local b = march { name = 'b', density = ball, from = a, skipping = 'off' }\n" TAIL,
        NULL, 0);
    const char *names[8];
    assert_int_equal(graph_order(effect_graph(e), names, 8), 2); // else a would not be needed
    assert_string_equal(names[0], "a");
    effect_destroy(e);
}

static void mistakes_are_named(void **state) {
    (void)state;
    refused(HEAD "local b = march { density = ball, from = 3 }\n" TAIL,
            "march: 'from' takes a pass or a list of passes, as in from = {lit, scene}; got a "
            "number");
    refused(HEAD "local a = geometry { }\n"
                 "local b = march { density = ball, from = {a, a.depth} }\n" TAIL,
            "got an image");
    refused(HEAD "local a = geometry { }\n"
                 "local b = march { density = ball, from = { scene = a } }\n" TAIL,
            "march: 'from' takes a list without names");
    refused(HEAD "local a = geometry { }\nlocal b = march { from = a }\n" TAIL,
            "field 'density' is missing");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_not_given_is_taken),
        cmocka_unit_test(what_is_given_stays),
        cmocka_unit_test(numbers_follow_their_source),
        cmocka_unit_test(settings_are_given_too),
        cmocka_unit_test(setting_of_an_option_is_taken),
        cmocka_unit_test(sources_are_asked_in_order),
        cmocka_unit_test(option_without_that_word_is_not_taken),
        cmocka_unit_test(images_are_wired_by_name),
        cmocka_unit_test(mistakes_are_named),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
