// Text buffers, suggestions for misspelt names, and numbers as text.
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
void strbuf_add_base64(strbuf *s, const void *data, size_t size);
void strbuf_free(strbuf *s);
const char *strbuf_text(const strbuf *s); // "" when empty

// Returns the candidate that `word` was renamed to, else the nearest by edit distance (a
// transposition counts as one edit), or NULL when none is near enough for a likely typing error.
const char *str_nearest(const char *word, const char *const *candidates, size_t count);

// Replaces what a terminal would obey by '?': control characters other than line breaks and tabs,
// including U+0080 to U+009F. For text that comes from a file and is printed.
void str_make_printable(char *text);

// Like strtof and strtod, but with a decimal point in every locale.
float str_float(const char *text, char **end);
double str_double(const char *text, char **end);
// Makes the calling thread format and read numbers with a decimal point, until it calls
// str_leave_c_locale with the result.
locale_t str_enter_c_locale(void);
void str_leave_c_locale(locale_t before);

bool str_ends_with(const char *text, const char *ending);
bool str_has_place(const char *text);     // begins with a file and line, "a.lua:12: "
bool str_is_identifier(const char *text); // [A-Za-z_][A-Za-z0-9_]*
// Copies with truncation; always terminated. False when `text` did not fit.
bool str_copy(char *out, size_t capacity, const char *text);
