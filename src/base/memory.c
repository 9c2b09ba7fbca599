#include "base/memory.h"
#include "base/error.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

void *mem_alloc(size_t size) {
    void *block = calloc(1, size ? size : 1);
    if (!block) err_out_of_memory(size);
    return block;
}

void *mem_resize(void *block, size_t size) {
    void *resized = realloc(block, size ? size : 1);
    if (!resized) err_out_of_memory(size);
    return resized;
}

void mem_free(void *block) {
    free(block);
}

void *mem_copy(const void *data, size_t size) {
    void *block = mem_alloc(size);
    if (size) memcpy(block, data, size);
    return block;
}

void *mem_reserve(void *array, size_t element, size_t count, size_t *capacity) {
    if (count <= *capacity) return array;
    size_t grown = *capacity ? *capacity * 2 : 8;
    if (grown < count) grown = count;
    if (grown > SIZE_MAX / element) err_out_of_memory(SIZE_MAX);
    *capacity = grown;
    return mem_resize(array, grown * element);
}
