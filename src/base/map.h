// A map from (pointer, number) to a number, for walks over expression graphs that must visit shared
// nodes once. A zero-initialised map is empty. Free it with map_free.
#pragma once
#include <stddef.h>
#include <stdint.h>

typedef struct map_entry {
    const void *key;
    uint32_t sub, value;
} map_entry;

typedef struct map {
    map_entry *entries; // open addressing; key NULL: free
    size_t count, capacity;
} map;

// Returns the value of a key, or NULL when there is none. `key` is not NULL. Valid until map_set.
uint32_t *map_find(const map *m, const void *key, uint32_t sub);
void map_set(map *m, const void *key, uint32_t sub, uint32_t value); // the key must be new
void map_free(map *m);
