// How many lines a text takes. Knows no window.
#pragma once
#include <stddef.h>

// Lines of one paragraph, without its newline, that is broken at spaces so that each is at most
// `width` wide as `measure` counts it; a longer word has a line, or more, of its own. At least 1.
size_t text_wrap_lines(const char *text, size_t length, float width,
                       float (*measure)(const char *text));

typedef struct text_message { // as errors are written; neither part is terminated
    const char *head;         // "explosion.lua:12: no pass 'marsh'"
    size_t head_length;
    const char *rest; // lines below: source and caret, callers in Lua
    size_t rest_length, rest_lines;
} text_message;
text_message text_split(const char *message);
