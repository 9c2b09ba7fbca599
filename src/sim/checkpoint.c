#include "sim/checkpoint.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/str.h"
#include "base/worker.h"
#include "media/pack.h"
#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum {
    NAME_CAP = 64,
    MOST_TEXT = 1 << 16,
    LINE_CAP = 128, // of a text, in messages
    BATCH = 8,      // chunks that are packed side by side
};
static const uint64_t MOST_BYTES = UINT64_C(1) << 40;
static const char MAGIC[8] = "roilsim";

// As they lie in the file.
typedef struct file_head {
    char magic[8];
    uint32_t version, count;
    uint64_t hash; // of the table
} file_head;
typedef struct file_entry {
    char name[NAME_CAP];
    uint64_t size, offset; // bytes; of its first chunk in the file
    uint32_t width, zero;
} file_entry;
typedef struct file_chunk {
    uint32_t size, stored; // bytes of it, and in the file; the same: not packed
    uint64_t hash;         // of what is in the file
} file_chunk;

_Static_assert(sizeof(file_head) == 24 && sizeof(file_entry) == 88 && sizeof(file_chunk) == 16,
               "without gaps");

typedef struct chunk { // at work
    file_chunk head;
    uint32_t width;
    unsigned char *plain, *packed; // CHECKPOINT_CHUNK bytes each
} chunk;

typedef struct batch {
    chunk chunks[BATCH];
    unsigned char *plain, *packed; // of all, one after the other
} batch;

// Makes a batch for a part of `part` bytes.
static void batch_create(batch *b, uint32_t width, uint64_t part) {
    size_t size = (size_t)BATCH * CHECKPOINT_CHUNK, count = BATCH;
    if (part < size) {
        size = (size_t)part;
        count = (size + CHECKPOINT_CHUNK - 1) / CHECKPOINT_CHUNK;
    }
    b->plain = mem_alloc(size);
    b->packed = mem_alloc(size);
    for (size_t i = 0; i < count; i++)
        b->chunks[i] = (chunk){.width = width,
                               .plain = b->plain + i * CHECKPOINT_CHUNK,
                               .packed = b->packed + i * CHECKPOINT_CHUNK};
}

static void batch_free(batch *b) {
    mem_free(b->plain);
    mem_free(b->packed);
}

static uint32_t chunk_size(uint64_t left) {
    return left < CHECKPOINT_CHUNK ? (uint32_t)left : CHECKPOINT_CHUNK;
}

void checkpoint_add(checkpoint_list *list, const checkpoint_part *part) {
    *MEM_ADD(list->parts, list->count, list->capacity) = *part;
}

void checkpoint_add_text(checkpoint_list *list, const char *label, const char *part,
                         const char *text) {
    checkpoint_add(list,
                   &(checkpoint_part){.name = arena_format(&list->memory, "%s/%s", label, part),
                                      .size = strlen(text),
                                      .width = 1,
                                      .bytes = arena_string(&list->memory, text)});
}

void checkpoint_add_clock(checkpoint_list *list, const char *label, const void *clock,
                          size_t size) {
    checkpoint_add(list, &(checkpoint_part){.name = arena_format(&list->memory, "%s/clock", label),
                                            .size = size,
                                            .width = 8,
                                            .bytes = arena_copy(&list->memory, clock, size)});
}

void checkpoint_list_free(checkpoint_list *list) {
    mem_free(list->parts);
    arena_free(&list->memory);
    *list = (checkpoint_list){0};
}

// ---- writing ----------------------------------------------------------------------------------

static bool pack_one(void *user, size_t index) {
    chunk *c = &((batch *)user)->chunks[index];
    c->head.stored = (uint32_t)pack_bytes(c->plain, c->head.size, c->width, c->packed);
    if (!c->head.stored) {
        c->head.stored = c->head.size;
        memcpy(c->packed, c->plain, c->head.size);
    }
    c->head.hash = hash64(c->packed, c->head.stored);
    return true;
}

