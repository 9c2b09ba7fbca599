// The command of an editor, with file and line put in.
#include "base_test.h"

#include "app/editor.h"
#include "base/memory.h"

static void becomes(const char *command, const char *const *expected) {
    char *words[9];
    assert_true(editor_words(command, "a b.lua", 12, words, 8));
    size_t i = 0;
    for (; expected[i]; i++) {
        assert_non_null(words[i]);
        assert_string_equal(words[i], expected[i]);
    }
    assert_null(words[i]);
    for (i = 0; words[i]; i++) mem_free(words[i]);
}

static void places_are_filled_in(void **state) {
    (void)state;
    becomes("code -g %f:%l", (const char *[]){"code", "-g", "a b.lua:12", NULL});
    becomes("  ed  %l%% %f ", (const char *[]){"ed", "12%%", "a b.lua", NULL});
    becomes("vim", (const char *[]){"vim", "+12", "a b.lua", NULL}); // as most editors take it
    becomes("vim -R", (const char *[]){"vim", "-R", "+12", "a b.lua", NULL});
    becomes("x %l", (const char *[]){"x", "12", "+12", "a b.lua", NULL});
}

static void what_is_no_command_is_refused(void **state) {
    (void)state;
    char *words[9];
    assert_false(editor_words("  ", "a.lua", 1, words, 8));
    assert_null(words[0]);
    assert_false(editor_words("a b c d e f g h i j", "a.lua", 1, words, 8));
    for (size_t i = 0; words[i]; i++) mem_free(words[i]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_filled_in),
        cmocka_unit_test(what_is_no_command_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
