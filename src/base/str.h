// Growing text, and help with misspelt names.
#pragma once
#include "base/error.h"
#include <locale.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct strbuf {
    char *text; // NUL-terminated once anything was added; NULL when empty
    size_t length, capacity;
} strbuf;

void strbuf_add(strbuf *s, const char *format, ...) PRINTF_LIKE(2, 3);
void strbuf_append(strbuf *s, const char *bytes, size_t length);
void strbuf_add_float(strbuf *s, float value); // the shortest number that reads back the same
void strbuf_free(strbuf *s);
const char *strbuf_text(const strbuf *s); // "" when empty

// The candidate nearest to `word` by edit distance (transpositions count one), or NULL when none
// is near enough to be a likely typing error.
const char *str_nearest(const char *word, const char *const *candidates, size_t count);

// What terminals obey becomes '?': control characters other than line breaks and tabs, those of
// Unicode beyond ASCII (U+0080 to U+009F) too. For whatever came from a file and is printed.
void str_make_printable(char *text);

// As strtof and strtod, of numbers with a point, whatever locale the program has chosen.
float str_float(const char *text, char **end);
double str_double(const char *text, char **end);
// Until str_leave_c_locale(before), the calling thread formats and reads numbers with a point.
locale_t str_enter_c_locale(void);
void str_leave_c_locale(locale_t before);

bool str_ends_with(const char *text, const char *ending);
bool str_has_place(const char *text);     // begins with a file and line, "a.lua:12: "
bool str_is_identifier(const char *text); // [A-Za-z_][A-Za-z0-9_]*
// Copies with truncation; always terminated. False when `text` did not fit.
bool str_copy(char *out, size_t capacity, const char *text);
