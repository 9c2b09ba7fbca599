#include "base/content_cache.h"
#include "base/hash.h"
#include "base/memory.h"
#include <pthread.h>
#include <string.h>

typedef struct entry {
    content_cache_item item; // first: an item's address is its entry's
    const char *key;
    uint64_t hash;
    const char **files;
    file_stamp *stamps;
    size_t file_count, holders;
    struct entry *next;
} entry;

enum { BUCKETS = 1024 };

struct content_cache {
    pthread_mutex_t lock;
    entry *buckets[BUCKETS];
};

content_cache *content_cache_create(void) {
    content_cache *c = mem_alloc(sizeof *c);
    pthread_mutex_init(&c->lock, NULL);
    return c;
}

void content_cache_destroy(content_cache *c) {
    if (!c) return;
    pthread_mutex_destroy(&c->lock);
    mem_free(c);
}

static bool is_current(const entry *e) {
    for (size_t i = 0; i < e->file_count; i++)
        if (!file_stamp_holds(&e->stamps[i], e->files[i])) return false;
    return true;
}

content_cache_item *content_cache_take(content_cache *c, const char *key) {
    uint64_t hash = hash64(key, strlen(key));
    entry *found = NULL;
    pthread_mutex_lock(&c->lock);
    for (entry *e = c->buckets[hash % BUCKETS]; e && !found; e = e->next)
        if (e->hash == hash && strcmp(e->key, key) == 0 && is_current(e)) found = e;
    if (found) found->holders++;
    pthread_mutex_unlock(&c->lock);
    return found ? &found->item : NULL;
}

static void stamp_files(entry *e, const char *const *files, size_t count, int64_t begin) {
    e->stamps = arena_alloc(&e->item.memory, count * sizeof *e->stamps);
    e->files = arena_alloc(&e->item.memory, count * sizeof *e->files);
    e->file_count = count;
    for (size_t i = 0; i < count; i++) {
        e->files[i] = arena_string(&e->item.memory, files[i]);
        e->stamps[i] = file_stamp_of(files[i], begin);
    }
}

content_cache_item *content_cache_put(content_cache *c, const char *key, const void *data,
                                      arena memory, const char *const *files, size_t file_count,
                                      int64_t begin) {
    entry *e = mem_alloc(sizeof *e);
    e->item = (content_cache_item){data, memory};
    e->key = arena_string(&e->item.memory, key);
    e->hash = hash64(key, strlen(key));
    e->holders = 1;
    stamp_files(e, files, file_count, begin);
    entry **bucket = &c->buckets[e->hash % BUCKETS];
    pthread_mutex_lock(&c->lock);
    e->next = *bucket;
    *bucket = e;
    pthread_mutex_unlock(&c->lock);
    return &e->item;
}

void content_cache_release(content_cache *c, content_cache_item *item) {
    if (!item) return;
    entry *e = (entry *)item;
    pthread_mutex_lock(&c->lock);
    bool last = --e->holders == 0;
    entry **at = &c->buckets[e->hash % BUCKETS];
    while (last && *at != e) at = &(*at)->next;
    if (last) *at = e->next;
    pthread_mutex_unlock(&c->lock);
    if (!last) return;
    arena_free(&e->item.memory);
    mem_free(e);
}
