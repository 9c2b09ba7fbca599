// Messages for people who edit an effect: the line of source that a message names and, where the
// line contains the quoted word exactly once, the column of that.
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include "roil/live.h"
#include <assert.h>
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { SOURCE_MAX = 4 << 20, LINE_MAX = 160 };

#define INDENT "    "

// Splits "path:12: text". False when the message does not begin so.
static bool find_place(const char *message, char path[PATH_CAP], int *line) {
    size_t end = strcspn(message, "\n");
    for (const char *at = message; (at = memchr(at, ':', end - (size_t)(at - message))); at++) {
        char *rest;
        long number = strtol(at + 1, &rest, 10);
        size_t length = (size_t)(at - message);
        if (rest == at + 1 || *rest != ':' || number < 1 || number > 1000000 || !length) continue;
        if (length >= PATH_CAP) return false;
        memcpy(path, message, length);
        path[length] = '\0';
        *line = (int)number;
        return true;
    }
    return false;
}

// Reads a file by the name in a message: as the user gave it, or "lib/..." for the library's
// scripts.
static bool read_source(const char *path, const char *scripts, char **out) {
    char other[PATH_CAP];
    void *data;
    size_t size;
    if (!file_read(path, SOURCE_MAX, &data, &size) &&
        (!scripts || !path_join(other, scripts, path) ||
         !file_read(other, SOURCE_MAX, &data, &size)))
        return false;
    *out = data;
    return true;
}

// Returns line `number` without its indentation, whose length may be asked for. False when there is
// no such line, or when it is empty.
static bool source_line(const char *path, const char *scripts, int number, char out[LINE_MAX],
                        size_t *indent) {
    char *text;
    if (!read_source(path, scripts, &text)) return false;
    const char *at = text;
    for (int i = 1; i < number && at; i++) {
        at = strchr(at, '\n');
        if (at) at++;
    }
    size_t blank = at ? strspn(at, " \t") : 0;
    if (at) at += blank;
    if (indent) *indent = blank;
    size_t length = at ? strcspn(at, "\r\n") : 0;
    if (length >= LINE_MAX) length = LINE_MAX - 1;
    if (length) memcpy(out, at, length);
    out[length] = '\0';
    for (size_t i = 0; i < length; i++)
        if (iscntrl((unsigned char)out[i])) out[i] = ' ';
    mem_free(text);
    return length > 0;
}

static bool is_name(char c) {
    return isalnum((unsigned char)c) || c == '_';
}

static const char *find_word(const char *from, const char *line, const char *word) {
    size_t length = strlen(word);
    for (; (from = strstr(from, word)); from++) {
        bool begins = from == line || !is_name(from[-1]) || !is_name(word[0]);
        bool ends = !is_name(from[length]) || !is_name(word[length - 1]);
        if (begins && ends) return from;
    }
    return NULL;
}

// Returns the column of the first quoted word that `line` contains exactly once; -1: there is none.
static int find_column(const char *message, const char *line) {
    const char *end = message + strcspn(message, "\n");
    for (const char *open = strchr(message, '\''); open && open < end;) {
        const char *close = strchr(open + 1, '\'');
        if (!close || close > end) return -1;
        char word[LINE_MAX];
        size_t length = (size_t)(close - open - 1);
        if (length && length < sizeof word) {
            memcpy(word, open + 1, length);
            word[length] = '\0';
            const char *found = find_word(line, line, word);
            if (found && !find_word(found + 1, line, word)) return (int)(found - line);
        }
        open = strchr(close + 1, '\'');
    }
    return -1;
}

char *live_explain(const char *message, const char *scripts) {
    char path[PATH_CAP], line[LINE_MAX];
    int number;
    size_t first = strcspn(message, "\n");
    const char *rest = message + first;
    strbuf out = {0};
    strbuf_append(&out, message, first);
    bool shown = strncmp(rest, "\n" INDENT, 5) == 0; // the shader compiler shows it already
    bool known = false;
    if (shown) {
        size_t length = strcspn(rest + 5, "\n");
        known = length < sizeof line;
        if (known) {
            memcpy(line, rest + 5, length);
            line[length] = '\0';
        }
        strbuf_append(&out, rest, 5 + length);
        rest += 5 + length;
    } else if (find_place(message, path, &number)) {
        known = source_line(path, scripts, number, line, NULL);
        if (known) strbuf_add(&out, "\n" INDENT "%s", line);
    }
    int column = known ? find_column(message, line) : -1;
    if (column >= 0) strbuf_add(&out, "\n" INDENT "%*s^", column, "");
    strbuf_append(&out, rest, strlen(rest));
    return out.text;
}

// Finds a place further on in the first line, "user.lua:2: haze: ./haze.comp:5: ...", whose file
// can be read.
static bool find_inner(const char *message, const char *scripts, char path[PATH_CAP], int *line,
                       char text[LINE_MAX], size_t *indent) {
    const char *end = message + strcspn(message, "\n");
    for (const char *at = message; (at = strstr(at, ": ")) && at < end;) {
        at += 2;
        bool named = find_place(at, path, line) && !strchr(path, ' ');
        if (named && source_line(path, scripts, *line, text, indent)) return true;
    }
    return false;
}

static bool find_named_place(const roil *r, const char *message, roil_place *out) {
    static_assert(sizeof out->file >= PATH_CAP, "a path fits");
    const char *scripts = r ? r->scripts : NULL;
    char line[LINE_MAX];
    size_t indent;
    *out = (roil_place){0};
    size_t size = strlen(message) + 1;
    char *kept = mem_copy(message, size); // reading a file may set another
    bool found = true;
    bool read = find_inner(kept, scripts, out->file, &out->line, line, &indent);
    if (!read) {
        found = find_place(kept, out->file, &out->line);
        read = found && source_line(out->file, scripts, out->line, line, &indent);
    }
    if (read) {
        int column = find_column(kept, line);
        out->column = (int)indent + (column < 0 ? 0 : column) + 1;
    }
    if (!found) *out = (roil_place){0};
    mem_free(kept);
    return found;
}

bool roil_find_place(const roil *r, const char *message, roil_place *out) {
    return MEM_CALL(find_named_place(r, message, out));
}
