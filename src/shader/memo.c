// Remembers what a library found and read, so that the shaders of one load, which include the same
// files again and again, look for each file and read it once. Asking the file system for every part
// of every path took two thirds of a reload.
#include "base/file.h"
#include "base/memory.h"
#include "shader/unit.h"
#include <pthread.h>
#include <string.h>

typedef struct memo_name {
    library_root root;
    const char *name; // as library_find normalised it
    int found;
    library_file file;
} memo_name;

typedef struct memo_text {
    const char *path, *text;
    size_t size;
    hash128 hash;
} memo_text;

struct library_memo {
    pthread_mutex_t lock; // shaders are compiled on several threads
    arena memory;
    memo_name *names;
    size_t name_count, name_capacity;
    memo_text *texts;
    size_t text_count, text_capacity;
};

library_memo *memo_create(void) {
    library_memo *m = mem_alloc(sizeof *m);
    pthread_mutex_init(&m->lock, NULL);
    return m;
}

void memo_forget(library_memo *m) {
    pthread_mutex_lock(&m->lock);
    m->name_count = m->text_count = 0;
    arena_free(&m->memory);
    pthread_mutex_unlock(&m->lock);
}

void memo_destroy(library_memo *m) {
    if (!m) return;
    arena_free(&m->memory);
    mem_free(m->names);
    mem_free(m->texts);
    pthread_mutex_destroy(&m->lock);
    mem_free(m);
}

static library_file copy_file(arena *memory, const library_file *file) {
    return (library_file){.root = file->root,
                          .name = arena_string(memory, file->name),
                          .path = arena_string(memory, file->path),
                          .label = arena_string(memory, file->label)};
}

bool memo_find(library_memo *m, library_root root, const char *name, arena *memory, int *found,
               library_file *out) {
    bool known = false;
    pthread_mutex_lock(&m->lock);
    for (size_t i = 0; i < m->name_count && !known; i++) {
        const memo_name *entry = &m->names[i];
        known = entry->root == root && strcmp(entry->name, name) == 0;
        if (!known) continue;
        *found = entry->found;
        if (entry->found) *out = copy_file(memory, &entry->file);
    }
    pthread_mutex_unlock(&m->lock);
    return known;
}

void memo_keep(library_memo *m, library_root root, const char *name, int found,
               const library_file *file) {
    pthread_mutex_lock(&m->lock);
    MEM_RESERVE(m->names, m->name_count + 1, m->name_capacity);
    memo_name *entry = &m->names[m->name_count++];
    *entry = (memo_name){.root = root, .name = arena_string(&m->memory, name), .found = found};
    if (found) entry->file = copy_file(&m->memory, file);
    pthread_mutex_unlock(&m->lock);
}

// With the lock held.
static const memo_text *read_text(library_memo *m, const char *root, const char *path) {
    for (size_t i = 0; i < m->text_count; i++)
        if (strcmp(m->texts[i].path, path) == 0) return &m->texts[i];
    void *data = NULL;
    size_t size;
    if (!file_read_inside(root, path, UNIT_MAX_SIZE, &data, &size)) return NULL;
    MEM_RESERVE(m->texts, m->text_count + 1, m->text_capacity);
    memo_text *entry = &m->texts[m->text_count++];
    *entry = (memo_text){.path = arena_string(&m->memory, path),
                         .text = arena_copy(&m->memory, data, size + 1),
                         .size = size,
                         .hash = hash_bytes(data, size)};
    mem_free(data);
    return entry;
}

bool memo_read(library_memo *m, const char *root, const char *path, arena *memory, char **text,
               size_t *size) {
    pthread_mutex_lock(&m->lock);
    const memo_text *entry = read_text(m, root, path);
    if (entry) {
        *text = arena_copy(memory, entry->text, entry->size + 1);
        *size = entry->size;
    }
    pthread_mutex_unlock(&m->lock);
    return entry != NULL;
}

bool memo_hash(library_memo *m, const char *root, const char *path, hash128 *out) {
    pthread_mutex_lock(&m->lock);
    const memo_text *entry = read_text(m, root, path);
    if (entry) *out = entry->hash;
    pthread_mutex_unlock(&m->lock);
    return entry != NULL;
}
