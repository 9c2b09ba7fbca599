// Places in a range of bytes: which offsets are taken. Knows no memory and no device.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct allocator_span {
    uint64_t offset, size;
    uint32_t previous, next; // neighbours by offset; ALLOCATOR_NONE at the ends
    bool taken;
} allocator_span;

enum { ALLOCATOR_NONE = UINT32_MAX };

typedef struct allocator {
    uint64_t size, used;
    allocator_span *spans;
    size_t count, capacity; // of `spans`, dead ones included
    uint32_t first, spare;  // first span by offset; chain of dead spans through `next`
} allocator;

typedef struct allocator_place {
    uint64_t offset;
    uint32_t span; // what allocator_free wants
} allocator_place;

void allocator_init(allocator *a, uint64_t size); // size > 0
void allocator_deinit(allocator *a);
// `alignment` is a power of two, `size` > 0. False, nothing changed, when no hole is large enough.
bool allocator_alloc(allocator *a, uint64_t size, uint64_t alignment, allocator_place *out);
void allocator_free(allocator *a, uint32_t span);
uint64_t allocator_largest_hole(const allocator *a);
