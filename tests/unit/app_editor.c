// The command of an editor, with file and line put in.
#include "base_test.h"

#include "app/editor.h"
#include "base/error.h"
#include "base/memory.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

static void an_editor_runs_beside_or_is_named(void **state) {
    (void)state;
    int ends[2];
    char said[64] = "";
    assert_int_equal(pipe(ends), 0);
    setenv("ROIL_EDITOR", "roil-no-such-editor %f", 1);
    assert_false(editor_open("a.lua", 3));
    assert_non_null(strstr(err_get(), "the editor 'roil-no-such-editor': No such file"));
    setenv("ROIL_EDITOR", "/bin/echo at %l of %f", 1);
    fflush(stdout);
    int out = dup(STDOUT_FILENO);
    dup2(ends[1], STDOUT_FILENO);
    bool done = editor_open("a b.lua", 3);
    dup2(out, STDOUT_FILENO);
    ssize_t count = read(ends[0], said, sizeof said - 1);
    assert_true(done && count > 0);
    assert_string_equal(said, "at 3 of a b.lua\n");
    close(out);
    close(ends[0]);
    close(ends[1]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_filled_in),
        cmocka_unit_test(what_is_no_command_is_refused),
        cmocka_unit_test(an_editor_runs_beside_or_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
