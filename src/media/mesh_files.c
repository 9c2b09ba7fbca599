// Names are first normalised as text ("a/../b" becomes "b", '\' becomes '/'), so that a name that
// leaves the root is refused before the file system is asked. path_confine then follows symbolic
// links.
#include "media/mesh_files.h"
#include "base/error.h"
#include "base/str.h"
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const size_t FILE_BYTES_MAX = (size_t)64 << 20;

bool mesh_files_open(mesh_files *f, const char *path, const char *root, arena *memory) {
    *f = (mesh_files){.memory = memory};
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

static bool resolve_name(mesh_files *f, const char *name, char out[PATH_CAP]) {
    char plain[PATH_CAP];
    if (!make_plain(name, plain))
        err_set("%s: leads out of %s", name, f->root);
    else if (path_confine(out, f->root, plain))
        return true;
    if (!f->refused[0]) str_copy(f->refused, sizeof f->refused, err_get());
    return false;
}

int mesh_files_give(void *files, const char *name, size_t *size) {
    mesh_files *f = files;
    char path[PATH_CAP];
    if (!resolve_name(f, name, path)) return -1;
    int file = file_open_inside(f->root, path, FILE_BYTES_MAX, size);
    if (file >= 0) mesh_files_note(f, path);
    return file;
}

bool mesh_files_resolve_beside(mesh_files *f, const char *name, char out[PATH_CAP]) {
    char folder[PATH_CAP], joined[PATH_CAP];
    path_folder(folder, f->first);
    if (!path_join(joined, folder, name)) return false;
    return resolve_name(f, joined, out);
}

void mesh_files_note(mesh_files *f, const char *path) {
    for (size_t i = 0; i < f->opened_count; i++)
        if (strcmp(f->opened[i], path) == 0) return;
    if (f->opened_count < MESH_FILES_MAX)
        f->opened[f->opened_count++] = arena_string(f->memory, path);
}
