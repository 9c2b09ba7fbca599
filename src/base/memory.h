// Heap memory that is never NULL: when the host has none left the program ends with one line.
#pragma once
#include <stddef.h>

void *mem_alloc(size_t size);               // zeroed; size 0 gives a unique pointer
void *mem_resize(void *block, size_t size); // new bytes are not zeroed
void mem_free(void *block);                 // NULL is fine
void *mem_copy(const void *data, size_t size);

// Grows `array` so that it holds at least `count` elements; `capacity` is updated. Amortised O(1).
#define MEM_RESERVE(array, count, capacity)                                                        \
    ((array) = mem_reserve((array), sizeof *(array), (count), &(capacity)))
void *mem_reserve(void *array, size_t element, size_t count, size_t *capacity);

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))
