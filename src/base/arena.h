// Arenas allocate objects that are freed together (at the end of a load, of a frame). Objects never
// move. Any thread may allocate; only the owner may call arena_free.
#pragma once
#include "base/error.h"
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct arena_block arena_block;
typedef struct arena {
    arena_block *block; // newest block first; zero-initialised is an empty arena
    size_t held;        // bytes of all blocks
    bool taken;         // a spin lock: allocating takes less time than waking a thread
} arena;

void *arena_alloc(arena *a, size_t size); // zeroed, aligned to 16
char *arena_string(arena *a, const char *text);
char *arena_format(arena *a, const char *format, ...) PRINTF_LIKE(2, 3);
void *arena_copy(arena *a, const void *data, size_t size);
void arena_free(arena *a); // frees all objects; the arena is empty again
