// Open addressing with linear probing, at most half full; the capacity is a power of two.
#include "base/map.h"
#include "base/memory.h"
#include <assert.h>
#include <string.h>

static size_t map_place(const map *m, const void *key, uint32_t sub) {
    uint64_t h = ((uint64_t)(uintptr_t)key ^ (uint64_t)sub << 48 ^ sub) * 0x9e3779b97f4a7c15u;
    size_t i = (size_t)(h >> 20) & (m->capacity - 1);
    while (m->entries[i].key && (m->entries[i].key != key || m->entries[i].sub != sub))
        i = (i + 1) & (m->capacity - 1);
    return i;
}

uint32_t *map_find(const map *m, const void *key, uint32_t sub) {
    if (m->capacity == 0) return NULL;
    map_entry *entry = &m->entries[map_place(m, key, sub)];
    return entry->key ? &entry->value : NULL;
}

void map_set(map *m, const void *key, uint32_t sub, uint32_t value) {
    assert(key && !map_find(m, key, sub));
    if (2 * (m->count + 1) > m->capacity) {
        map grown = {.capacity = m->capacity ? 2 * m->capacity : 64};
        grown.entries = mem_alloc(grown.capacity * sizeof *grown.entries);
        for (size_t i = 0; i < m->capacity; i++) {
            const map_entry *old = &m->entries[i];
            if (old->key) grown.entries[map_place(&grown, old->key, old->sub)] = *old;
        }
        grown.count = m->count;
        map_free(m);
        *m = grown;
    }
    m->entries[map_place(m, key, sub)] = (map_entry){key, sub, value};
    m->count++;
}

void map_free(map *m) {
    mem_free(m->entries);
    memset(m, 0, sizeof *m);
}
