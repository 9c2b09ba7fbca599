#include "base/file.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

// ---- whole files ------------------------------------------------------------------------------

static bool read_open(int fd, const char *path, size_t length, void **data, size_t *size) {
    size_t done = 0;
    char *bytes = mem_alloc(length + 1);
    while (done < length) {
        ssize_t got = read(fd, bytes + done, length - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            mem_free(bytes);
            return err_set("%s: %s", path, strerror(errno));
        }
        if (got == 0) break; // shorter than a moment ago
        done += (size_t)got;
    }
    bytes[done] = '\0';
    *data = bytes;
    *size = done;
    return true;
}

bool file_read(const char *path, size_t max, void **data, size_t *size) {
    return file_read_inside(NULL, path, max, data, size);
}

bool file_read_inside(const char *root, const char *path, size_t max, void **data, size_t *size) {
    size_t length;
    int fd = file_open_inside(root, path, max, &length);
    if (fd < 0) return false;
    bool done = read_open(fd, path, length, data, size);
    close(fd);
    return done;
}

static bool write_all(int fd, const char *data, size_t size) {
    while (size) {
        ssize_t put = write(fd, data, size);
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) return false;
        data += put;
        size -= (size_t)put;
    }
    return true;
}

static bool reach_disk(int fd) {
    return fsync(fd) == 0 || errno == EINVAL;
}

// Devices and pipes ("/dev/stdout") cannot be replaced by a rename, so they are written in place.
static bool write_in_place(const char *path, const void *data, size_t size) {
    int fd = open(path, O_WRONLY | O_CLOEXEC);
    if (fd < 0) return err_set("%s: %s", path, strerror(errno));
    bool done = write_all(fd, data, size) && reach_disk(fd);
    if (!done) err_set("%s: %s", path, strerror(errno));
    close(fd);
    return done;
}

// The mode of a new file. The umask is read from where the system tells it, since the call that
// gives it sets it, and another thread of the host may make a file just then. Untold: the user's.
static unsigned file_mode(void) {
    char text[256];
    unsigned mask = 077;
    int fd = open("/proc/self/status", O_RDONLY | O_CLOEXEC);
    ssize_t size = fd >= 0 ? read(fd, text, sizeof text - 1) : -1;
    if (fd >= 0) close(fd);
    text[size > 0 ? size : 0] = '\0';
    const char *line = strstr(text, "\nUmask:");
    if (line) sscanf(line, "\nUmask: %o", &mask);
    return 0666 & ~mask;
}

// Makes an unused name beside `path`, for file systems where a file cannot be without a name.
static void make_name(file_draft *d) {
    static atomic_uint count;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    snprintf(d->temporary, sizeof d->temporary, ".roil-%lx-%lx-%x", (unsigned long)getpid(),
             (unsigned long)now.tv_nsec, atomic_fetch_add(&count, 1));
}

// Opens a file without a name. It disappears with the process, however that ends.
static int open_nameless(int folder) {
    return openat(folder, ".", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
}

static int open_named(file_draft *d) {
    int fd;
    do {
        make_name(d);
        fd = openat(d->folder, d->temporary, O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC | O_NOFOLLOW,
                    0600);
    } while (fd < 0 && errno == EEXIST);
    d->named = fd >= 0;
    return fd;
}

static bool is_target(const file_draft *d, bool inside) {
    struct stat info;
    const char *name = path_name(d->path);
    if (fstatat(d->folder, name, &info, inside ? AT_SYMLINK_NOFOLLOW : 0) != 0) return true;
    if (S_ISDIR(info.st_mode)) return err_set("%s: is a folder", d->path);
    return S_ISREG(info.st_mode) ||
           err_set("%s: is no regular file, so it is not written", d->path);
}

static bool draft_begin(file_draft *d, bool inside) {
    if (!is_target(d, inside)) return false;
    if (!path_name(d->path)[0]) return err_set("%s: is no name of a file", d->path);
    d->fd = open_nameless(d->folder);
    if (d->fd < 0) d->fd = open_named(d);
    if (d->fd < 0) return err_set("%s: cannot be written: %s", d->path, strerror(errno));
    if (fchmod(d->fd, file_mode()) != 0) d->reason = errno;
    return true;
}

static bool begin_in(file_draft *d, int folder, const char *path, bool inside) {
    d->fd = -1;
    d->reason = 0;
    d->named = false;
    d->folder = folder;
    if (folder < 0) return false;
    if ((str_copy(d->path, sizeof d->path, path) || path_too_long(path)) && draft_begin(d, inside))
        return true;
    close(folder);
    return false;
}

bool file_draft_begin(file_draft *d, const char *path) {
    char above[PATH_CAP];
    if (strlen(path) >= PATH_CAP) return path_too_long(path);
    path_folder(above, path);
    int folder = open(above, O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return err_set("%s: cannot be written: %s", path, strerror(errno));
    return begin_in(d, folder, path, false);
}

static bool file_draft_begin_inside(file_draft *d, const char *root, const char *path) {
    return begin_in(d, file_open_folder_inside(root, path), path, true);
}

void file_draft_add(file_draft *d, const void *data, size_t size) {
    if (!d->reason && !write_all(d->fd, data, size)) d->reason = errno;
}

void file_draft_patch(file_draft *d, uint64_t at, const void *data, size_t size) {
    if (d->reason) return;
    if (lseek(d->fd, (off_t)at, SEEK_SET) < 0) d->reason = errno;
    file_draft_add(d, data, size);
    if (lseek(d->fd, 0, SEEK_END) < 0 && !d->reason) d->reason = errno;
}

static void draft_end(file_draft *d) {
    if (d->named) unlinkat(d->folder, d->temporary, 0);
    close(d->folder);
}

void file_draft_drop(file_draft *d) {
    close(d->fd);
    draft_end(d);
}

// Gives a nameless file a temporary name, since only a named file can replace another.
static bool give_name(file_draft *d) {
    char open_file[64];
    snprintf(open_file, sizeof open_file, "/proc/self/fd/%d", d->fd);
    while (!d->named) {
        make_name(d);
        d->named = linkat(AT_FDCWD, open_file, d->folder, d->temporary, AT_SYMLINK_FOLLOW) == 0;
        if (!d->named && errno != EEXIST) return false;
    }
    return true;
}

bool file_draft_end(file_draft *d) {
    if (!d->reason && !reach_disk(d->fd)) d->reason = errno;
    if (!d->reason && !give_name(d)) d->reason = errno;
    if (close(d->fd) != 0 && !d->reason) d->reason = errno;
    if (!d->reason && renameat(d->folder, d->temporary, d->folder, path_name(d->path)) != 0)
        d->reason = errno;
    if (!d->reason) d->named = false;
    draft_end(d);
    if (!d->reason) return true;
    return err_set("%s: cannot be written: %s", d->path, strerror(d->reason));
}

bool file_write(const char *path, const void *data, size_t size) {
    struct stat info;
    file_draft draft;
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode)) {
        if (S_ISDIR(info.st_mode)) return err_set("%s: is a folder", path);
        return write_in_place(path, data, size);
    }
    if (!file_draft_begin(&draft, path)) return false;
    file_draft_add(&draft, data, size);
    return file_draft_end(&draft);
}

