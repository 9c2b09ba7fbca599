// Lists of words that are accepted, and what to say about another one.
#pragma once
#include "base/str.h"

int words_find(const char *const *words, size_t count, const char *word); // -1: it is none of them
void words_print(const char *const *words, size_t count, strbuf *out);    // "a, b, c"
// Sets the message "BEGIN; did you mean 'WORD'?" with the nearest word, else "BEGIN; OTHERWISE".
// `otherwise` NULL: "accepted: a, b, c". Always returns false.
bool words_refuse(const char *const *words, size_t count, const char *word, const char *otherwise,
                  const char *begin, ...) PRINTF_LIKE(5, 6);
