#include "base/shelf.h"
#include "base/hash.h"
#include "base/memory.h"
#include <pthread.h>
#include <string.h>
#include <sys/stat.h>

typedef struct stamp { // of a file: differs once it is written or another takes its place
    const char *path;
    struct stat info;
} stamp;

typedef struct entry {
    shelf_item item; // first: an item's address is its entry's
    const char *key;
    uint64_t hash;
    stamp *stamps;
    size_t stamp_count, holders;
    bool stale; // of files that may have changed while they were read
    struct entry *next;
} entry;

enum { BUCKETS = 1024 };

struct shelf {
    pthread_mutex_t lock;
    entry *buckets[BUCKETS];
};

shelf *shelf_create(void) {
    shelf *s = mem_alloc(sizeof *s);
    pthread_mutex_init(&s->lock, NULL);
    return s;
}

void shelf_destroy(shelf *s) {
    if (!s) return;
    pthread_mutex_destroy(&s->lock);
    mem_free(s);
}

static bool is_same(const struct stat *a, const struct stat *b) {
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino && a->st_size == b->st_size &&
           a->st_mtim.tv_sec == b->st_mtim.tv_sec && a->st_mtim.tv_nsec == b->st_mtim.tv_nsec &&
           a->st_ctim.tv_sec == b->st_ctim.tv_sec && a->st_ctim.tv_nsec == b->st_ctim.tv_nsec;
}

static bool is_current(const entry *e) {
    if (e->stale) return false;
    for (size_t i = 0; i < e->stamp_count; i++) {
        struct stat info;
        if (stat(e->stamps[i].path, &info) != 0 || !is_same(&info, &e->stamps[i].info))
            return false;
    }
    return true;
}

shelf_item *shelf_take(shelf *s, const char *key) {
    uint64_t hash = hash64(key, strlen(key));
    entry *found = NULL;
    pthread_mutex_lock(&s->lock);
    for (entry *e = s->buckets[hash % BUCKETS]; e && !found; e = e->next)
        if (e->hash == hash && strcmp(e->key, key) == 0 && is_current(e)) found = e;
    if (found) found->holders++;
    pthread_mutex_unlock(&s->lock);
    return found ? &found->item : NULL;
}

static void stamp_files(entry *e, const char *const *files, size_t count, int64_t begin) {
    e->stamps = arena_alloc(&e->item.memory, count * sizeof *e->stamps);
    e->stamp_count = count;
    for (size_t i = 0; i < count; i++) {
        stamp *at = &e->stamps[i];
        at->path = arena_string(&e->item.memory, files[i]);
        if (stat(files[i], &at->info) != 0 || file_changed_ns(files[i]) >= begin) e->stale = true;
    }
}

shelf_item *shelf_put(shelf *s, const char *key, const void *data, arena memory,
                      const char *const *files, size_t file_count, int64_t begin) {
    entry *e = mem_alloc(sizeof *e);
    e->item = (shelf_item){data, memory};
    e->key = arena_string(&e->item.memory, key);
    e->hash = hash64(key, strlen(key));
    e->holders = 1;
    stamp_files(e, files, file_count, begin);
    entry **bucket = &s->buckets[e->hash % BUCKETS];
    pthread_mutex_lock(&s->lock);
    e->next = *bucket;
    *bucket = e;
    pthread_mutex_unlock(&s->lock);
    return &e->item;
}

void shelf_release(shelf *s, shelf_item *item) {
    if (!item) return;
    entry *e = (entry *)item;
    pthread_mutex_lock(&s->lock);
    bool last = --e->holders == 0;
    entry **at = &s->buckets[e->hash % BUCKETS];
    while (last && *at != e) at = &(*at)->next;
    if (last) *at = e->next;
    pthread_mutex_unlock(&s->lock);
    if (!last) return;
    arena_free(&e->item.memory);
    mem_free(e);
}
