// Copies the changed parts of an array on the host to a buffer.
#pragma once
#include "gpu/gpu.h"

enum { RUN_BLOCK = 16 }; // elements per mark

// Returns how many marks an array of `count` elements needs.
static inline size_t run_marks(size_t count) {
    return (count + RUN_BLOCK - 1) / RUN_BLOCK;
}

static inline void run_mark(uint8_t *marks, size_t element) {
    marks[element / RUN_BLOCK] = 1;
}

// Copies the marked elements and clears the marks. Short gaps are copied too, to make fewer copies.
bool runs_write(gpu *g, gpu_buffer *buffer, uint64_t offset, const void *array, size_t element,
                size_t count, uint8_t *marks);
