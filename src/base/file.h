// Files and paths. Paths are UTF-8, '/'-separated, at most PATH_CAP - 1 bytes.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PATH_CAP = 4096 };

// Reads a whole regular file of at most `max` bytes. `*data` gets a terminating NUL that `*size`
// does not count; free it with mem_free.
bool file_read(const char *path, size_t max, void **data, size_t *size);

// Writes a temporary file beside `path`, flushes it and renames it, so that readers see all or
// nothing. On failure (a full disk, an unwritable folder) the temporary file is removed.
bool file_write(const char *path, const void *data, size_t size);

// Writes a file piece by piece. Errors are reported by file_draft_end, which leaves the whole file
// or nothing. Only for regular files. Where the file system allows it, the file has no name until
// the end, so that a process that is killed leaves nothing.
typedef struct file_draft {
    int fd, folder, reason; // reason: errno of the first failure; 0: none
    bool named;             // `temporary` exists
    char path[PATH_CAP], temporary[64];
} file_draft;
bool file_draft_begin(file_draft *d, const char *path);
void file_draft_add(file_draft *d, const void *data, size_t size);
void file_draft_patch(file_draft *d, uint64_t at, const void *data, size_t size);
bool file_draft_end(file_draft *d);
void file_draft_drop(file_draft *d); // instead of file_draft_end: leaves nothing

// The functions with `root` are for names that come from a file and not from the user. Such names
// must not lead out of the folder `root`. `path` is as open() takes it. Symbolic links are followed
// as long as they stay inside; their target is then opened folder by folder without following any
// link, so that changes made meanwhile cannot lead out either. Pipes and devices are refused, and
// do not block. A root of NULL means that the user gave the name: it may lead anywhere.

// Opens a regular file of at most `max` bytes for reading. Returns its descriptor, above 2, and its
// size; -1 with a message.
int file_open_inside(const char *root, const char *path, size_t max, size_t *size);
bool file_read_inside(const char *root, const char *path, size_t max, void **data, size_t *size);
// Opens the folder that `path` lies in, and creates it on demand. -1 with a message.
int file_open_folder_inside(const char *root, const char *path);
// Write a file. Missing folders are created. A symbolic link at `path` itself is refused.
bool file_write_inside(const char *root, const char *path, const void *data, size_t size);

bool file_exists(const char *path);
bool file_is_folder(const char *path);
bool file_make_folders(const char *path);        // like mkdir -p
bool file_make_parent_folders(const char *path); // folders above the last component
int64_t file_changed_ns(const char *path);       // the same, including renames and links
int64_t file_clock_ns(void);                     // the clock of these time stamps, now

// Tells whether a file is still the one that was read, without reading it.
typedef struct file_stamp {
    uint64_t device, inode, size;
    int64_t modified, changed; // ns
    bool known;                // false: it was missing, or changed while it was read
} file_stamp;
// Stamps a file that was read. `begin`: file_clock_ns() before.
file_stamp file_stamp_of(const char *path, int64_t begin);
bool file_stamp_holds(const file_stamp *stamp,
                      const char *path); // it was neither written nor replaced

// Lists the matches of a pattern with wildcards (*, ?, [..]) in its last component, sorted by
// bytes. A file of exactly that name is the only match. False only on errors; no match gives a
// count of 0. Matches may be symbolic links: call path_confine for those that must stay inside a
// folder.
typedef struct file_list {
    char **paths;
    size_t count;
} file_list;
bool file_glob(const char *pattern, file_list *out);
void file_list_free(file_list *list);

bool path_too_long(const char *path); // sets a message; always returns false
bool path_join(char out[PATH_CAP], const char *folder, const char *name); // absolute name wins
void path_folder(char out[PATH_CAP], const char *path); // "a/b.c" -> "a", "b.c" -> "."
const char *path_name(const char *path);                // "a/b.c" -> "b.c"
// Returns the name of an effect's file or bundle, and how long it is without its ending:
// "a/fire.lua" -> "fire.lua", 4.
const char *path_stem(const char *path, int *length);
const char *path_extension(const char *path); // "a/b.tar.gz" -> "gz", "" if none

// Joins `name` to `root` and requires the result, symbolic links followed, to lie inside `root`.
// The file itself need not exist; a wildcard in the last component is allowed.
bool path_confine(char out[PATH_CAP], const char *root, const char *name);

// Finds a file by its name in the first folder that has one; wildcards are allowed as above.
// Returns that folder, or the first where none has it. NULL with a message: the name leads out.
const char *path_find(char out[PATH_CAP], const char *const *folders, size_t count,
                      const char *name);

// False, with a message, unless the existing file `path`, symbolic links followed, lies in `root`.
bool path_require_inside(const char *root, const char *path);
bool path_require_all_inside(const char *root, const char *const *paths, size_t count);

// Splits `path`, symbolic links followed, into the real path of `root` and the rest ("" for the
// root itself). False with a message unless it lies inside. It need not exist.
bool path_split_inside(char real_root[PATH_CAP], char rest[PATH_CAP], const char *root,
                       const char *path);

// Return the folder of the file that holds this code (the running program, or the library that it
// has loaded), and the user's cache folder for `name`, which is created on demand ($ROIL_CACHE_DIR,
// else $XDG_CACHE_HOME/roil, else ~/.cache/roil).
bool path_own_folder(char out[PATH_CAP]);
bool path_cache_folder(char out[PATH_CAP], const char *name);
