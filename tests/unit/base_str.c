// Text: growing buffers, the nearest name, and messages.
#include "base_test.h"

#include "base/memory.h"
#include "base/str.h"
#include <pthread.h>

static void buffer_grows(void **state) {
    (void)state;
    strbuf s = {0};
    assert_string_equal(strbuf_text(&s), "");
    strbuf_add(&s, "%s", "");
    assert_string_equal(strbuf_text(&s), "");
    for (int i = 0; i < 1000; i++) strbuf_add(&s, "%04d ", i);
    assert_int_equal(s.length, 5000);
    assert_int_equal(strlen(s.text), 5000);
    assert_memory_equal(s.text + 5 * 123, "0123 ", 5);
    strbuf_append(&s, "a\0b", 3); // bytes, not text
    assert_int_equal(s.length, 5003);
    assert_memory_equal(s.text + 5000, "a\0b\0", 4);
    strbuf_free(&s);
    assert_null(s.text);
    assert_int_equal(s.length, 0);
}

static const char *nearest(const char *word) {
    static const char *const names[] = {"density", "emission", "steps", "step_size", "depth", "g"};
    return str_nearest(word, names, COUNT_OF(names));
}

static void nearest_name_forgives_typing_errors(void **state) {
    (void)state;
    assert_string_equal(nearest("densty"), "density");     // a letter lost
    assert_string_equal(nearest("dennsity"), "density");   // doubled
    assert_string_equal(nearest("dehsity"), "density");    // wrong
    assert_string_equal(nearest("denstiy"), "density");    // swapped
    assert_string_equal(nearest("Density"), "density");    // the case
    assert_string_equal(nearest("detph"), "depth");        // swapped in a short word
    assert_string_equal(nearest("step"), "steps");         // nearer than step_size
    assert_string_equal(nearest("stepsize"), "step_size"); // and the other way round
    assert_string_equal(nearest("emission"), "emission");
}

static void nearest_name_does_not_guess_wildly(void **state) {
    (void)state;
    assert_null(nearest("x"));
    assert_null(nearest(""));
    assert_null(nearest("colour"));
    assert_null(nearest("absorption"));
    const char *const renamed[] = {"point_lights", "shade.point_lights_by"};
    assert_string_equal(str_nearest("lamps", renamed, 2), "point_lights");
    assert_string_equal(str_nearest("shade.lamps_by", renamed, 2), "shade.point_lights_by");
    assert_null(str_nearest("lamp_shadows", renamed, 2));
    const char *const add = "add";
    assert_null(str_nearest("vdb", &add, 1)); // one letter of three is no likeness
    assert_null(str_nearest("density", NULL, 0));
    char longest[300];
    memset(longest, 'a', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    assert_null(nearest(longest));
    const char *const names[] = {longest};
    assert_null(str_nearest("aaa", names, 1));
}

static void identifiers_are_told_from_other_text(void **state) {
    (void)state;
    assert_true(str_is_identifier("a"));
    assert_true(str_is_identifier("_a9Z"));
    assert_false(str_is_identifier(""));
    assert_false(str_is_identifier("9a"));
    assert_false(str_is_identifier("a-b"));
    assert_false(str_is_identifier("a b"));
    assert_false(str_is_identifier("\xc3\xa9t\xc3\xa9"));
}

static void places_in_files_are_told_from_other_text(void **state) {
    (void)state;
    assert_true(str_has_place("a.lua:3: it fails"));
    assert_true(str_has_place("effects/a b.lua:120: "));
    assert_false(str_has_place("lbm: a.comp:3: it fails"));
    assert_false(str_has_place("a.lua:3 fails"));
    assert_false(str_has_place("a.lua\n:3: "));
    assert_false(str_has_place(":3: it fails"));
    assert_false(str_has_place("a.lua::"));
    assert_false(str_has_place(""));
}

static void endings_are_compared(void **state) {
    (void)state;
    assert_true(str_ends_with("a.vdb", ".vdb"));
    assert_true(str_ends_with("a", ""));
    assert_false(str_ends_with("vdb", ".vdb"));
    assert_false(str_ends_with("a.vdb2", ".vdb"));
}

static void copies_are_cut_and_terminated(void **state) {
    (void)state;
    char out[4] = "zzz";
    assert_true(str_copy(out, sizeof out, "abc"));
    assert_string_equal(out, "abc");
    assert_false(str_copy(out, sizeof out, "defg"));
    assert_string_equal(out, "def");
    assert_true(str_copy(out, 1, ""));
    assert_false(str_copy(out, 1, "a"));
    assert_string_equal(out, "");
}

static void message_can_be_built_from_itself(void **state) {
    (void)state;
    assert_false(err_set("no grid '%s'", "heat"));
    assert_false(err_prefix("%s: ", "a.vdb"));
    assert_string_equal(err_get(), "a.vdb: no grid 'heat'");
    assert_false(err_set("line 3: %s", err_get()));
    assert_string_equal(err_get(), "line 3: a.vdb: no grid 'heat'");
    err_clear();
    assert_string_equal(err_get(), "");
}

static void long_messages_are_cut(void **state) {
    (void)state;
    char text[20000];
    memset(text, 'a', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    err_set("%s", text);
    size_t longest = strlen(err_get());
    assert_true(longest > 4000 && longest < sizeof text);
    err_prefix("%s", "b");
    assert_int_equal(err_get()[0], 'b');
    assert_int_equal(strlen(err_get()), longest);
    err_prefix("%s", text);
    assert_int_equal(strlen(err_get()), longest);
    err_clear();
}

static void *set_another(void *user) {
    assert_string_equal(err_get(), "");
    err_set("other");
    *(bool *)user = true;
    return NULL;
}

static void threads_have_their_own_message(void **state) {
    (void)state;
    bool ran = false;
    pthread_t thread;
    err_set("mine");
    assert_int_equal(pthread_create(&thread, NULL, set_another, &ran), 0);
    pthread_join(thread, NULL);
    assert_true(ran);
    assert_string_equal(err_get(), "mine");
}

static void floats_are_short_and_exact(void **state) {
    (void)state;
    static const struct {
        float value;
        const char *text;
    } cases[] = {
        {0, "0"},        {-0.0f, "0"},           {1, "1"},         {0.1f, "0.1"},
        {-2.5f, "-2.5"}, {16777216, "16777216"}, {1e-7f, "1e-07"}, {1.0f / 3, "0.33333334"},
        {3e38f, "3e+38"}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        strbuf out = {0};
        strbuf_add_float(&out, cases[i].value);
        assert_string_equal(strbuf_text(&out), cases[i].text);
        strbuf_free(&out);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buffer_grows),
        cmocka_unit_test(nearest_name_forgives_typing_errors),
        cmocka_unit_test(nearest_name_does_not_guess_wildly),
        cmocka_unit_test(identifiers_are_told_from_other_text),
        cmocka_unit_test(places_in_files_are_told_from_other_text),
        cmocka_unit_test(endings_are_compared),
        cmocka_unit_test(copies_are_cut_and_terminated),
        cmocka_unit_test(message_can_be_built_from_itself),
        cmocka_unit_test(long_messages_are_cut),
        cmocka_unit_test(threads_have_their_own_message),
        cmocka_unit_test(floats_are_short_and_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
