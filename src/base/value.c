// Values: what is accepted, and how they are read and written as text.
#include "base/value.h"
#include "base/error.h"
#include "base/srgb.h"
#include "base/words.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// ---- range ------------------------------------------------------------------------------------

static bool has_range(const value_desc *d) {
    return (isfinite(d->min) || isfinite(d->max)) && (d->min != 0 || d->max != 0);
}

int value_find_wrong(const value_desc *d, const float *value, int count) {
    for (int i = 0; i < count; i++)
        if (!isfinite(value[i]) || (has_range(d) && !(value[i] >= d->min && value[i] <= d->max)))
            return i;
    return -1;
}

void value_range(const value_desc *d, char out[VALUE_RANGE]) {
    const char *unit = d->unit ? d->unit : "", *space = unit[0] ? " " : "";
    const double min = (double)d->min, max = (double)d->max;
    if (!has_range(d))
        snprintf(out, VALUE_RANGE, "any finite number%s%.32s", space, unit);
    else if (isfinite(min) && isfinite(max))
        snprintf(out, VALUE_RANGE, "%g to %g%s%.32s", min, max, space, unit);
    else if (isfinite(min))
        snprintf(out, VALUE_RANGE, "%g%s%.32s or more", min, space, unit);
    else
        snprintf(out, VALUE_RANGE, "%g%s%.32s or less", max, space, unit);
}

bool value_refuse(const value_desc *d, float wrong, const char *who, ...) {
    char range[VALUE_RANGE], name[192];
    va_list list;
    va_start(list, who);
    vsnprintf(name, sizeof name, who, list);
    va_end(list);
    value_range(d, range);
    return err_set("%s is %g; accepted: %s", name, (double)wrong, range);
}

// ---- from text --------------------------------------------------------------------------------

// Returns how many numbers the text holds, 0 when it is anything else.
static int parse_numbers(const char *text, float out[4]) {
    int count = 0;
    while (count < 4) {
        char *end;
        errno = 0;
        out[count] = str_float(text, &end);
        if (end == text || !isfinite(out[count])) return 0;
        count++;
        text = end + strspn(end, ", ");
        if (!*text) return count;
    }
    return 0;
}

int value_find_word(const value_desc *d, const char *text) {
    return words_find(d->words, d->word_count, text);
}

static bool refuse_text(const char *who, const char *text, const char *accepted) {
    return err_set("%s cannot be '%s'; accepted: %s", who, text, accepted);
}

static bool parse_word(const value_desc *d, const char *who, const char *text, float *out) {
    int word = value_find_word(d, text);
    *out = (float)word;
    if (word >= 0) return true;
    strbuf list = {0};
    words_print(d->words, d->word_count, &list);
    refuse_text(who, text, strbuf_text(&list));
    strbuf_free(&list);
    return false;
}

static bool parse_bool(const char *who, const char *text, float *out) {
    static const char *const words[] = {"false", "true", "off", "on", "no", "yes", "0", "1"};
    int index = words_find(words, sizeof words / sizeof *words, text);
    *out = (float)(index & 1);
    return index >= 0 || refuse_text(who, text, "true, false");
}

static bool parse_components(const value_desc *d, const char *who, const char *text, float out[4]) {
    static const char *const accepted[] = {"a number", "two numbers, as 1,0",
                                           "three numbers, as 1,0,2.5", "four numbers, as 1,0,0,2"};
    if (text[0] == '#' && d->components == 3)
        return value_parse_color(text, out) || err_prefix("%s: ", who);
    int count = parse_numbers(text, out);
    for (int i = 1; count == 1 && i < d->components; i++) out[i] = out[0];
    if (d->type == VALUE_WHOLE && (count != 1 || out[0] != rintf(out[0])))
        return refuse_text(who, text, "a whole number");
    if (count == 1 || count == d->components) return true;
    return refuse_text(who, text,
                       d->type == VALUE_COLOR ? "#rrggbb or three numbers, as 1,0.5,0.1"
                                              : accepted[d->components - 1]);
}

