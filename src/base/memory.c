// The reserve lies among the zeros of the program, which take no memory until they are touched. It
// is a list of chunks that fill it from end to end: the first free one that is large enough is
// taken, and neighbours that are free are one.
#include "base/memory.h"
#include "base/error.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { ALIGN = 16, RESERVE = 8 << 20 };

typedef struct chunk { // then its bytes
    size_t size;       // of these
    bool taken;
} chunk;
_Static_assert(sizeof(chunk) == ALIGN, "chunks are aligned");

static _Alignas(ALIGN) unsigned char reserve[RESERVE];
static pthread_mutex_t reserve_lock = PTHREAD_MUTEX_INITIALIZER;
static mem_heap heap;
static atomic_size_t blocks;

static atomic_uint elsewhere; // how often memory was short on threads that were in no call
static _Thread_local struct {
    unsigned depth, seen; // of nested calls; `elsewhere` at the beginning
    size_t wanted;        // bytes that were not there; 0: none
} call;

// ---- the reserve ------------------------------------------------------------------------------

static chunk *chunk_after(chunk *c) { // NULL: none
    unsigned char *end = (unsigned char *)(c + 1) + c->size;
    return end < reserve + RESERVE ? (chunk *)end : NULL;
}

static chunk *first_chunk(void) {
    chunk *first = (chunk *)reserve;
    if (!first->size) first->size = RESERVE - sizeof *first;
    return first;
}

static void chunk_cut(chunk *c, size_t size) { // what is left becomes a free chunk
    if (c->size < size + 2 * sizeof *c) return;
    chunk *rest = (chunk *)((unsigned char *)(c + 1) + size);
    *rest = (chunk){.size = c->size - size - sizeof *rest};
    c->size = size;
}

static void join_free(void) {
    for (chunk *c = first_chunk(), *next; (next = chunk_after(c)) != NULL;) {
        if (c->taken || next->taken)
            c = next;
        else
            c->size += sizeof *next + next->size;
    }
}

static void *reserve_take(size_t size) {
    size = (size + ALIGN - 1) & ~(size_t)(ALIGN - 1);
    pthread_mutex_lock(&reserve_lock);
    chunk *c = first_chunk();
    while (c && (c->taken || c->size < size)) c = chunk_after(c);
    if (c) chunk_cut(c, size);
    if (c) c->taken = true;
    pthread_mutex_unlock(&reserve_lock);
    return c ? c + 1 : NULL;
}

static bool is_of_reserve(const void *block) {
    const unsigned char *at = block;
    return at >= reserve && at < reserve + RESERVE;
}

static void reserve_give(void *block) {
    pthread_mutex_lock(&reserve_lock);
    ((chunk *)block - 1)->taken = false;
    join_free();
    pthread_mutex_unlock(&reserve_lock);
}

// ---- calls ------------------------------------------------------------------------------------

void mem_enter(void) {
    if (call.depth++ > 0) return;
    call.wanted = 0;
    call.seen = atomic_load(&elsewhere);
}

bool mem_is_short(void) {
    return call.depth > 0 && (call.wanted || atomic_load(&elsewhere) != call.seen);
}

bool mem_leave(bool done) {
    bool is_short = mem_is_short();
    call.depth--;
    if (!is_short) return done;
    return call.wanted ? err_no_memory(call.wanted) : err_set("out of memory");
}

// Ends the program where that is wanted, or where the reserve has not as much either.
static void *take_reserve(size_t size) {
    if (err_leaves_at_once()) err_out_of_memory(size);
    if (call.depth > 0)
        call.wanted = size ? size : 1;
    else
        atomic_fetch_add(&elsewhere, 1);
    void *block = size < RESERVE ? reserve_take(size ? size : 1) : NULL;
    if (!block) err_out_of_memory(size);
    return block;
}

// ---- blocks -----------------------------------------------------------------------------------

bool mem_set_heap(mem_heap wanted) {
    if (wanted.allocate == heap.allocate && wanted.user == heap.user) return true;
    if (atomic_load(&blocks))
        return err_set("an allocator can be set while nothing is allocated: before the first call, "
                       "or when all that was made is destroyed");
    heap = wanted;
    return true;
}

size_t mem_blocks(void) {
    return atomic_load(&blocks);
}

void *mem_try(void *block, size_t size) {
    if (!size) size = 1;
    void *given = heap.allocate ? heap.allocate(heap.user, block, size) : realloc(block, size);
    if (given && !block) atomic_fetch_add_explicit(&blocks, 1, memory_order_relaxed);
    return given;
}

static void *try_zeroed(size_t size) {
    if (heap.allocate) {
        void *block = mem_try(NULL, size);
        return block ? memset(block, 0, size) : NULL;
    }
    void *block = calloc(1, size ? size : 1);
    if (block) atomic_fetch_add_explicit(&blocks, 1, memory_order_relaxed);
    return block;
}

void *mem_alloc(size_t size) {
    void *block = try_zeroed(size);
    return block ? block : memset(take_reserve(size), 0, size);
}

void *mem_resize(void *block, size_t old, size_t size) {
    void *given = block && is_of_reserve(block) ? NULL : mem_try(block, size);
    if (given) return given;
    given = block && is_of_reserve(block) ? mem_alloc(size) : take_reserve(size);
    if (block) memcpy(given, block, old < size ? old : size);
    mem_free(block);
    return given;
}

void mem_free(void *block) {
    if (!block) return;
    if (is_of_reserve(block)) {
        reserve_give(block);
        return;
    }
    atomic_fetch_sub_explicit(&blocks, 1, memory_order_relaxed);
    if (heap.allocate)
        heap.allocate(heap.user, block, 0);
    else
        free(block);
}

void *mem_copy(const void *data, size_t size) {
    void *block = mem_alloc(size);
    if (size) memcpy(block, data, size);
    return block;
}

void *mem_reserve(void *array, size_t element, size_t count, size_t *capacity) {
    if (count <= *capacity) return array;
    size_t old = *capacity, grown = old ? old * 2 : 8;
    if (grown < count) grown = count;
    if (grown > SIZE_MAX / element) err_out_of_memory(SIZE_MAX);
    *capacity = grown;
    return mem_resize(array, old * element, grown * element);
}
