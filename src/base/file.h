// Files and paths. Paths are UTF-8, '/'-separated, at most PATH_CAP - 1 bytes.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PATH_CAP = 4096 };

// Reads a whole regular file of at most `max` bytes. `*data` gets a terminating NUL that `*size`
// does not count; free it with mem_free.
bool file_read(const char *path, size_t max, void **data, size_t *size);

// Writes to a temporary name beside `path`, flushes, then renames: readers see all or nothing.
// A full disk or an unwritable folder is an error; the temporary file is removed.
bool file_write(const char *path, const void *data, size_t size);

// The same, piece by piece: what fails is told at the end, where either the whole file is there or
// nothing of it. Only for regular files, as those that do not exist yet will be.
typedef struct file_draft {
    int fd, reason; // reason: errno of what failed first, 0: nothing
    char path[PATH_CAP], temporary[PATH_CAP];
} file_draft;
bool file_draft_begin(file_draft *d, const char *path);
void file_draft_add(file_draft *d, const void *data, size_t size);
void file_draft_patch(file_draft *d, uint64_t at, const void *data, size_t size);
bool file_draft_end(file_draft *d);
void file_draft_drop(file_draft *d); // instead: leaves nothing

bool file_exists(const char *path);
bool file_is_folder(const char *path);
bool file_make_folders(const char *path);        // like mkdir -p
bool file_make_parent_folders(const char *path); // folders above the last component
int64_t file_modified_ns(const char *path);      // 0 when it does not exist
int64_t file_changed_ns(const char *path);       // the same, renaming and linking included
int64_t file_clock_ns(void);                     // by which file systems stamp what changes now

// Sorted matches of a pattern with wildcards (*, ?, [..]) in its last component, names compared as
// bytes. A file of exactly that name is the only match. False only on errors; no match gives count
// 0. Matches may be symbolic links: path_confine those that must stay inside a folder.
typedef struct file_list {
    char **paths;
    size_t count;
} file_list;
bool file_glob(const char *pattern, file_list *out);
void file_list_free(file_list *list);

bool path_too_long(const char *path); // an error that shows the beginning of `path`
bool path_join(char out[PATH_CAP], const char *folder, const char *name); // absolute name wins
void path_folder(char out[PATH_CAP], const char *path); // "a/b.c" -> "a", "b.c" -> "."
const char *path_name(const char *path);                // "a/b.c" -> "b.c"
const char *path_extension(const char *path);           // "a/b.tar.gz" -> "gz", "" if none

// Joins `name` to `root` and requires the result, symbolic links followed, to lie inside `root`.
// The file itself need not exist; a wildcard in the last component is allowed.
bool path_confine(char out[PATH_CAP], const char *root, const char *name);

// False, with a message, unless the existing file `path`, symbolic links followed, lies in `root`.
bool path_require_inside(const char *root, const char *path);

// Folder of the running program; and a per-user cache folder for `name`, created on demand
// ($ROIL_CACHE_DIR, else $XDG_CACHE_HOME/roil, else ~/.cache/roil).
bool path_program_folder(char out[PATH_CAP]);
bool path_cache_folder(char out[PATH_CAP], const char *name);
