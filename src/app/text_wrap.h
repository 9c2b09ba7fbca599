// Wrapping of text into lines. Needs no window.
#pragma once
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
