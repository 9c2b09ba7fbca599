#include "base/file.h"
#include "base/error.h"
#include "base/memory.h"
#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
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
    return fsync(fd) == 0 || errno == EINVAL;
}

// Devices and pipes ("/dev/stdout") cannot be renamed over: they are written in place.
static bool write_in_place(const char *path, const void *data, size_t size) {
    int fd = open(path, O_WRONLY | O_CLOEXEC);
    if (fd < 0) return err_set("%s: %s", path, strerror(errno));
    bool done = write_all(fd, data, size);
    if (!done) err_set("%s: %s", path, strerror(errno));
    close(fd);
    return done;
}

bool file_write(const char *path, const void *data, size_t size) {
    struct stat info;
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode)) {
        if (S_ISDIR(info.st_mode)) return err_set("%s: is a folder", path);
        return write_in_place(path, data, size);
    }
    char temporary[PATH_CAP];
    int length = snprintf(temporary, sizeof temporary, "%s.XXXXXX", path);
    if (length >= (int)sizeof temporary) return err_set("%s: path too long", path);
    int fd = mkostemp(temporary, O_CLOEXEC);
    if (fd < 0) return err_set("%s: cannot be written: %s", path, strerror(errno));
    mode_t mask = umask(0);
    umask(mask);
    bool done = fchmod(fd, 0666 & ~mask) == 0 && write_all(fd, data, size);
    int reason = errno;
    if (close(fd) != 0 && done) {
        done = false;
        reason = errno;
    }
    if (done && rename(temporary, path) != 0) {
        done = false;
        reason = errno;
    }
    if (done) return true;
    unlink(temporary);
    return err_set("%s: cannot be written: %s", path, strerror(reason));
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
    if (strlen(path) >= sizeof partial) return err_set("%s: path too long", path);
    strcpy(partial, path);
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

bool file_glob(const char *pattern, file_list *out) {
    *out = (file_list){0};
    glob_t found;
    int status = glob(pattern, GLOB_NOSORT, NULL, &found);
    if (status == GLOB_NOMATCH) return true;
    if (status != 0) return err_set("%s: cannot be listed", pattern);
    out->paths = mem_alloc(found.gl_pathc * sizeof *out->paths);
    out->count = found.gl_pathc;
    for (size_t i = 0; i < found.gl_pathc; i++)
        out->paths[i] = mem_copy(found.gl_pathv[i], strlen(found.gl_pathv[i]) + 1);
    globfree(&found);
    for (size_t i = 1; i < out->count; i++) { // glob's order is nearly sorted: insertion is cheap
        char *path = out->paths[i];
        size_t j = i;
        for (; j > 0 && strcmp(out->paths[j - 1], path) > 0; j--) out->paths[j] = out->paths[j - 1];
        out->paths[j] = path;
    }
    return true;
}

void file_list_free(file_list *list) {
    for (size_t i = 0; i < list->count; i++) mem_free(list->paths[i]);
    mem_free(list->paths);
    *list = (file_list){0};
}
