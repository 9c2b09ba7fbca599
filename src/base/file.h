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
// nothing of it. Only for regular files, as those that do not exist yet will be. Until the end it
// has no name where the file system can do that, so that a process that is killed leaves nothing.
typedef struct file_draft {
    int fd, folder, reason; // reason: errno of what failed first, 0: nothing
    bool named;             // `temporary` exists
    char path[PATH_CAP], temporary[64];
} file_draft;
bool file_draft_begin(file_draft *d, const char *path);
void file_draft_add(file_draft *d, const void *data, size_t size);
void file_draft_patch(file_draft *d, uint64_t at, const void *data, size_t size);
bool file_draft_end(file_draft *d);
void file_draft_drop(file_draft *d); // instead: leaves nothing

// What a new file may be: 0666 without the process's umask. Any thread.
unsigned file_mode(void);

// Names that were not given by the user but stand in a file, or follow from one, may not lead out
// of the folder `root`. `path` is as open() takes it. Symbolic links are followed as long as they
// stay inside; what they lead to is then opened folder by folder without following any, so that
// nothing that changes meanwhile leads out either. Pipes and devices are refused, and do not block.
// A root of NULL stands for a name that the user gave: it may lead anywhere.

// A regular file of at most `max` bytes, to read: its descriptor, above 2, and its size; -1 with a
// message.
int file_open_inside(const char *root, const char *path, size_t max, size_t *size);
bool file_read_inside(const char *root, const char *path, size_t max, void **data, size_t *size);
// The folder that `path` lies in, made on demand; -1, with a message.
int file_open_folder_inside(const char *root, const char *path);
// Folders on the way are made. A link at the place itself is refused.
bool file_write_inside(const char *root, const char *path, const void *data, size_t size);
bool file_draft_begin_inside(file_draft *d, const char *root, const char *path);

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

// Splits `path`, symbolic links followed, into the true name of `root` and what follows it ("" for
// the root itself). False, with a message, unless it lies inside. It need not exist.
bool path_split_inside(char real_root[PATH_CAP], char rest[PATH_CAP], const char *root,
                       const char *path);

// Folder of the running program; and a per-user cache folder for `name`, created on demand
// ($ROIL_CACHE_DIR, else $XDG_CACHE_HOME/roil, else ~/.cache/roil).
bool path_program_folder(char out[PATH_CAP]);
bool path_cache_folder(char out[PATH_CAP], const char *name);
