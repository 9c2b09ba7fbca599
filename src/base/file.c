#include "base/file.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

// ---- whole files ------------------------------------------------------------------------------

static bool read_open(int fd, const char *path, size_t max, void **data, size_t *size) {
    struct stat info;
    if (fstat(fd, &info) != 0) return err_set("%s: %s", path, strerror(errno));
    if (!S_ISREG(info.st_mode)) return err_set("%s: not a regular file", path);
    if ((uintmax_t)info.st_size > max)
        return err_set("%s: %jd bytes, more than the %zu accepted", path, (intmax_t)info.st_size,
                       max);
    size_t length = (size_t)info.st_size, done = 0;
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
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); // a named pipe must not block
    if (fd < 0) return err_set("%s: %s", path, strerror(errno));
    bool done = read_open(fd, path, max, data, size);
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

// Devices and pipes ("/dev/stdout") cannot be renamed over: they are written in place.
static bool write_in_place(const char *path, const void *data, size_t size) {
    int fd = open(path, O_WRONLY | O_CLOEXEC);
    if (fd < 0) return err_set("%s: %s", path, strerror(errno));
    bool done = write_all(fd, data, size) && reach_disk(fd);
    if (!done) err_set("%s: %s", path, strerror(errno));
    close(fd);
    return done;
}

// It can only be read by setting it, which two threads must not do at once.
static mode_t read_umask(void) {
    static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&mutex);
    mode_t mask = umask(0);
    umask(mask);
    pthread_mutex_unlock(&mutex);
    return mask;
}

bool file_draft_begin(file_draft *d, const char *path) {
    struct stat info;
    d->reason = 0;
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode))
        return err_set("%s: is no regular file", path);
    int length = snprintf(d->temporary, sizeof d->temporary, "%s.XXXXXX", path);
    if (length >= (int)sizeof d->temporary) return path_too_long(path);
    memcpy(d->path, path, strlen(path) + 1);
    d->fd = mkostemp(d->temporary, O_CLOEXEC);
    if (d->fd < 0) return err_set("%s: cannot be written: %s", path, strerror(errno));
    if (fchmod(d->fd, 0666 & ~read_umask()) != 0) d->reason = errno;
    return true;
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

void file_draft_drop(file_draft *d) {
    close(d->fd);
    unlink(d->temporary);
}

bool file_draft_end(file_draft *d) {
    if (!d->reason && !reach_disk(d->fd)) d->reason = errno;
    if (close(d->fd) != 0 && !d->reason) d->reason = errno;
    if (!d->reason && rename(d->temporary, d->path) != 0) d->reason = errno;
    if (!d->reason) return true;
    unlink(d->temporary);
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

bool file_exists(const char *path) {
    return access(path, F_OK) == 0;
}

bool file_is_folder(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

int64_t file_modified_ns(const char *path) {
    struct stat info;
    if (stat(path, &info) != 0) return 0;
    return (int64_t)info.st_mtim.tv_sec * 1000000000 + info.st_mtim.tv_nsec;
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
    if (stat(path, &info) != 0) return 0;
    return (int64_t)info.st_ctim.tv_sec * 1000000000 + info.st_ctim.tv_nsec;
}

int64_t file_clock_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME_COARSE, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void list_add(file_list *list, size_t *capacity, const char *folder, size_t folder_length,
                     const char *name) {
    size_t length = strlen(name);
    char *path = mem_alloc(folder_length + length + 1);
    memcpy(path, folder, folder_length);
    memcpy(path + folder_length, name, length);
    MEM_RESERVE(list->paths, list->count + 1, *capacity);
    list->paths[list->count++] = path;
}

static int by_bytes(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

// Not glob(): folders are taken literally, so that an effect works below "[drafts]" as well.
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
