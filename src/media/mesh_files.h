// What a mesh may read: whole files below one folder. The importer names them, this process opens
// them.
#pragma once
#include "base/arena.h"
#include "base/file.h"
#include <stdbool.h>

enum { MESH_FILES_MAX = 256 };

typedef struct mesh_files {
    char root[PATH_CAP];  // resolved
    char first[PATH_CAP]; // the mesh, "./" and then relative to `root`, as assimp shall name it
    arena *memory;        // holds `opened`
    const char *opened[MESH_FILES_MAX]; // resolved paths of all files read
    size_t opened_count;
    char refused[512]; // why a file outside `root` was refused; "" when none was
} mesh_files;

// `path` must lie inside `root`.
bool mesh_files_open(mesh_files *f, const char *path, const char *root, arena *memory);

// Opens a file for the importer, whose name starts in the root, and notes it: `open` of an
// isolate_job, with a mesh_files. -1, with a note in `refused`, when it leaves the root.
int mesh_files_give(void *files, const char *name, size_t *size);

// Resolves a name relative to the mesh's folder, as materials hold them. False, with a message and
// a note in `refused`, when it leaves the root.
bool mesh_files_resolve_beside(mesh_files *f, const char *name, char out[PATH_CAP]);
void mesh_files_note(mesh_files *f, const char *path); // was read, or would be
