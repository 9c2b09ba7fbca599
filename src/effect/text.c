// Values as text: what `--set`, presets and the panel say, and what is said back.
#include "base/error.h"
#include "base/str.h"
#include "effect/effect_impl.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

int text_numbers(const char *text, float out[4]) {
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

int text_word(const char *const *words, size_t count, const char *text) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(words[i], text) == 0) return (int)i;
    return -1;
}

bool text_bool(const char *text, float *out) {
    static const char *const words[] = {"false", "true", "off", "on", "no", "yes", "0", "1"};
    int index = text_word(words, sizeof words / sizeof *words, text);
    if (index < 0) return false;
    *out = (float)(index & 1);
    return true;
}

bool text_wrong(const char *name, const char *text, const char *accepted) {
    return err_set("'%s' cannot be '%s'; accepted: %s", name, text, accepted);
}

bool text_wrong_word(const char *name, const char *text, const char *const *words, size_t count) {
    strbuf list = {0};
    for (size_t i = 0; i < count; i++) strbuf_add(&list, "%s%s", i ? ", " : "", words[i]);
    text_wrong(name, text, strbuf_text(&list));
    strbuf_free(&list);
    return false;
}

void text_add_numbers(strbuf *out, const float *value, int count) {
    for (int i = 0; i < count; i++) {
        if (i > 0) strbuf_add(out, ",");
        strbuf_add_float(out, value[i]);
    }
}

void text_add_color(strbuf *out, const float value[3]) {
    char hex[8];
    if (palette_color_hex(value, hex))
        strbuf_add(out, "%s", hex);
    else
        text_add_numbers(out, value, 3);
}
