// Messages of a live effect: the source line stands beneath, with a caret where it can be told.
#include "base_test.h"

#include "base/memory.h"
#include "roil/live.h"

static void explains(const char *message, const char *scripts, const char *expected) {
    char *text = live_explain(message, scripts);
    assert_string_equal(text, expected);
    mem_free(text);
}

static void in_scratch(const char *folder, const char *format, char out[512]) {
    snprintf(out, 512, format, folder);
}

static void line_of_lua_is_shown_above_the_callers(void **state) {
    char message[512], expected[512];
    put(*state, "a.lua", "local x = 1\n   local y = nothing.field\n");
    in_scratch(*state,
               "%s/a.lua:2: attempt to index a nil value (global 'nothing')\ncalled from b.lua:7",
               message);
    in_scratch(*state,
               "%s/a.lua:2: attempt to index a nil value (global 'nothing')\n"
               "    local y = nothing.field\n"
               "              ^\ncalled from b.lua:7",
               expected);
    explains(message, "", expected);
}

static void word_that_the_line_has_twice_gets_no_caret(void **state) {
    char message[512], expected[512];
    put(*state, "a.lua", "x = y + y");
    in_scratch(*state, "%s/a.lua:1: near 'y'", message);
    in_scratch(*state, "%s/a.lua:1: near 'y'\n    x = y + y", expected);
    explains(message, "", expected);
}

static void part_of_a_word_is_not_the_word(void **state) {
    char message[512], expected[512];
    put(*state, "a.lua", "yes = y");
    in_scratch(*state, "%s/a.lua:1: near 'y'", message);
    in_scratch(*state, "%s/a.lua:1: near 'y'\n    yes = y\n          ^", expected);
    explains(message, "", expected);
}

static void line_that_the_compiler_showed_gets_its_caret(void **state) {
    (void)state;
    explains("a.comp:3: 'foo': undeclared identifier\n    x = foo;", "",
             "a.comp:3: 'foo': undeclared identifier\n    x = foo;\n        ^");
}

static void module_of_the_program_is_found(void **state) {
    put(*state, "lib/fire.lua", "return 1\nreturn 2");
    explains("lib/fire.lua:2: 'x' is wrong", *state, "lib/fire.lua:2: 'x' is wrong\n    return 2");
}

static void message_without_a_place_stays_as_it_is(void **state) {
    (void)state;
    explains("no device memory", "", "no device memory");
    explains("gone.lua:3: it fails", "", "gone.lua:3: it fails");
    explains("12:30 is no file", "", "12:30 is no file");
    explains("", "", "");
}

static void line_beyond_the_end_is_not_shown(void **state) {
    char message[512];
    put(*state, "a.lua", "x = 1\n");
    in_scratch(*state, "%s/a.lua:7: 'end' expected", message);
    explains(message, "", message);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(line_of_lua_is_shown_above_the_callers),
        SCRATCH_TEST(word_that_the_line_has_twice_gets_no_caret),
        SCRATCH_TEST(part_of_a_word_is_not_the_word),
        SCRATCH_TEST(line_that_the_compiler_showed_gets_its_caret),
        SCRATCH_TEST(module_of_the_program_is_found),
        SCRATCH_TEST(message_without_a_place_stays_as_it_is),
        SCRATCH_TEST(line_beyond_the_end_is_not_shown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