// Returns the bytes that were added to the file; 0 on failure.
static uint64_t save_batch(file_draft *file, gpu *g, const checkpoint_part *part, uint64_t at,
                           batch *b) {
    uint64_t left = part->size - at, whole = (uint64_t)BATCH * CHECKPOINT_CHUNK, added = 0;
    size_t count = 0;
    if (left > whole) left = whole;
    if (part->buffer) {
        if (!gpu_buffer_read(g, part->buffer, at, b->plain, left)) return 0;
    } else {
        memcpy(b->plain, (const char *)part->bytes + at, left);
    }
    for (; left > 0; left -= b->chunks[count++].head.size)
        b->chunks[count].head.size = chunk_size(left);
    worker_each(count, pack_one, b);
    for (size_t i = 0; i < count; i++) {
        const file_chunk *head = &b->chunks[i].head;
        file_draft_add(file, head, sizeof *head);
        file_draft_add(file, b->chunks[i].packed, head->stored);
        added += sizeof *head + head->stored;
    }
    return added;
}

static bool save_part(file_draft *file, gpu *g, const checkpoint_part *part, uint64_t *end) {
    batch b;
    bool done = true;
    batch_create(&b, part->width, part->size);
    for (uint64_t at = 0; done && at < part->size; at += (uint64_t)BATCH * CHECKPOINT_CHUNK) {
        uint64_t added = save_batch(file, g, part, at, &b);
        done = added > 0;
        *end += added;
    }
    batch_free(&b);
    return done;
}

bool checkpoint_save(const char *path, gpu *g, const checkpoint_part *parts, size_t count) {
    file_draft file;
    if (!file_make_parent_folders(path) || !file_draft_begin(&file, path)) return false;
    file_head head = {.version = CHECKPOINT_VERSION, .count = (uint32_t)count};
    memcpy(head.magic, MAGIC, sizeof MAGIC);
    size_t table_size = count * sizeof(file_entry);
    file_entry *table = mem_alloc(table_size);
    uint64_t end = sizeof head + table_size;
    file_draft_add(&file, &head, sizeof head); // both again at the end
    file_draft_add(&file, table, table_size);
    bool done = true;
    for (size_t i = 0; done && i < count; i++) {
        table[i] = (file_entry){.size = parts[i].size, .offset = end, .width = parts[i].width};
        str_copy(table[i].name, sizeof table[i].name, parts[i].name);
        done = save_part(&file, g, &parts[i], &end);
    }
    head.hash = hash64(table, table_size);
    file_draft_patch(&file, 0, &head, sizeof head);
    file_draft_patch(&file, sizeof head, table, table_size);
    mem_free(table);
    if (done) return file_draft_end(&file);
    file_draft_drop(&file);
    return err_prefix("%s: ", path);
}

// ---- reading ----------------------------------------------------------------------------------

struct checkpoint {
    FILE *file; // NULL: it is in memory
    char *path;
    uint64_t size; // of the file
    file_entry *table;
    size_t count;
    checkpoint_part *kept; // in memory: one per entry
    gpu *device;
};

static bool damaged(const checkpoint *c, const char *what) {
    return err_set("%s: the checkpoint is damaged: %s", c->path, what);
}

static bool read_bytes(checkpoint *c, void *out, size_t size) {
    return size == 0 || fread(out, 1, size, c->file) == size || damaged(c, "it ends too early");
}

static bool is_name(const char *name) {
    size_t length = strnlen(name, NAME_CAP);
    for (size_t i = 0; i < length; i++)
        if (!isalnum((unsigned char)name[i]) && !strchr("_./-", name[i])) return false;
    return length > 0 && length < NAME_CAP;
}

static bool check_entry(const checkpoint *c, size_t index) {
    const file_entry *e = &c->table[index];
    if (!is_name(e->name)) return damaged(c, "a part has no name");
    for (size_t i = 0; i < index; i++)
        if (strcmp(c->table[i].name, e->name) == 0) return damaged(c, "a part is there twice");
    if (e->size > MOST_BYTES) return damaged(c, "a part is too large");
    if (e->width != 1 && e->width != 2 && e->width != 4 && e->width != 8)
        return damaged(c, "numbers of a strange width");
    return true;
}

static bool read_table(checkpoint *c) {
    file_head head;
    if (c->size < sizeof head || fread(&head, sizeof head, 1, c->file) != 1 ||
        memcmp(head.magic, MAGIC, sizeof MAGIC) != 0)
        return err_set("%s: is no checkpoint", c->path);
    if (head.version != CHECKPOINT_VERSION)
        return err_set("%s: a checkpoint of version %u; %d is accepted", c->path, head.version,
                       CHECKPOINT_VERSION);
    size_t size = head.count * sizeof *c->table;
    if (head.count > CHECKPOINT_PARTS || size > c->size - sizeof head)
        return damaged(c, "its table is too large");
    c->table = mem_alloc(size);
    c->count = head.count;
    if (!read_bytes(c, c->table, size)) return false;
    if (hash64(c->table, size) != head.hash) return damaged(c, "its table has changed");
    for (size_t i = 0; i < c->count; i++)
        if (!check_entry(c, i)) return false;
    return true;
}

