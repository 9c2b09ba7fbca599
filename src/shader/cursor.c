// The tokens of annotations: numbers, words, lists, ranges, units, help.
#include "base/words.h"
#include "shader/annotate.h"
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool cursor_fail(const cursor *c, const char *format, ...) {
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return err_set("%s:%d: %s", c->label, c->line, text);
}

static void cursor_skip(cursor *c) {
    while (*c->at == ' ' || *c->at == '\t') c->at++;
}

bool cursor_take(cursor *c, char symbol) {
    cursor_skip(c);
    if (*c->at != symbol) return false;
    c->at++;
    return true;
}

bool cursor_word(cursor *c, char out[NAME_CAP], const char *what) {
    cursor_skip(c);
    size_t length = 0;
    while (isalnum((unsigned char)c->at[length]) || c->at[length] == '_') length++;
    if (!length) return cursor_fail(c, "expected %s at \"%.20s\"", what, c->at);
    if (length >= NAME_CAP) return cursor_fail(c, "%s is longer than 63 letters", what);
    memcpy(out, c->at, length);
    out[length] = '\0';
    c->at += length;
    return true;
}

bool cursor_name(cursor *c, char out[NAME_CAP], const char *what) {
    if (!cursor_word(c, out, what)) return false;
    return str_is_identifier(out) || cursor_fail(c, "%s cannot begin with a digit: %s", what, out);
}

bool cursor_is_number(cursor *c) {
    cursor_skip(c);
    const char *at = c->at + (*c->at == '-' || *c->at == '+');
    return isdigit((unsigned char)at[at[0] == '.']);
}

static bool number(cursor *c, float *out) {
    if (!cursor_is_number(c)) return cursor_fail(c, "expected a number at \"%.20s\"", c->at);
    char *end;
    float value = str_float(c->at, &end);
    bool whole_token = !isalnum((unsigned char)*end) && *end != '_' && *end != '.';
    if (!whole_token || !isfinite(value))
        return cursor_fail(c, "\"%.20s\" is not a number of 32 bits", c->at);
    c->at = end;
    *out = value;
    return true;
}

bool cursor_value(cursor *c, int components, float out[4]) {
    if (!cursor_take(c, '{')) {
        float value;
        if (!number(c, &value)) return false;
        for (int i = 0; i < components; i++) out[i] = value;
        return true;
    }
    for (int i = 0;; i++) {
        float value;
        if (!number(c, &value)) return false;
        if (i < components) out[i] = value;
        if (cursor_take(c, ',')) continue;
        if (!cursor_take(c, '}')) return cursor_fail(c, "expected , or } at \"%.20s\"", c->at);
        if (i + 1 == components) return true;
        return cursor_fail(c, "%d numbers given, %d accepted", i + 1, components);
    }
}

static bool cursor_bound(cursor *c, float infinity, const char *word, float *out) {
    cursor_skip(c);
    size_t length = strlen(word);
    if (strncmp(c->at, word, length) != 0) return number(c, out);
    c->at += length;
    *out = infinity;
    return true;
}

bool cursor_range(cursor *c, float *min, float *max) {
    *min = -INFINITY;
    *max = INFINITY;
    if (!cursor_take(c, '[')) return true;
    if (!cursor_bound(c, -INFINITY, "-inf", min)) return false;
    if (!cursor_take(c, ',')) return cursor_fail(c, "expected , at \"%.20s\"", c->at);
    if (!cursor_bound(c, INFINITY, "inf", max)) return false;
    if (!cursor_take(c, ']')) return cursor_fail(c, "expected ] at \"%.20s\"", c->at);
    if (*min > *max) return cursor_fail(c, "the range is empty: its first number is the larger");
    return true;
}

bool cursor_unit(cursor *c, const char **out) {
    cursor_skip(c);
    size_t length = strcspn(c->at, " \t:");
    *out = arena_format(c->memory, "%.*s", (int)length, c->at);
    c->at += length;
    return true;
}

static bool add_word(cursor *c, const char **words, size_t *count, const char *word) {
    if (words_find(words, *count, word) >= 0) return cursor_fail(c, "\"%s\" is given twice", word);
    if (*count == MAX_WORDS) return cursor_fail(c, "more than %d words", MAX_WORDS);
    words[(*count)++] = arena_string(c->memory, word);
    return true;
}

bool cursor_words(cursor *c, const char *word, const char *const **words, size_t *count,
                  size_t *chosen) {
    const char *list[MAX_WORDS];
    *count = 0;
    if (!cursor_take(c, '{'))
        return cursor_fail(c, "expected {the words to choose from} at \"%.20s\"", c->at);
    do {
        char next[NAME_CAP];
        if (!cursor_word(c, next, "a word") || !add_word(c, list, count, next)) return false;
    } while (cursor_take(c, ','));
    if (!cursor_take(c, '}')) return cursor_fail(c, "expected , or } at \"%.20s\"", c->at);
    *chosen = 0;
    while (*chosen < *count && strcmp(list[*chosen], word) != 0) ++*chosen;
    if (*chosen == *count) return cursor_fail(c, "the default \"%s\" is not in the list", word);
    *words = arena_copy(c->memory, list, *count * sizeof *list);
    return true;
}

bool cursor_help(cursor *c, const char **out) {
    if (!cursor_take(c, ':')) return cursor_fail(c, "expected \": help\" at \"%.20s\"", c->at);
    cursor_skip(c);
    size_t length = strlen(c->at);
    while (length && isspace((unsigned char)c->at[length - 1])) length--;
    if (!length) return cursor_fail(c, "the help after the colon is missing");
    *out = arena_format(c->memory, "%.*s", (int)length, c->at);
    c->at += strlen(c->at);
    return true;
}
