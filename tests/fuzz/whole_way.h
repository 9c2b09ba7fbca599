// For inputs that go the whole way, as files and through the reader, whose crash is a message here.
#pragma once
#include "base/error.h"
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

// Whether a message may hold this word because the input does: nothing can be told of such a one.
static inline bool fuzz_has_word_of_crash(const uint8_t *data, size_t size) {
    return memmem(data, size, "crashed", 7);
}

// Not by file_write: it need not reach the disk.
static inline void fuzz_write(const char *path, const void *data, size_t size) {
    FILE *f = fopen(path, "wb");
    if (!f || (size && fwrite(data, 1, size, f) != size) || fclose(f) != 0) __builtin_trap();
}

// Of what was refused.
static inline void fuzz_expect_message(void) {
    if (!err_get()[0] || strstr(err_get(), "crashed")) __builtin_trap();
}
