// The files that a mesh may read: whole files below one folder. The importer names them, and this
// process opens them.
#pragma once
#include "base/arena.h"
#include "base/file.h"
#include <stdbool.h>

enum { MESH_FILES_MAX = 256 };

typedef struct mesh_files {
    char root[PATH_CAP];  // resolved
    char first[PATH_CAP]; // the mesh as assimp names it: "./" and its path below `root`
    arena *memory;        // holds `opened`
    const char *opened[MESH_FILES_MAX]; // resolved paths of all files read
    size_t opened_count;
    char refused[512]; // why a file outside `root` was refused; "" when none was
} mesh_files;

// `path` must lie inside `root`.
bool mesh_files_open(mesh_files *f, const char *path, const char *root, arena *memory);

// Opens a file for the importer, by a name below the root, and adds it to `opened`. This is `open`
// of an isolate_job; its user is a mesh_files. -1, and a reason in `refused`, when the name leads
// out of the root.
int mesh_files_give(void *files, const char *name, size_t *size);

// Resolves a name relative to the mesh's folder, as materials have them. False with a message, and
// a reason in `refused`, when it leads out of the root.
bool mesh_files_resolve_beside(mesh_files *f, const char *name, char out[PATH_CAP]);
void mesh_files_note(mesh_files *f, const char *path); // adds a file to `opened`
