// Best fit over a list of spans in order of offset, with coalescing.
//
// Invariant: the spans tile [0, size) without gap or overlap, and no two free spans are neighbours.
// A block of device memory holds tens of objects, so the walk over all spans is shorter than the
// driver call that it saves.
#include "gpu/allocator.h"
#include "base/memory.h"
#include <assert.h>
#include <string.h>

static uint32_t span_new(allocator *a) {
    if (a->spare != ALLOCATOR_NONE) {
        uint32_t index = a->spare;
        a->spare = a->spans[index].next;
        return index;
    }
    MEM_RESERVE(a->spans, a->count + 1, a->capacity);
    return (uint32_t)a->count++;
}

static void span_drop(allocator *a, uint32_t index) {
    a->spans[index].next = a->spare;
    a->spare = index;
}

// Cuts `at` bytes off the front of a span; the rest becomes a new span behind it.
static void span_split(allocator *a, uint32_t index, uint64_t at) {
    uint32_t rest = span_new(a);
    allocator_span *front = &a->spans[index];
    a->spans[rest] = (allocator_span){.offset = front->offset + at,
                                      .size = front->size - at,
                                      .previous = index,
                                      .next = front->next};
    if (front->next != ALLOCATOR_NONE) a->spans[front->next].previous = rest;
    front->next = rest;
    front->size = at;
}

// Appends the span behind `index` to it.
static void span_join(allocator *a, uint32_t index) {
    uint32_t gone = a->spans[index].next;
    a->spans[index].size += a->spans[gone].size;
    a->spans[index].next = a->spans[gone].next;
    if (a->spans[gone].next != ALLOCATOR_NONE) a->spans[a->spans[gone].next].previous = index;
    span_drop(a, gone);
}

void allocator_init(allocator *a, uint64_t size) {
    assert(size > 0);
    *a = (allocator){.size = size, .spare = ALLOCATOR_NONE};
    a->first = span_new(a);
    a->spans[a->first] =
        (allocator_span){.size = size, .previous = ALLOCATOR_NONE, .next = ALLOCATOR_NONE};
}

void allocator_deinit(allocator *a) {
    mem_free(a->spans);
    memset(a, 0, sizeof *a);
}

static uint64_t padding(uint64_t offset, uint64_t alignment) {
    return (alignment - (offset & (alignment - 1))) & (alignment - 1);
}

bool allocator_alloc(allocator *a, uint64_t size, uint64_t alignment, allocator_place *out) {
    assert(size > 0 && alignment > 0 && (alignment & (alignment - 1)) == 0);
    uint32_t best = ALLOCATOR_NONE;
    for (uint32_t i = a->first; i != ALLOCATOR_NONE; i = a->spans[i].next) {
        const allocator_span *s = &a->spans[i];
        if (s->taken) continue;
        uint64_t pad = padding(s->offset, alignment);
        if (pad > s->size || size > s->size - pad) continue;
        if (best == ALLOCATOR_NONE || s->size < a->spans[best].size) best = i;
    }
    if (best == ALLOCATOR_NONE) return false;

    uint64_t pad = padding(a->spans[best].offset, alignment);
    if (pad > 0) {
        span_split(a, best, pad);
        best = a->spans[best].next;
    }
    if (a->spans[best].size > size) span_split(a, best, size);
    a->spans[best].taken = true;
    a->used += size;
    *out = (allocator_place){.offset = a->spans[best].offset, .span = best};
    return true;
}

void allocator_free(allocator *a, uint32_t span) {
    assert(span < a->count && a->spans[span].taken);
    a->spans[span].taken = false;
    a->used -= a->spans[span].size;
    uint32_t next = a->spans[span].next, previous = a->spans[span].previous;
    if (next != ALLOCATOR_NONE && !a->spans[next].taken) span_join(a, span);
    if (previous != ALLOCATOR_NONE && !a->spans[previous].taken) span_join(a, previous);
}

uint64_t allocator_largest_hole(const allocator *a) {
    uint64_t largest = 0;
    for (uint32_t i = a->first; i != ALLOCATOR_NONE; i = a->spans[i].next) {
        if (!a->spans[i].taken && a->spans[i].size > largest) largest = a->spans[i].size;
    }
    return largest;
}
