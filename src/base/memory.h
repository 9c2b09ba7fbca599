// Heap memory. Any thread.
//
// Out of memory is an error of the library's call, and yet these functions never return NULL. What
// the heap has not is taken from a reserve, with which the call ends what it has begun: it is
// noted, work that takes long stops at its next look at the time limit (base/time_limit.h), and in
// the end the call fails, with its object destroyed if it was to make one. What is large is asked
// for before, through a budget (base/budget.h) or mem_try, and is refused as a value.
#pragma once
#include <stdbool.h>
#include <stddef.h>

void *mem_alloc(size_t size);                           // zeroed; size 0 gives a unique pointer
void *mem_resize(void *block, size_t old, size_t size); // new bytes are not zeroed
void mem_free(void *block);                             // NULL is allowed
void *mem_copy(const void *data, size_t size);
// As realloc, of blocks that mem_try gave (NULL: a new one, not zeroed): NULL when there is no
// memory, and the block is as it was. Notes nothing.
void *mem_try(void *block, size_t size);

// Grows `array` to hold at least `count` elements and updates `capacity`. Amortised O(1).
#define MEM_RESERVE(array, count, capacity)                                                        \
    ((array) = mem_reserve((array), sizeof *(array), (count), &(capacity)))
// Adds an element, to which it returns a pointer: *MEM_ADD(list, count, capacity) = value. `value`
// is not of the array itself, which may be moved before or after it is read.
#define MEM_ADD(array, count, capacity)                                                            \
    (MEM_RESERVE(array, (count) + 1, capacity), &(array)[(count)++])
void *mem_reserve(void *array, size_t element, size_t count, size_t *capacity);

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

// ---- a call of the library, or a job of one of its threads ------------------------------------

void mem_enter(void); // calls may be nested; of them the outermost counts
// Ends what mem_enter began. Returns `done`, or false with a message when memory was short: on this
// thread, or on one that works for calls.
bool mem_leave(bool done);
bool mem_is_short(void); // within a call: it will fail
// A call that does no more than `done` says.
#define MEM_CALL(done) (mem_enter(), mem_leave(done))

// ---- where it comes from ------------------------------------------------------------------------

typedef struct mem_heap { // zero: that of the C library
    // As realloc, but frees at size 0. Blocks are aligned to 16 bytes. NULL: there is no memory.
    void *(*allocate)(void *user, void *block, size_t size);
    void *user;
} mem_heap;
// Sets where all memory comes from. False with a message while there are blocks of another heap.
bool mem_set_heap(mem_heap heap);
size_t mem_blocks(void); // that were not freed