// Reads the next chunk of a part, of which `left` bytes are left.
static bool read_chunk(checkpoint *c, uint64_t left, chunk *out) {
    file_chunk *head = &out->head;
    if (!read_bytes(c, head, sizeof *head)) return false;
    if (head->size != chunk_size(left) || !head->stored || head->stored > head->size)
        return damaged(c, "a chunk has a strange size");
    return read_bytes(c, out->packed, head->stored) &&
           (hash64(out->packed, head->stored) == head->hash || damaged(c, "a chunk has changed"));
}

static bool check_content(checkpoint *c) {
    batch b;
    bool done = true;
    uint32_t largest = 0;
    for (size_t i = 0; i < c->count; i++)
        if (chunk_size(c->table[i].size) > largest) largest = chunk_size(c->table[i].size);
    batch_create(&b, 1, largest);
    uint64_t at = sizeof(file_head) + c->count * sizeof *c->table;
    for (size_t i = 0; done && i < c->count; i++) {
        done = c->table[i].offset == at || damaged(c, "a part lies elsewhere");
        for (uint64_t left = c->table[i].size; done && left > 0;) {
            done = read_chunk(c, left, &b.chunks[0]);
            if (!done) break;
            left -= b.chunks[0].head.size;
            at += sizeof(file_chunk) + b.chunks[0].head.stored;
        }
    }
    batch_free(&b);
    return done && (at == c->size || damaged(c, "there is more than it says"));
}

checkpoint *checkpoint_open(const char *path) {
    size_t size;
    int fd = file_open_inside(NULL, path, SIZE_MAX, &size);
    FILE *file = fd >= 0 ? fdopen(fd, "rb") : NULL;
    if (!file) {
        if (fd >= 0) {
            err_set("%s: %s", path, strerror(errno));
            close(fd);
        }
        return NULL;
    }
    checkpoint *c = mem_alloc(sizeof *c);
    c->file = file;
    c->path = mem_copy(path, strlen(path) + 1);
    c->size = size;
    if (read_table(c) && check_content(c)) return c;
    checkpoint_close(c);
    return NULL;
}

// Frees the memory of a checkpoint that is in memory.
static void checkpoint_release(checkpoint *c) {
    for (size_t i = 0; i < c->count; i++) {
        if (c->device) gpu_buffer_destroy(c->device, c->kept[i].buffer);
        mem_free(c->kept[i].bytes);
    }
    mem_free(c->kept);
}

void checkpoint_close(checkpoint *c) {
    if (!c) return;
    if (c->kept) checkpoint_release(c);
    if (c->file) fclose(c->file);
    mem_free(c->path);
    mem_free(c->table);
    mem_free(c);
}

static const file_entry *find_entry(const checkpoint *c, const char *name) {
    for (size_t i = 0; i < c->count; i++)
        if (strcmp(c->table[i].name, name) == 0) return &c->table[i];
    return NULL;
}

bool checkpoint_has(const checkpoint *c, const char *name, uint64_t *size) {
    const file_entry *e = find_entry(c, name);
    if (e) *size = e->size;
    return e != NULL;
}

// ---- in memory --------------------------------------------------------------------------------

static bool keep_part(checkpoint *c, const checkpoint_part *part) {
    file_entry *entry = &c->table[c->count];
    checkpoint_part *kept = &c->kept[c->count++];
    entry->size = part->size;
    str_copy(entry->name, sizeof entry->name, part->name);
    if (part->size == 0) return true;
    if (!part->buffer) {
        kept->bytes = mem_copy(part->bytes, part->size);
        return true;
    }
    kept->buffer =
        gpu_buffer_create(c->device, &(gpu_buffer_desc){.label = "kept", .size = part->size});
    return kept->buffer && gpu_buffer_copy(c->device, part->buffer, kept->buffer, part->size);
}

checkpoint *checkpoint_keep(gpu *g, const checkpoint_part *parts, size_t count) {
    checkpoint *c = mem_alloc(sizeof *c);
    *c = (checkpoint){.path = mem_copy("kept", sizeof "kept"),
                      .table = mem_alloc(count * sizeof *c->table),
                      .kept = mem_alloc(count * sizeof *c->kept),
                      .device = g};
    for (size_t i = 0; i < count; i++) {
        if (keep_part(c, &parts[i])) continue;
        checkpoint_close(c);
        return NULL;
    }
    return c;
}

