#include "media/mesh_io.h"
#include "base/memory.h"
#include "base/str.h"
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { JSON_DEPTH_MAX = 100 };

static const size_t FILE_BYTES_MAX = (size_t)64 << 20;

typedef struct open_file {
    struct aiFile calls; // first, so that a pointer to it is one to all
    char *data;
    size_t size, at;
} open_file;

static size_t on_read(struct aiFile *file, char *out, size_t size, size_t count) {
    open_file *f = (open_file *)file;
    if (size == 0) return 0;
    size_t whole = (f->size - f->at) / size;
    if (count > whole) count = whole;
    memcpy(out, f->data + f->at, count * size);
    f->at += count * size;
    return count;
}

static size_t on_write(struct aiFile *file, const char *data, size_t size, size_t count) {
    (void)file, (void)data, (void)size, (void)count;
    return 0;
}

static size_t on_tell(struct aiFile *file) {
    return ((open_file *)file)->at;
}

static size_t on_size(struct aiFile *file) {
    return ((open_file *)file)->size;
}

static aiReturn on_seek(struct aiFile *file, size_t offset, enum aiOrigin origin) {
    open_file *f = (open_file *)file;
    size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? f->at : f->size;
    size_t at = base + offset; // a negative offset comes as a large one, and wraps back
    if (at > f->size) return aiReturn_FAILURE;
    f->at = at;
    return aiReturn_SUCCESS;
}

static void on_flush(struct aiFile *file) {
    (void)file;
}

// Returns how deeply objects and arrays of a glTF file are nested. In a binary file they are in the
// first chunk, whose length is at byte 12.
static size_t json_depth(const char *data, size_t size) {
    size_t depth = 0, deepest = 0, at = 0;
    if (size >= 20 && memcmp(data, "glTF", 4) == 0) {
        uint32_t length;
        memcpy(&length, data + 12, sizeof length);
        at = 20;
        if (length < size - at) size = at + length;
    }
    for (bool text = false; at < size; at++) {
        char c = data[at];
        if (text && c == '\\') at++;
        if (c == '"') text = !text;
        if (!text && (c == '{' || c == '[') && ++depth > deepest) deepest = depth;
        if (!text && (c == '}' || c == ']') && depth > 0) depth--;
    }
    return deepest;
}

// Checks the depth of nesting, because the parser of assimp 5.2 recurses.
static bool is_safe(mesh_io *io, const char *name, const char *data, size_t size) {
    bool json = str_ends_with(name, ".gltf") || str_ends_with(name, ".glb");
    size_t depth = json ? json_depth(data, size) : 0;
    if (depth <= JSON_DEPTH_MAX) return true;
    snprintf(io->refused, sizeof io->refused, "objects nested %zu deep; up to %d are accepted",
             depth, JSON_DEPTH_MAX);
    return false;
}

static struct aiFile *on_open(struct aiFileIO *io, const char *name, const char *mode) {
    mesh_io *window = (mesh_io *)io;
    if (strchr(mode, 'w') || strchr(mode, 'a') || strchr(mode, '+')) return NULL;
    void *data;
    size_t size;
    if (!window->call->ask(window->call, name, FILE_BYTES_MAX, &data, &size)) return NULL;
    if (!is_safe(window, name, data, size)) {
        mem_free(data);
        return NULL;
    }
    open_file *f = mem_alloc(sizeof *f);
    f->calls = (struct aiFile){.ReadProc = on_read,
                               .WriteProc = on_write,
                               .TellProc = on_tell,
                               .FileSizeProc = on_size,
                               .SeekProc = on_seek,
                               .FlushProc = on_flush};
    f->data = data;
    f->size = size;
    return &f->calls;
}

static void on_close(struct aiFileIO *io, struct aiFile *file) {
    (void)io;
    open_file *f = (open_file *)file;
    mem_free(f->data);
    mem_free(f);
}

void mesh_io_open(mesh_io *io, const isolate_call *call) {
    *io = (mesh_io){.io = {.OpenProc = on_open, .CloseProc = on_close}, .call = call};
}
