// Exchanging values.
#pragma once
#include <stddef.h>

// Of two variables of one type, arrays too.
#define SWAP(a, b) swap_bytes(&(a), &(b), sizeof(a))

static inline void swap_bytes(void *a, void *b, size_t size) {
    unsigned char *x = a, *y = b;
    for (size_t i = 0; i < size; i++) {
        const unsigned char was = x[i];
        x[i] = y[i];
        y[i] = was;
    }
}
