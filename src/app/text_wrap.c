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

// ---- excerpts -----------------------------------------------------------------------------------

static const size_t LEAST_COLUMNS = 16, NO_CARET = (size_t)-1;
static const char LEFT_OUT[] = "...";

static size_t count_letters(const char *text, size_t length) {
    size_t count = 0;
    for (size_t at = 0; at < length; count++) at = letter_end(text, at, length);
    return count;
}

static size_t skip_letters(const char *text, size_t length, size_t count) {
    size_t at = 0;
    while (at < length && count-- > 0) at = letter_end(text, at, length);
    return at;
}

// Returns the column of the caret in a line that has nothing else.
static size_t caret_of(const char *line, size_t length) {
    size_t at = 0;
    while (at < length && line[at] == ' ') at++;
    return at + 1 == length && line[at] == '^' ? at : NO_CARET;
}

// Returns how many letters to leave out at the left of a line for its caret to be seen, with some
// of what follows it.
static size_t left_out(size_t caret, size_t letters, size_t columns) {
    if (caret == NO_CARET || letters <= columns) return 0;
    size_t end = caret + 1 + columns / 4;
    if (end > letters) end = letters;
    return end > columns ? end - columns : 0;
}

static void add_cut(const char *line, size_t length, size_t first, size_t columns, strbuf *out) {
    const size_t dots = strlen(LEFT_OUT), letters = count_letters(line, length);
    size_t last = letters - first > columns ? first + columns : letters;
    bool before = first > 0, behind = last < letters;
    size_t from = skip_letters(line, length, first + (before ? dots : 0));
    size_t to = skip_letters(line, length, last - (behind ? dots : 0));
    strbuf_add(out, "%s%.*s%s", before ? LEFT_OUT : "", (int)(to - from), line + from,
               behind ? LEFT_OUT : "");
}

void text_excerpt(const char *text, size_t length, size_t columns, strbuf *out) {
    const char *end = text + length;
    size_t first = 0; // of the line above, if this is that of its caret
    if (columns < LEAST_COLUMNS) columns = LEAST_COLUMNS;
    for (const char *line = text; line < end;) {
        const char *stop = memchr(line, '\n', (size_t)(end - line));
        size_t bytes = (size_t)((stop ? stop : end) - line), caret = caret_of(line, bytes);
        if (line > text) strbuf_add(out, "\n");
        if (caret != NO_CARET) { // spaces are letters of one byte
            size_t skipped = first < caret ? first : 0;
            strbuf_add(out, "%.*s", (int)(bytes - skipped), line + skipped);
            first = 0;
        } else {
            const char *next = stop ? stop + 1 : end;
            const char *next_stop = memchr(next, '\n', (size_t)(end - next));
            caret = caret_of(next, (size_t)((next_stop ? next_stop : end) - next));
            first = left_out(caret, count_letters(line, bytes), columns);
            add_cut(line, bytes, first, columns, out);
        }
        line = stop ? stop + 1 : end;
    }
}
