// A set of byte strings, numbered in order of addition and found by hash. The caller owns the keys.
#pragma once
#include <stddef.h>
#include <stdint.h>

typedef struct lookup_entry {
    const void *key;
    size_t size;
    uint64_t hash;
    uint32_t next; // in the same bucket
} lookup_entry;

typedef struct lookup { // zero-initialised: empty
    lookup_entry *entries;
    uint32_t *buckets;
    size_t count, capacity, bucket_count;
} lookup;

uint32_t lookup_find(const lookup *l, const void *key, size_t size); // UINT32_MAX when absent
uint32_t lookup_add(lookup *l, const void *key, size_t size); // returns its number; must be absent
void lookup_free(lookup *l);
