// Wrapping of text into lines. Needs no window.
#pragma once
#include "base/str.h"
#include <stddef.h>

// Returns the number of lines of a paragraph (without its newline) when it is broken at spaces, so
// that each line is at most `width` wide as measured by `measure`. A longer word takes a line or
// more. At least 1.
size_t text_wrap_lines(const char *text, size_t length, float width,
                       float (*measure)(const char *text));

typedef struct text_message { // the parts of an error message; neither is terminated
    const char *head;         // "explosion.lua:12: no pass 'marsh'"
    size_t head_length;
    const char *rest; // lines below: source and caret, callers in Lua
    size_t rest_length, rest_lines;
} text_message;
text_message text_split(const char *message);

// Appends lines with at most `columns` letters each, at least 16, and "..." where some are left
// out. A line of source has a caret in the line below it, which stays below its letter; of these
// two as much is left out at the left as it takes to see the caret.
void text_excerpt(const char *text, size_t length, size_t columns, strbuf *out);
