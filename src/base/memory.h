// Heap memory. The functions never return NULL: when the host has no memory left, the process ends
// with one line on stderr. Any thread.
#pragma once
#include <stddef.h>

void *mem_alloc(size_t size);               // zeroed; size 0 gives a unique pointer
void *mem_resize(void *block, size_t size); // new bytes are not zeroed
void mem_free(void *block);                 // NULL is allowed
void *mem_copy(const void *data, size_t size);

// Grows `array` to hold at least `count` elements and updates `capacity`. Amortised O(1).
#define MEM_RESERVE(array, count, capacity)                                                        \
    ((array) = mem_reserve((array), sizeof *(array), (count), &(capacity)))
void *mem_reserve(void *array, size_t element, size_t count, size_t *capacity);

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))
