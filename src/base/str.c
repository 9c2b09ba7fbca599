#include "base/str.h"
#include "base/memory.h"
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void strbuf_reserve(strbuf *s, size_t more) {
    s->text = mem_reserve(s->text, 1, s->length + more + 1, &s->capacity);
}

void strbuf_append(strbuf *s, const char *bytes, size_t length) {
    strbuf_reserve(s, length);
    if (length) memcpy(s->text + s->length, bytes, length);
    s->length += length;
    s->text[s->length] = '\0';
}

// glibc's and musl's C locales are static objects, which nothing frees.
static locale_t c_locale(void) {
    return newlocale(LC_ALL_MASK, "C", (locale_t)0);
}

locale_t str_enter_c_locale(void) {
    return uselocale(c_locale());
}

void str_leave_c_locale(locale_t before) {
    uselocale(before);
}

float str_float(const char *text, char **end) {
    return strtof_l(text, end, c_locale());
}

double str_double(const char *text, char **end) {
    return strtod_l(text, end, c_locale());
}

void strbuf_add(strbuf *s, const char *format, ...) {
    locale_t before = str_enter_c_locale();
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    int length = vsnprintf(NULL, 0, format, args);
    va_end(args);
    strbuf_reserve(s, (size_t)length);
    vsnprintf(s->text + s->length, (size_t)length + 1, format, again);
    va_end(again);
    s->length += (size_t)length;
    str_leave_c_locale(before);
}

void strbuf_add_float(strbuf *s, float value) {
    char text[32] = "0"; // of both zeros
    locale_t before = str_enter_c_locale();
    for (int digits = 6; value != 0 && digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value) break;
    }
    str_leave_c_locale(before);
    strbuf_append(s, text, strlen(text));
}

void strbuf_add_base64(strbuf *out, const void *data, size_t size) {
    const unsigned char *bytes = data;
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        unsigned three =
            bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
        char four[4] = {digits[three >> 18], digits[three >> 12 & 63],
                        left > 1 ? digits[three >> 6 & 63] : '=',
                        left > 2 ? digits[three & 63] : '='};
        strbuf_append(out, four, sizeof four);
    }
}

void strbuf_free(strbuf *s) {
    mem_free(s->text);
    *s = (strbuf){0};
}

const char *strbuf_text(const strbuf *s) {
    return s->text ? s->text : "";
}

// The optimal string alignment distance. Case is ignored, and words have at most WORD_CAP letters.
enum { WORD_CAP = 64 };

static size_t smallest(size_t a, size_t b) {
    return a < b ? a : b;
}

static size_t distance(const char *a, const char *b) {
    size_t n = strlen(a), m = strlen(b);
    if (n > WORD_CAP || m > WORD_CAP) return n + m;
    size_t rows[3][WORD_CAP + 1];
    size_t *before = rows[0], *above = rows[1], *row = rows[2];
    for (size_t j = 0; j <= m; j++) above[j] = j;
    for (size_t i = 1; i <= n; i++) {
        row[0] = i;
        for (size_t j = 1; j <= m; j++) {
            int ca = tolower((unsigned char)a[i - 1]), cb = tolower((unsigned char)b[j - 1]);
            size_t best = smallest(above[j - 1] + (ca != cb), smallest(above[j], row[j - 1]) + 1);
            bool swapped = i > 1 && j > 1 && tolower((unsigned char)a[i - 2]) == cb &&
                           tolower((unsigned char)b[j - 2]) == ca;
            if (swapped) best = smallest(best, before[j - 2] + 1);
            row[j] = best;
        }
        size_t *recycled = before;
        before = above;
        above = row;
        row = recycled;
    }
    return above[m];
}

// Finds the name that scripts give now to what they called `word` before a rename.
static const char *find_renamed(const char *word, const char *const *candidates, size_t count) {
    static const char was[] = "lamp", is[] = "point_light"; // a part of several names
    const char *at = strstr(word, was);
    char name[WORD_CAP];
    if (!at || snprintf(name, sizeof name, "%.*s%s%s", (int)(at - word), word, is,
                        at + strlen(was)) >= WORD_CAP)
        return NULL;
    for (size_t i = 0; i < count; i++)
        if (strcmp(candidates[i], name) == 0) return candidates[i];
    return NULL;
}

const char *str_nearest(const char *word, const char *const *candidates, size_t count) {
    const char *nearest = find_renamed(word, candidates, count);
    if (nearest) return nearest;
    size_t length = strlen(word), best = (length + 2) / 3; // further away is another word
    if (best > 3) best = 3;
    for (size_t i = 0; i < count; i++) {
        size_t d = distance(word, candidates[i]);
        if (d < best || (d == best && !nearest)) {
            if (d >= strlen(candidates[i])) continue;
            nearest = candidates[i];
            best = d;
        }
    }
    return nearest;
}

void str_make_printable(char *text) {
    for (unsigned char *c = (unsigned char *)text; *c; c++) {
        bool ascii = *c < 0x20 || *c == 0x7f, kept = *c == '\n' || *c == '\t';
        if (ascii && !kept) *c = '?';
        if (*c == 0xc2 && c[1] >= 0x80 && c[1] <= 0x9f) c[0] = c[1] = '?';
    }
}

bool str_ends_with(const char *text, const char *ending) {
    size_t n = strlen(text), m = strlen(ending);
    return n >= m && memcmp(text + n - m, ending, m) == 0;
}

bool str_has_place(const char *text) {
    size_t n = strcspn(text, ":\n");
    if (n == 0 || text[n] != ':') return false;
    size_t digits = strspn(text + n + 1, "0123456789");
    return digits > 0 && text[n + 1 + digits] == ':';
}

bool str_is_identifier(const char *text) {
    if (!isalpha((unsigned char)text[0]) && text[0] != '_') return false;
    for (; *text; text++)
        if (!isalnum((unsigned char)*text) && *text != '_') return false;
    return true;
}

bool str_copy(char *out, size_t capacity, const char *text) {
    size_t length = strlen(text);
    bool fits = length < capacity;
    if (!fits) length = capacity - 1;
    memcpy(out, text, length);
    out[length] = '\0';
    return fits;
}
