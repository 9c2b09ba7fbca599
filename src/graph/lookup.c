// A hash table with chains. The number of buckets doubles when there are as many entries, so that
// chains stay short.
#include "graph/lookup.h"
#include "base/hash.h"
#include "base/memory.h"
#include <assert.h>
#include <string.h>

#define NONE UINT32_MAX

static void link_entry(lookup *l, uint32_t number) {
    uint32_t *bucket = &l->buckets[l->entries[number].hash & (l->bucket_count - 1)];
    l->entries[number].next = *bucket;
    *bucket = number;
}

static void lookup_grow(lookup *l) {
    mem_free(l->buckets);
    l->bucket_count = l->bucket_count ? l->bucket_count * 2 : 16;
    l->buckets = mem_alloc(l->bucket_count * sizeof *l->buckets);
    memset(l->buckets, 0xff, l->bucket_count * sizeof *l->buckets);
    for (size_t i = 0; i < l->count; i++) link_entry(l, (uint32_t)i);
}

uint32_t lookup_find(const lookup *l, const void *key, size_t size) {
    if (l->bucket_count == 0) return NONE;
    uint64_t hash = hash64(key, size);
    uint32_t i = l->buckets[hash & (l->bucket_count - 1)];
    for (; i != NONE; i = l->entries[i].next) {
        const lookup_entry *e = &l->entries[i];
        if (e->hash == hash && e->size == size && memcmp(e->key, key, size) == 0) break;
    }
    return i;
}

uint32_t lookup_add(lookup *l, const void *key, size_t size) {
    assert(lookup_find(l, key, size) == NONE);
    assert(l->count < NONE);
    if (l->count == l->bucket_count) lookup_grow(l);
    MEM_RESERVE(l->entries, l->count + 1, l->capacity);
    uint32_t number = (uint32_t)l->count++;
    l->entries[number] = (lookup_entry){.key = key, .size = size, .hash = hash64(key, size)};
    link_entry(l, number);
    return number;
}

void lookup_free(lookup *l) {
    mem_free(l->entries);
    mem_free(l->buckets);
    *l = (lookup){0};
}
