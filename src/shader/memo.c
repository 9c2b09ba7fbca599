// Remembers what a library found and read. The shaders of one load include the same files again and
// again, and the next load nearly always finds the same: each entry is looked at once a load, by
// one call, and is searched for or read anew only when it is not as it was. Asking the file system
// for every part of every path, and reading every file, took two thirds of a reload.
#include "base/file.h"
#include "base/memory.h"
#include "shader/unit.h"
#include <pthread.h>
#include <string.h>
#include <sys/stat.h>

typedef struct memo_name {
    uint64_t hash; // of the name: most of the others are told apart by it
    uint64_t load; // in which it was looked at
    library_root root;
    const char *name;       // as library_find normalised it
    uint64_t device, inode; // of the file
    int found;
    library_file file;
} memo_name;

typedef struct memo_text {
    uint64_t path_hash, load;
    const char *path;
    file_stamp stamp;
    char *text; // owned
    size_t size;
    hash128 hash; // of the text
} memo_text;

struct library_memo {
    pthread_mutex_t lock; // shaders are compiled on several threads
    uint64_t load;
    arena memory; // of names and paths
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
    m->load++;
    pthread_mutex_unlock(&m->lock);
}

void memo_destroy(library_memo *m) {
    if (!m) return;
    for (size_t i = 0; i < m->text_count; i++) mem_free(m->texts[i].text);
    arena_free(&m->memory);
    mem_free(m->names);
    mem_free(m->texts);
    pthread_mutex_destroy(&m->lock);
    mem_free(m);
}

static uint64_t hash_name(const char *name) {
    return hash64(name, strlen(name));
}

// ---- names ------------------------------------------------------------------------------------

static memo_name *find_name(library_memo *m, uint64_t hash, library_root root, const char *name) {
    for (size_t i = 0; i < m->name_count; i++) {
        memo_name *entry = &m->names[i];
        if (entry->hash == hash && entry->root == root && strcmp(entry->name, name) == 0)
            return entry;
    }
    return NULL;
}

static library_file copy_file(arena *memory, const library_file *file) {
    return (library_file){.root = file->root,
                          .name = arena_string(memory, file->name),
                          .path = arena_string(memory, file->path),
                          .label = arena_string(memory, file->label)};
}

// Returns whether the name leads to the file that it led to, or still to none.
static bool leads_there(const memo_name *entry, const char *label) {
    struct stat info;
    if (stat(label, &info) != 0) return !entry->found;
    return entry->found && info.st_dev == entry->device && info.st_ino == entry->inode;
}

bool memo_find(library_memo *m, library_root root, const char *name, const char *label,
               arena *memory, int *found, library_file *out) {
    pthread_mutex_lock(&m->lock);
    memo_name *entry = find_name(m, hash_name(name), root, name);
    const bool known = entry && (entry->load == m->load || leads_there(entry, label));
    if (known) {
        entry->load = m->load;
        *found = entry->found;
        if (entry->found) *out = copy_file(memory, &entry->file);
    }
    pthread_mutex_unlock(&m->lock);
    return known;
}

void memo_keep(library_memo *m, library_root root, const char *name, int found,
               const library_file *file) {
    struct stat info = {0};
    const uint64_t hash = hash_name(name);
    if (found && stat(file->label, &info) != 0) return;
    pthread_mutex_lock(&m->lock);
    memo_name *entry = find_name(m, hash, root, name);
    if (!entry) {
        MEM_RESERVE(m->names, m->name_count + 1, m->name_capacity);
        entry = &m->names[m->name_count++];
        *entry = (memo_name){.hash = hash, .root = root, .name = arena_string(&m->memory, name)};
    }
    entry->load = m->load;
    entry->device = info.st_dev;
    entry->inode = info.st_ino;
    entry->found = found;
    if (found) entry->file = copy_file(&m->memory, file);
    pthread_mutex_unlock(&m->lock);
}

// ---- texts ------------------------------------------------------------------------------------

static memo_text *find_text(library_memo *m, const char *path) {
    const uint64_t hash = hash_name(path);
    for (size_t i = 0; i < m->text_count; i++)
        if (m->texts[i].path_hash == hash && strcmp(m->texts[i].path, path) == 0)
            return &m->texts[i];
    memo_text *entry = MEM_ADD(m->texts, m->text_count, m->text_capacity);
    *entry = (memo_text){.path_hash = hash, .path = arena_string(&m->memory, path)};
    return entry;
}

// With the lock held.
static const memo_text *read_text(library_memo *m, const char *root, const char *path) {
    memo_text *entry = find_text(m, path);
    if (entry->text && (entry->load == m->load || file_stamp_holds(&entry->stamp, path))) {
        entry->load = m->load;
        return entry;
    }
    void *data = NULL;
    size_t size;
    const int64_t begin = file_clock_ns();
    mem_free(entry->text);
    entry->text = NULL;
    if (!file_read_inside(root, path, UNIT_MAX_SIZE, &data, &size)) return NULL;
    entry->text = data;
    entry->size = size;
    entry->hash = hash_bytes(data, size);
    entry->stamp = file_stamp_of(path, begin);
    entry->load = m->load;
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