bool file_write_inside(const char *root, const char *path, const void *data, size_t size) {
    file_draft draft;
    if (!file_draft_begin_inside(&draft, root, path)) return false;
    file_draft_add(&draft, data, size);
    return file_draft_end(&draft);
}

bool file_exists(const char *path) {
    return access(path, F_OK) == 0;
}

bool file_is_folder(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

static int64_t nanoseconds(struct timespec time) {
    return (int64_t)time.tv_sec * 1000000000 + time.tv_nsec;
}

bool file_make_folders(const char *path) {
    char partial[PATH_CAP];
    if (!path[0]) return err_set("empty folder name");
    if (!str_copy(partial, sizeof partial, path)) return path_too_long(path);
    for (char *end = partial + 1;; end++) {
        if (*end != '/' && *end != '\0') continue;
        char kept = *end;
        *end = '\0';
        if (mkdir(partial, 0777) != 0 && errno != EEXIST)
            return err_set("%s: %s", partial, strerror(errno));
        *end = kept;
        if (!kept) break;
    }
    if (!file_is_folder(path)) return err_set("%s: not a folder", path);
    return true;
}

bool file_make_parent_folders(const char *path) {
    char folder[PATH_CAP];
    path_folder(folder, path);
    return file_make_folders(folder);
}

int64_t file_changed_ns(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 ? nanoseconds(info.st_ctim) : 0;
}

file_stamp file_stamp_of(const char *path, int64_t begin) {
    struct stat info;
    if (stat(path, &info) != 0) return (file_stamp){0};
    const int64_t changed = nanoseconds(info.st_ctim);
    return (file_stamp){.device = info.st_dev,
                        .inode = info.st_ino,
                        .size = (uint64_t)info.st_size,
                        .modified = nanoseconds(info.st_mtim),
                        .changed = changed,
                        .known = changed < begin};
}

bool file_stamp_holds(const file_stamp *stamp, const char *path) {
    const file_stamp now = file_stamp_of(path, INT64_MAX);
    return stamp->known && now.known && now.device == stamp->device && now.inode == stamp->inode &&
           now.size == stamp->size && now.modified == stamp->modified &&
           now.changed == stamp->changed;
}

int64_t file_clock_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME_COARSE, &now);
    return nanoseconds(now);
}

static void list_add(file_list *list, size_t *capacity, const char *folder, size_t folder_length,
                     const char *name) {
    size_t length = strlen(name);
    char *path = mem_alloc(folder_length + length + 1);
    memcpy(path, folder, folder_length);
    memcpy(path + folder_length, name, length);
    *MEM_ADD(list->paths, list->count, *capacity) = path;
}

static int by_bytes(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

// Does not use glob(), because folders are taken literally: an effect must also work below
// "[drafts]".
bool file_glob(const char *pattern, file_list *out) {
    *out = (file_list){0};
    size_t capacity = 0;
    if (file_exists(pattern)) {
        list_add(out, &capacity, "", 0, pattern);
        return true;
    }
    char folder[PATH_CAP];
    path_folder(folder, pattern);
    const char *wanted = path_name(pattern);
    DIR *listed = opendir(folder);
    if (!listed && (errno == ENOENT || errno == ENOTDIR)) {
        if (!strpbrk(folder, "*?")) return true;
        return err_set("%s: wildcards are accepted in the last component only", pattern);
    }
    if (!listed) return err_set("%s: cannot be listed: %s", folder, strerror(errno));
    errno = 0;
    for (struct dirent *entry; (entry = readdir(listed)) != NULL; errno = 0)
        if (fnmatch(wanted, entry->d_name, FNM_PERIOD | FNM_NOESCAPE) == 0)
            list_add(out, &capacity, pattern, (size_t)(wanted - pattern), entry->d_name);
    int reason = errno;
    closedir(listed);
    if (reason) {
        file_list_free(out);
        return err_set("%s: cannot be listed: %s", folder, strerror(reason));
    }
    if (out->count) qsort(out->paths, out->count, sizeof *out->paths, by_bytes);
    return true;
}

void file_list_free(file_list *list) {
    for (size_t i = 0; i < list->count; i++) mem_free(list->paths[i]);
    mem_free(list->paths);
    *list = (file_list){0};
}
