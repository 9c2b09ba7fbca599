// What was made from files, for all who need it at the same time: held by counting, dropped with
// the last holder. A reload holds what it shares with the load before it, so that nothing dear is
// read twice and nothing old is kept. Any thread.
#pragma once
#include "base/arena.h"
#include "base/file.h"

typedef struct shelf shelf;
typedef struct shelf_item {
    const void *data;
    arena memory; // holds the data
} shelf_item;

shelf *shelf_create(void);
void shelf_destroy(shelf *s); // nothing may be held; NULL is fine
// What was put for `key`, if the files that it was made from are as they were; else NULL.
shelf_item *shelf_take(shelf *s, const char *key);
// Puts `data`, which lies in `memory` (owned by the shelf from now on), and holds it. `files`: all
// that it was made from; `begin`: file_clock_ns() before the first of them was read.
shelf_item *shelf_put(shelf *s, const char *key, const void *data, arena memory,
                      const char *const *files, size_t file_count, int64_t begin);
void shelf_release(shelf *s, shelf_item *item); // NULL is fine
