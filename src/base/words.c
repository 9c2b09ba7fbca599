#include "base/words.h"
#include "base/error.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { BEGIN_CAP = 8192 };

int words_find(const char *const *words, size_t count, const char *word) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(words[i], word) == 0) return (int)i;
    return -1;
}

void words_print(const char *const *words, size_t count, strbuf *out) {
    for (size_t i = 0; i < count; i++) strbuf_add(out, "%s%s", i ? ", " : "", words[i]);
}

bool words_refuse(const char *const *words, size_t count, const char *word, const char *otherwise,
                  const char *begin, ...) {
    char text[BEGIN_CAP];
    va_list args;
    va_start(args, begin);
    vsnprintf(text, sizeof text, begin, args);
    va_end(args);
    const char *near = str_nearest(word, words, count);
    if (near) return err_set("%s; did you mean '%s'?", text, near);
    if (otherwise) return err_set("%s; %s", text, otherwise);
    strbuf list = {0};
    words_print(words, count, &list);
    err_set("%s; accepted: %s", text, strbuf_text(&list));
    strbuf_free(&list);
    return false;
}
