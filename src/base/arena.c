// A chain of blocks; each object is carved from the newest one. Objects larger than a block get a
// block of their own, put behind the newest so that its free space stays in use.
#include "base/arena.h"
#include "base/memory.h"
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { BLOCK_SIZE = 64 * 1024, ALIGN = 16 };

struct arena_block {
    arena_block *next;
    size_t used, size;
    _Alignas(ALIGN) unsigned char data[];
};

static arena_block *block_create(arena *a, size_t size) {
    arena_block *block = mem_alloc(sizeof *block + size); // zeroed
    a->held += sizeof *block + size;
    block->size = size;
    return block;
}

static void *arena_carve(arena *a, size_t size) {
    if (size > BLOCK_SIZE / 4) {
        arena_block *own = block_create(a, size);
        own->used = size;
        if (a->block) {
            own->next = a->block->next;
            a->block->next = own;
        } else {
            a->block = own;
        }
        return own->data;
    }
    if (!a->block || a->block->size - a->block->used < size) {
        arena_block *block = block_create(a, BLOCK_SIZE);
        block->next = a->block;
        a->block = block;
    }
    void *object = a->block->data + a->block->used;
    a->block->used += size;
    return object;
}

void *arena_alloc(arena *a, size_t size) {
    if (size > SIZE_MAX / 2) err_out_of_memory(size);
    while (__atomic_exchange_n(&a->taken, true, __ATOMIC_ACQUIRE)) sched_yield();
    void *object = arena_carve(a, (size + ALIGN - 1) & ~(size_t)(ALIGN - 1));
    __atomic_store_n(&a->taken, false, __ATOMIC_RELEASE);
    return object;
}

void *arena_copy(arena *a, const void *data, size_t size) {
    void *copy = arena_alloc(a, size);
    if (size) memcpy(copy, data, size);
    return copy;
}

char *arena_string(arena *a, const char *text) {
    return arena_copy(a, text, strlen(text) + 1);
}

char *arena_format(arena *a, const char *format, ...) {
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    int length = vsnprintf(NULL, 0, format, args);
    va_end(args);
    char *text = arena_alloc(a, (size_t)length + 1);
    vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    return text;
}

void arena_free(arena *a) {
    for (arena_block *block = a->block; block;) {
        arena_block *next = block->next;
        mem_free(block);
        block = next;
    }
    a->block = NULL;
    a->held = 0;
}