static bool load_kept(const checkpoint *c, size_t index, const checkpoint_part *part) {
    const checkpoint_part *kept = &c->kept[index];
    if (part->size == 0) return true;
    if (part->buffer && kept->buffer)
        return gpu_buffer_copy(c->device, kept->buffer, part->buffer, part->size);
    if (part->buffer) return gpu_buffer_write(c->device, part->buffer, 0, kept->bytes, part->size);
    if (kept->buffer) return gpu_buffer_read(c->device, kept->buffer, 0, part->bytes, part->size);
    memcpy(part->bytes, kept->bytes, part->size);
    return true;
}

// ---- loading ----------------------------------------------------------------------------------

static bool open_one(void *user, size_t index) {
    chunk *c = &((batch *)user)->chunks[index];
    if (c->head.stored < c->head.size)
        return pack_open(c->packed, c->head.stored, c->plain, c->head.size);
    memcpy(c->plain, c->packed, c->head.size);
    return true;
}

static bool load_batch(checkpoint *c, gpu *g, const checkpoint_part *part, uint64_t *at, batch *b) {
    uint64_t left = part->size - *at, size = 0;
    size_t count = 0;
    for (; count < BATCH && left > 0; left -= b->chunks[count++].head.size) {
        if (!read_chunk(c, left, &b->chunks[count])) return false;
        size += b->chunks[count].head.size;
    }
    if (!worker_each(count, open_one, b)) return damaged(c, "a chunk cannot be unpacked");
    if (!part->buffer)
        memcpy((char *)part->bytes + *at, b->plain, size);
    else if (!gpu_buffer_write(g, part->buffer, *at, b->plain, size))
        return false;
    *at += size;
    return true;
}

bool checkpoint_load(checkpoint *c, gpu *g, const checkpoint_part *part) {
    const file_entry *e = find_entry(c, part->name);
    if (!e) return err_set("%s: the checkpoint has no part '%s'", c->path, part->name);
    if (e->size != part->size)
        return err_set("%s: part '%s' has %" PRIu64 " bytes; %" PRIu64 " are accepted", c->path,
                       part->name, e->size, part->size);
    if (c->kept) return load_kept(c, (size_t)(e - c->table), part);
    if (fseeko(c->file, (off_t)e->offset, SEEK_SET) != 0) return damaged(c, "it ends too early");
    batch b;
    bool done = true;
    batch_create(&b, e->width, part->size);
    for (uint64_t at = 0; done && at < part->size;) done = load_batch(c, g, part, &at, &b);
    batch_free(&b);
    return done;
}

// Copies a line for a terminal, since a stranger may have written the file.
static const char *show_line(const char *text, char out[LINE_CAP]) {
    if (!*text) return "nothing more";
    snprintf(out, LINE_CAP, "%.*s", (int)strcspn(text, "\n"), text);
    for (char *c = out; *c; c++)
        if (!isprint((unsigned char)*c)) *c = '?';
    return out;
}

static bool matches(const checkpoint *c, const char *theirs, const char *ours) {
    char a[LINE_CAP], b[LINE_CAP];
    size_t line = 0; // where that one begins in which they differ
    for (size_t i = 0; theirs[i] == ours[i]; i++) {
        if (!ours[i]) return true;
        if (ours[i] == '\n') line = i + 1;
    }
    return err_set("%s: the checkpoint was made with %s, the effect has %s", c->path,
                   show_line(theirs + line, a), show_line(ours + line, b));
}

bool checkpoint_load_clock(checkpoint *c, const char *label, void *clock, size_t size) {
    arena memory = {0};
    bool done = checkpoint_load(c, NULL,
                                &(checkpoint_part){.name = arena_format(&memory, "%s/clock", label),
                                                   .size = size,
                                                   .bytes = clock});
    arena_free(&memory);
    return done;
}

bool checkpoint_require(checkpoint *c, const char *name, const char *ours) {
    const file_entry *e = find_entry(c, name);
    if (e && e->size > MOST_TEXT) return damaged(c, "a text is too long");
    char *theirs = mem_alloc(e ? e->size + 1 : 1);
    const checkpoint_part part = {.name = name, .size = e ? e->size : 0, .bytes = theirs};
    bool done = checkpoint_load(c, NULL, &part) && matches(c, theirs, ours);
    mem_free(theirs);
    return done;
}
