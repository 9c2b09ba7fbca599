// An array on the host and the same in a buffer, of which a part has changed.
#pragma once
#include "gpu/gpu.h"

enum { RUN_BLOCK = 16 }; // elements that one mark stands for

// Marks that an array of so many elements takes.
static inline size_t run_marks(size_t count) {
    return (count + RUN_BLOCK - 1) / RUN_BLOCK;
}

static inline void run_mark(uint8_t *marks, size_t element) {
    marks[element / RUN_BLOCK] = 1;
}

// Writes what is marked, in as few copies as leave out what is worth it, and takes the marks away.
bool runs_write(gpu *g, gpu_buffer *buffer, uint64_t offset, const void *array, size_t element,
                size_t count, uint8_t *marks);
