// The interfaces and binaries of a library, with all that each was made of: an entry is good as
// long as every name leads to the file that it led to, and every file holds the text that it held.
// So a build after an edit asks for each file once, and expands, hashes and reflects only what has
// changed.
#include "base/hash.h"
#include "base/memory.h"
#include "shader/unit.h"
#include <pthread.h>
#include <string.h>

enum { MOST = 512 }; // entries; the one that was not used for the longest time goes

typedef struct made_of {
    library_file where; // `path` NULL: a generated text, which is part of the key
    hash128 hash;       // of its text
} made_of;

typedef struct entry {
    hash128 key;
    uint64_t used;
    arena memory;
    shader_binary binary;              // of a compile
    const shader_interface *interface; // of a file's annotations; else NULL
    made_of *files;
    size_t file_count;
    unit_include *includes;
    size_t include_count;
} entry;

struct binary_memo {
    pthread_mutex_t lock;
    entry *entries;
    size_t count, capacity;
    uint64_t uses;
};

binary_memo *binary_memo_create(void) {
    binary_memo *m = mem_alloc(sizeof *m);
    pthread_mutex_init(&m->lock, NULL);
    return m;
}

void binary_memo_destroy(binary_memo *m) {
    if (!m) return;
    for (size_t i = 0; i < m->count; i++) arena_free(&m->entries[i].memory);
    mem_free(m->entries);
    pthread_mutex_destroy(&m->lock);
    mem_free(m);
}

// ---- keys -------------------------------------------------------------------------------------

// Of all that a compile is asked for, but the content of files.
static hash128 key_of(const shader_compile_desc *desc) {
    const uint64_t numbers[] = {desc->stage, desc->counters, desc->define_count, desc->text_count,
                                desc->options ? 1 + desc->option_count : 0};
    hash128 h = hash_bytes(numbers, sizeof numbers);
    if (desc->options)
        h = hash_combine(h, hash_bytes(desc->options, desc->option_count * sizeof *desc->options));
    h = hash_add_text(h, desc->name);
    for (size_t i = 0; i < desc->define_count; i++) {
        h = hash_add_text(h, desc->defines[i].name);
        h = hash_add_text(h, desc->defines[i].value);
    }
    for (size_t i = 0; i < desc->text_count; i++) {
        h = hash_add_text(h, desc->texts[i].name);
        h = hash_add_text(h, desc->texts[i].text);
    }
    return h;
}

static hash128 interface_key(const char *name) {
    return hash_add_text((hash128){0}, name);
}

// ---- copies -----------------------------------------------------------------------------------

static shader_binary copy_binary(const shader_binary *from, arena *memory) {
    shader_binary out = *from;
    out.code = arena_copy(memory, from->code, from->size);
    shader_slot *slots = arena_copy(memory, from->slots, from->slot_count * sizeof *slots);
    for (size_t i = 0; i < from->slot_count; i++)
        slots[i].name = arena_string(memory, from->slots[i].name);
    out.slots = slots;
    shader_member *members =
        arena_copy(memory, from->members, from->member_count * sizeof *members);
    for (size_t i = 0; i < from->member_count; i++)
        members[i].name = arena_string(memory, from->members[i].name);
    out.members = members;
    const char **files = arena_alloc(memory, from->file_count * sizeof *files);
    for (size_t i = 0; i < from->file_count; i++) files[i] = arena_string(memory, from->files[i]);
    out.files = files;
    return out;
}

static const value_desc *copy_values(const value_desc *from, size_t count, arena *memory) {
    value_desc *out = arena_copy(memory, from, count * sizeof *out);
    for (value_desc *d = out; d < out + count; d++) {
        const char **words = arena_copy(memory, d->words, d->word_count * sizeof *words);
        for (size_t i = 0; i < d->word_count; i++) words[i] = arena_string(memory, words[i]);
        d->words = words;
        d->name = arena_string(memory, d->name);
        d->unit = arena_string(memory, d->unit);
        d->help = arena_string(memory, d->help);
    }
    return out;
}

static const shader_interface *copy_interface(const shader_interface *from, arena *memory) {
    shader_interface *out = arena_copy(memory, from, sizeof *out);
    shader_field *fields = arena_copy(memory, from->fields, from->field_count * sizeof *fields);
    for (shader_field *f = fields; f < fields + from->field_count; f++) {
        f->name = arena_string(memory, f->name);
        f->glsl_type = arena_string(memory, f->glsl_type);
        f->after = arena_string(memory, f->after);
        f->help = arena_string(memory, f->help);
    }
    shader_image *images = arena_copy(memory, from->images, from->image_count * sizeof *images);
    for (shader_image *m = images; m < images + from->image_count; m++) {
        m->name = arena_string(memory, m->name);
        m->glsl_name = arena_string(memory, m->glsl_name);
        if (m->history_of) m->history_of = arena_string(memory, m->history_of);
        m->help = arena_string(memory, m->help);
    }
    shader_counter *counters =
        arena_copy(memory, from->counters, from->counter_count * sizeof *counters);
    for (shader_counter *c = counters; c < counters + from->counter_count; c++) {
        c->name = arena_string(memory, c->name);
        c->help = arena_string(memory, c->help);
    }
    out->path = arena_string(memory, from->path);
    out->summary = arena_string(memory, from->summary);
    out->uniforms = copy_values(from->uniforms, from->uniform_count, memory);
    out->options = copy_values(from->options, from->option_count, memory);
    out->fields = fields;
    out->images = images;
    out->counters = counters;
    return out;
}

