// Breaks text into lines.
#include "app/text_wrap.h"
#include <stdbool.h>
#include <string.h>

enum { MAX_LINE = 512 }; // bytes that are measured at once

static bool fits(const char *text, size_t length, float width, float (*measure)(const char *text)) {
    char line[MAX_LINE];
    if (length >= sizeof line) return false;
    memcpy(line, text, length);
    line[length] = 0;
    return measure(line) <= width;
}

static size_t word_end(const char *text, size_t from, size_t length) {
    while (from < length && text[from] == ' ') from++;
    while (from < length && text[from] != ' ') from++;
    return from;
}

static size_t letter_end(const char *text, size_t from, size_t length) { // UTF-8
    for (from++; from < length && ((unsigned char)text[from] & 0xc0) == 0x80;) from++;
    return from;
}

// Returns the end of the first line of `text`: as many words as fit, or else as many letters, at
// least one.
static size_t line_end(const char *text, size_t length, float width,
                       float (*measure)(const char *text)) {
    size_t end = 0, next;
    while (end < length && fits(text, next = word_end(text, end, length), width, measure))
        end = next;
    if (end > 0) return end;
    end = letter_end(text, 0, length);
    while (end < length && fits(text, next = letter_end(text, end, length), width, measure))
        end = next;
    return end;
}

size_t text_wrap_lines(const char *text, size_t length, float width,
                       float (*measure)(const char *text)) {
    size_t lines = 0;
    do {
        size_t end = length ? line_end(text, length, width, measure) : 0;
        while (end < length && text[end] == ' ') end++;
        text += end;
        length -= end;
        lines++;
    } while (length > 0);
    return lines;
}

text_message text_split(const char *message) {
    const char *end = message + strlen(message);
    text_message m = {.head = message, .head_length = strcspn(message, "\n")};
    m.rest = m.head + m.head_length;
    while (m.rest < end && *m.rest == '\n') m.rest++;
    while (end > m.rest && end[-1] == '\n') end--;
    m.rest_length = (size_t)(end - m.rest);
    m.rest_lines = m.rest_length > 0;
    for (const char *at = m.rest; at < end; at++) m.rest_lines += *at == '\n';
    return m;
}
