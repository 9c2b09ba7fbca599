// Content made from files, shared by all that need it at the same time. Each item counts its
// holders and is freed with the last of them. A reload holds what it shares with the load before
// it, so that costly content is not made twice and old content is not kept. Any thread may call
// these functions, except content_cache_destroy.
#pragma once
#include "base/arena.h"
#include "base/file.h"

typedef struct content_cache content_cache;
typedef struct content_cache_item {
    const void *data;
    arena memory; // holds the data
} content_cache_item;

content_cache *content_cache_create(void);
// No item may be held any more. NULL is allowed.
void content_cache_destroy(content_cache *c);
// Returns the item with this key and holds it, if the files that it was made from have not changed
// since; else NULL. Give it back with content_cache_release.
content_cache_item *content_cache_take(content_cache *c, const char *key);
// Adds `data`, which lies in `memory`, and holds the new item. The cache owns `memory` from now on.
// `files` are all the files that the data was made from; `begin` is file_clock_ns() before the
// first of them was read.
content_cache_item *content_cache_put(content_cache *c, const char *key, const void *data,
                                      arena memory, const char *const *files, size_t file_count,
                                      int64_t begin);
void content_cache_release(content_cache *c, content_cache_item *item); // NULL is allowed