static bool copy_files(const shader_library *library, const shader_unit *unit, entry *out) {
    arena *memory = &out->memory;
    out->files = arena_alloc(memory, unit->file_count * sizeof *out->files);
    out->file_count = unit->file_count;
    for (size_t i = 0; i < unit->file_count; i++) {
        const library_file *where = &unit->files[i].where;
        made_of *file = &out->files[i];
        file->where =
            (library_file){.root = where->root, .name = arena_string(memory, where->name)};
        if (!where->path) continue;
        file->where.path = arena_string(memory, where->path);
        if (!memo_hash(library->memo, library->roots[where->root], where->path, &file->hash))
            return false;
    }
    out->includes = arena_copy(memory, unit->includes, unit->include_count * sizeof *out->includes);
    out->include_count = unit->include_count;
    for (size_t i = 0; i < unit->include_count; i++)
        out->includes[i].name = arena_string(memory, unit->includes[i].name);
    return true;
}

// ---- finding ----------------------------------------------------------------------------------

static bool leads_there(const shader_library *library, const entry *e, const unit_include *asked,
                        arena *scratch) {
    const library_file *from = asked->file < 0 ? NULL : &e->files[asked->file].where;
    const char *path = e->files[asked->target].where.path;
    library_file found;
    return unit_find(library, from, asked->name, scratch, &found) > 0 &&
           strcmp(found.path, path) == 0;
}

static bool holds(const shader_library *library, const entry *e) {
    arena scratch = {0};
    bool same = true;
    for (size_t i = 0; i < e->include_count && same; i++)
        same = leads_there(library, e, &e->includes[i], &scratch);
    for (size_t i = 0; i < e->file_count && same; i++) {
        const made_of *file = &e->files[i];
        hash128 now;
        if (file->where.path)
            same = memo_hash(library->memo, library->roots[file->where.root], file->where.path,
                             &now) &&
                   hash_equal(now, file->hash);
    }
    arena_free(&scratch);
    return same;
}

static entry *find(binary_memo *m, hash128 key) {
    for (size_t i = 0; i < m->count; i++)
        if (hash_equal(m->entries[i].key, key)) return &m->entries[i];
    return NULL;
}

// With the lock held.
static entry *find_good(const shader_library *library, hash128 key) {
    entry *e = find(library->binaries, key);
    if (!e || !holds(library, e)) return NULL;
    e->used = ++library->binaries->uses;
    return e;
}

bool binary_memo_find(const shader_library *library, const shader_compile_desc *desc, arena *memory,
                      shader_binary *out) {
    binary_memo *m = library->binaries;
    const hash128 key = key_of(desc);
    pthread_mutex_lock(&m->lock);
    const entry *e = find_good(library, key);
    const bool found = e != NULL;
    if (found) *out = copy_binary(&e->binary, memory);
    pthread_mutex_unlock(&m->lock);
    for (size_t i = 0; found && desc->reader && i < out->file_count; i++)
        desc->reader->read(desc->reader->user, out->files[i]);
    return found;
}

const shader_interface *interface_memo_find(const shader_library *library, const char *name,
                                            arena *memory, const shader_reader *reader) {
    binary_memo *m = library->binaries;
    pthread_mutex_lock(&m->lock);
    const entry *e = find_good(library, interface_key(name));
    const shader_interface *out = e ? copy_interface(e->interface, memory) : NULL;
    for (size_t i = 0; e && reader && i < e->file_count; i++)
        reader->read(reader->user, e->files[i].where.path);
    pthread_mutex_unlock(&m->lock);
    return out;
}

static entry *make_room(binary_memo *m) {
    if (m->count < MOST) {
        MEM_RESERVE(m->entries, m->count + 1, m->capacity);
        return &m->entries[m->count++];
    }
    entry *oldest = m->entries;
    for (size_t i = 1; i < m->count; i++)
        if (m->entries[i].used < oldest->used) oldest = &m->entries[i];
    arena_free(&oldest->memory);
    return oldest;
}

static void keep_made(const shader_library *library, const shader_unit *unit, entry *made) {
    binary_memo *m = library->binaries;
    if (!copy_files(library, unit, made)) {
        arena_free(&made->memory);
        return;
    }
    pthread_mutex_lock(&m->lock);
    entry *place = find(m, made->key);
    if (place)
        arena_free(&place->memory);
    else
        place = make_room(m);
    made->used = ++m->uses;
    *place = *made;
    pthread_mutex_unlock(&m->lock);
}

void binary_memo_keep(const shader_library *library, const shader_compile_desc *desc,
                      const shader_unit *unit, const shader_binary *binary) {
    entry made = {.key = key_of(desc)};
    made.binary = copy_binary(binary, &made.memory);
    keep_made(library, unit, &made);
}

void interface_memo_keep(const shader_library *library, const char *name, const shader_unit *unit,
                         const shader_interface *interface) {
    entry made = {.key = interface_key(name)};
    made.interface = copy_interface(interface, &made.memory);
    keep_made(library, unit, &made);
}
