// Bundles: an effect and all that it reads as one file. It is a tar archive (POSIX ustar) of plain
// files in one folder NAME, in which NAME.lua is the effect, so that any tar packs and unpacks it.
// Nothing is compressed: volumes and pictures are already.
#pragma once
#include "base/arena.h"
#include "base/file.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { BUNDLE_MAX_FILES = 65536, BUNDLE_MAX_NAME = 200, BUNDLE_MAX_BYTES = 255 };

typedef struct bundle_file {
    const char *name; // below the folder: "smoke.lua", "data/smoke.vdb"
    uint64_t at, size;
} bundle_file;
typedef struct bundle {
    arena memory;
    const char *name; // of the folder
    bundle_file *files;
    size_t count;
} bundle;

// Lists what is in a file of `size` bytes, which may be a stranger's. Refuses, with a message:
// links, devices and whatever is no plain file or folder; names that lead out, that are there
// twice, or that are no plain text; more than BUNDLE_MAX_FILES files; a file that ends too early.
// arena_free(&out->memory) in either case.
bool bundle_read(int file, uint64_t size, bundle *out);
// Writes all into an empty folder that nobody else writes to. `folder` is an open one.
bool bundle_unpack(int file, const bundle *b, int folder);

bool bundle_is_name(const char *text); // can be that of a file in a bundle

// Writes a bundle: equal files give equal bytes. Errors are reported by bundle_end.
typedef struct bundle_draft {
    file_draft file;
    const char *name;
    char why[512]; // the first error; "": none
} bundle_draft;
bool bundle_begin(bundle_draft *d, const char *path, const char *name); // both must outlive it
void bundle_add(bundle_draft *d, const char *name, int file, uint64_t size);
bool bundle_end(bundle_draft *d); // leaves the whole file or nothing