bool value_parse(const value_desc *d, const char *who, const char *text, float out[4]) {
    memset(out, 0, 4 * sizeof *out);
    if (d->type == VALUE_WORD) return parse_word(d, who, text, out);
    if (d->type == VALUE_BOOL) return parse_bool(who, text, out);
    if (!parse_components(d, who, text, out)) return false;
    int wrong = value_find_wrong(d, out, d->components);
    return wrong < 0 || value_refuse(d, out[wrong], "%s", who);
}

// ---- to text ----------------------------------------------------------------------------------

void value_print(const value_desc *d, const float value[4], strbuf *out) {
    char hex[8];
    if (d->type == VALUE_WORD) {
        strbuf_add(out, "%s", d->words[(size_t)value[0]]);
    } else if (d->type == VALUE_BOOL) {
        strbuf_add(out, "%s", value[0] != 0 ? "true" : "false");
    } else if (d->type == VALUE_COLOR && value_color_hex(value, hex)) {
        strbuf_add(out, "%s", hex);
    } else {
        for (int i = 0; i < d->components; i++) {
            if (i > 0) strbuf_add(out, ",");
            strbuf_add_float(out, value[i]);
        }
    }
}

static void show_words(const value_desc *d, size_t chosen, strbuf *out) {
    for (size_t i = 0; i < d->word_count; i++)
        strbuf_add(out, "%s%s%s", i ? " | " : "", d->words[i], i == chosen ? "*" : "");
}

void value_show(const value_desc *d, const char *name, const float *value, strbuf *out) {
    strbuf_add(out, "%s", name ? name : d->name);
    if (!value && d->form) strbuf_add(out, " = %s", d->form);
    if ((!value && d->form) || d->type == VALUE_OTHER) return;
    bool given = value || !d->required;
    if (!value) value = d->value;
    if (given) strbuf_add(out, " = ");
    if (d->type == VALUE_WORD) {
        show_words(d, (size_t)value[0], out);
    } else if (d->type == VALUE_BOOL) {
        strbuf_add(out, "%s", value[0] != 0 ? "true" : "false");
    } else {
        for (int i = 0; given && (i == 0 || i < d->components); i++)
            strbuf_add(out, "%s%g", i ? ", " : "", (double)value[i]);
        if (has_range(d)) strbuf_add(out, " [%g, %g]", (double)d->min, (double)d->max);
        if (d->unit[0]) strbuf_add(out, " %s", d->unit);
    }
}

// ---- colours ----------------------------------------------------------------------------------

static int digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

bool value_parse_color(const char *text, float out[4]) {
    size_t length = strlen(text);
    bool right = text[0] == '#' && (length == 4 || length == 7 || length == 9);
    for (size_t i = 1; right && i < length; i++) right = digit(text[i]) >= 0;
    if (!right)
        return err_set("'%.32s' is not a colour; accepted: \"#rgb\", \"#rrggbb\", \"#rrggbbaa\"",
                       text);
    float rgba[4] = {0, 0, 0, 1};
    int per = length == 4 ? 1 : 2;
    for (size_t i = 0; i < (length - 1) / (size_t)per; i++) {
        const char *at = text + 1 + i * (size_t)per;
        int value = per == 1 ? digit(at[0]) * 17 : digit(at[0]) * 16 + digit(at[1]);
        rgba[i] = (float)value / 255.0f;
    }
    for (int i = 0; i < 3; i++) out[i] = linear_from_srgb(rgba[i]);
    out[3] = rgba[3];
    return true;
}

bool value_color_hex(const float linear[3], char out[8]) {
    static const char digits[] = "0123456789abcdef";
    out[0] = '#';
    out[7] = '\0';
    for (int i = 0; i < 3; i++) {
        float v = linear[i];
        if (!(v >= 0 && v <= 1)) return false;
        float encoded = srgb_from_linear(v);
        long byte = lrintf(encoded * 255);
        if (linear_from_srgb((float)byte / 255.0f) != v) return false;
        out[1 + 2 * i] = digits[byte >> 4];
        out[2 + 2 * i] = digits[byte & 15];
    }
    return true;
}
