// Texts that are broken into lines, and messages that are taken apart.
#include "app/text_wrap.h"
#include "unit/base_test.h"
#include <string.h>

static float letters(const char *text) { // each is one wide
    size_t count = 0;
    for (; *text; text++) count += ((unsigned char)*text & 0xc0) != 0x80;
    return (float)count;
}

static size_t lines(const char *text, float width) {
    return text_wrap_lines(text, strlen(text), width, letters);
}

static void words_fill_lines(void **state) {
    (void)state;
    assert_int_equal(lines("", 10), 1);
    assert_int_equal(lines("one", 10), 1);
    assert_int_equal(lines("one two three", 13), 1);
    assert_int_equal(lines("one two three", 12), 2);
    assert_int_equal(lines("one two three", 5), 3);
    assert_int_equal(lines("one two ", 7), 1);
}

static void long_words_are_broken(void **state) {
    (void)state;
    assert_int_equal(lines("abcdefghij", 5), 2);
    assert_int_equal(lines("abcdefghijk", 5), 3);
    assert_int_equal(lines("a bcdefghijk", 5), 3);
    assert_int_equal(lines("\u00e4\u00f6\u00fc\u00df", 2), 2); // letters, not bytes
}

static void no_width_ends_too(void **state) {
    (void)state;
    assert_int_equal(lines("abc", 0), 3);
    assert_int_equal(lines("\u00e4b", -1), 2);
}

static void only_as_much_as_is_asked_for(void **state) {
    (void)state;
    assert_int_equal(text_wrap_lines("one two", 3, 3, letters), 1);
}

static void is_parts(const char *message, const char *head, const char *rest, size_t rest_lines) {
    text_message m = text_split(message);
    assert_int_equal(m.head_length, strlen(head));
    assert_memory_equal(m.head, head, strlen(head));
    assert_int_equal(m.rest_length, strlen(rest));
    assert_memory_equal(m.rest, rest, strlen(rest));
    assert_int_equal(m.rest_lines, rest_lines);
}

static void messages_have_a_head_and_a_rest(void **state) {
    (void)state;
    is_parts("a.lua:1: no", "a.lua:1: no", "", 0);
    is_parts("a.lua:1: no\n", "a.lua:1: no", "", 0);
    is_parts("a.lua:1: no\n    x = y\n        ^", "a.lua:1: no", "    x = y\n        ^", 2);
    is_parts("a.lua:1: no\n    x = y\n", "a.lua:1: no", "    x = y", 1);
    is_parts("", "", "", 0);
}

static void is_excerpt(const char *text, size_t columns, const char *expected) {
    strbuf out = {0};
    text_excerpt(text, strlen(text), columns, &out);
    assert_string_equal(strbuf_text(&out), expected);
    strbuf_free(&out);
}

static void long_lines_are_cut_around_their_caret(void **state) {
    (void)state;
    is_excerpt("x = y\n  ^", 16, "x = y\n  ^");
    is_excerpt("0123456789abcdefghij", 16, "0123456789abc...");
    is_excerpt("0123456789abcdef", 16, "0123456789abcdef");
    is_excerpt("0123456789abcdefghij\n  ^\n from", 16, "0123456789abc...\n  ^\n from");
    is_excerpt("0123456789abcdefghijklmnopqrstuvwxyz\n                    ^", 16, // below k
               "...cdefghijkl...\n           ^");
    is_excerpt("0123456789abcdefghij\n                   ^", 16,
               "...789abcdefghij\n               ^");
    is_excerpt("\u00e4123456789\u00e4bcdefghij\n                   ^\nb: 0123456789abcdefg", 1,
               "...789\u00e4bcdefghij\n               ^\nb: 0123456789...");
    is_excerpt("", 20, "");
    is_excerpt("^\n\n ^", 20, "^\n\n ^");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_fill_lines),
        cmocka_unit_test(long_words_are_broken),
        cmocka_unit_test(no_width_ends_too),
        cmocka_unit_test(only_as_much_as_is_asked_for),
        cmocka_unit_test(messages_have_a_head_and_a_rest),
        cmocka_unit_test(long_lines_are_cut_around_their_caret),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
