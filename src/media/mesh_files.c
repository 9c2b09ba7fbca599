// Names are made plain first ("a/../b" becomes "b", '\' becomes '/'), so that what leaves the root
// by text is refused before the file system is asked; path_confine then follows symbolic links.
#include "media/mesh_files.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

static struct aiFile *on_open(struct aiFileIO *io, const char *name, const char *mode) {
    mesh_files *files = (mesh_files *)io;
    char path[PATH_CAP];
    if (strchr(mode, 'w') || strchr(mode, 'a') || strchr(mode, '+')) return NULL;
    if (!mesh_files_resolve(files, name, path)) return NULL;
    void *data;
    size_t size;
    if (!file_read(path, FILE_BYTES_MAX, &data, &size)) return NULL;
    mesh_files_note(files, path);
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

bool mesh_files_open(mesh_files *f, const char *path, const char *root, arena *memory) {
    *f = (mesh_files){.io = {.OpenProc = on_open, .CloseProc = on_close}, .memory = memory};
    char real[PATH_MAX];
    if (!realpath(root, real)) return err_set("%s: %s", root, strerror(errno));
    if (!str_copy(f->root, sizeof f->root, real)) return err_set("%s: path too long", root);
    if (!realpath(path, real)) return err_set("%s: cannot be read: %s", path, strerror(errno));
    size_t length = strlen(f->root);
    bool inside = strncmp(real, f->root, length) == 0;
    if (inside && f->root[length - 1] != '/') inside = real[length] == '/';
    if (!inside) return err_set("%s: lies outside %s", path, root);
    const char *relative = real + length;
    while (*relative == '/') relative++;
    int written = snprintf(f->first, sizeof f->first, "./%s", relative);
    return written < (int)sizeof f->first || err_set("%s: path too long", path);
}

// Appends the parts of `name` to `out`, which stays relative. False when ".." leaves it.
static bool make_plain(const char *name, char out[PATH_CAP]) {
    size_t length = 0;
    out[0] = '\0';
    if (name[0] == '/' || name[0] == '\\') return false;
    while (*name) {
        size_t part = strcspn(name, "/\\");
        if (part == 2 && name[0] == '.' && name[1] == '.') {
            if (length == 0) return false;
            while (length > 0 && out[--length] != '/') {
            }
        } else if (part > 0 && !(part == 1 && name[0] == '.')) {
            if (length + part + 2 > PATH_CAP) return false;
            if (length > 0) out[length++] = '/';
            memcpy(out + length, name, part);
            length += part;
        }
        out[length] = '\0';
        name += part;
        if (*name) name++;
    }
    return length > 0;
}

bool mesh_files_resolve(mesh_files *f, const char *name, char out[PATH_CAP]) {
    char plain[PATH_CAP];
    if (!make_plain(name, plain))
        err_set("%s: leads out of %s", name, f->root);
    else if (path_confine(out, f->root, plain))
        return true;
    if (!f->refused[0]) str_copy(f->refused, sizeof f->refused, err_get());
    return false;
}

bool mesh_files_resolve_beside(mesh_files *f, const char *name, char out[PATH_CAP]) {
    char folder[PATH_CAP], joined[PATH_CAP];
    path_folder(folder, f->first);
    if (!path_join(joined, folder, name)) return false;
    return mesh_files_resolve(f, joined, out);
}

void mesh_files_note(mesh_files *f, const char *path) {
    for (size_t i = 0; i < f->opened_count; i++)
        if (strcmp(f->opened[i], path) == 0) return;
    if (f->opened_count < MESH_FILES_MAX)
        f->opened[f->opened_count++] = arena_string(f->memory, path);
}
