// The only window that assimp has on the file system: whole files, read-only, below one folder.
#pragma once
#include "base/arena.h"
#include "base/file.h"
#include <assimp/cfileio.h>
#include <stdbool.h>

enum { MESH_FILES_MAX = 256 };

typedef struct mesh_files {
    struct aiFileIO io;   // pass to assimp; first, so that a pointer to it is one to all
    char root[PATH_CAP];  // resolved
    char first[PATH_CAP]; // the mesh, "./" and then relative to `root`, as assimp shall name it
    arena *memory;        // holds `opened`
    const char *opened[MESH_FILES_MAX]; // resolved paths of all files read
    size_t opened_count;
    char refused[512]; // why a file outside `root` was refused; "" when none was
} mesh_files;

// `path` must lie inside `root`.
bool mesh_files_open(mesh_files *f, const char *path, const char *root, arena *memory);

// Resolves a name that starts in the folder of the mesh. False, with a message and a note in
// `refused`, when it leaves the root.
bool mesh_files_resolve(mesh_files *f, const char *name, char out[PATH_CAP]);

// As above for a name relative to the mesh's folder, as materials hold them.
bool mesh_files_resolve_beside(mesh_files *f, const char *name, char out[PATH_CAP]);
void mesh_files_note(mesh_files *f, const char *path); // was read, or would be
