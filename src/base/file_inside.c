// Files that the user did not name. They are opened folder by folder below a root. No part of the
// path may be a symbolic link by then, as path_split_inside has followed those that stay inside.
#include "base/error.h"
#include "base/file.h"
#include <errno.h>
#include <fcntl.h>
#include <linux/openat2.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

static int enter_folder(int folder, const char *part, bool make) {
    const int flags = O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
    if (strcmp(part, "..") == 0) { // of a folder that does not exist
        errno = ENOENT;
        return -1;
    }
    int entered = openat(folder, part, flags);
    if (entered >= 0 || errno != ENOENT || !make) return entered;
    if (mkdirat(folder, part, 0777) != 0 && errno != EEXIST) return -1;
    return openat(folder, part, flags);
}

// Opens the folder `rest` below `real_root`. Overwrites the slashes of `rest`.
static int walk_folders(const char *real_root, char *rest, bool make) {
    int folder = open(real_root, O_PATH | O_DIRECTORY | O_CLOEXEC);
    for (char *part = rest; folder >= 0 && *part;) {
        size_t length = strcspn(part, "/");
        char *next = part + length + (part[length] == '/');
        part[length] = '\0';
        int entered = length ? enter_folder(folder, part, make) : dup(folder);
        int reason = errno;
        close(folder);
        errno = reason;
        folder = entered;
        part = next;
    }
    return folder;
}

int file_open_folder_inside(const char *root, const char *path) {
    char above[PATH_CAP], real_root[PATH_CAP], rest[PATH_CAP];
    path_folder(above, path);
    if (!path_split_inside(real_root, rest, root, above)) return -1;
    int folder = walk_folders(real_root, rest, true);
    if (folder < 0) err_set("%s: cannot be written: %s", path, strerror(errno));
    return folder;
}

// Opens the file in one system call, in which the kernel ensures that no part of the path is a
// link. This is nearly always possible. -1: the parts must be opened one by one.
static int open_at_once(const char *root, const char *path) {
    const struct open_how how = {.flags = O_RDONLY | O_CLOEXEC | O_NONBLOCK,
                                 .resolve = RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS};
    size_t length = strlen(root);
    if (strncmp(path, root, length) != 0 || path[length] != '/') return -1;
    int folder = open(root, O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return -1;
    int fd = (int)syscall(SYS_openat2, folder, path + length + 1, &how, sizeof how);
    close(folder);
    return fd;
}

static int open_below(const char *root, const char *path) {
    char real_root[PATH_CAP], rest[PATH_CAP], above[PATH_CAP];
    int at_once = open_at_once(root, path);
    if (at_once >= 0) return at_once;
    if (!path_split_inside(real_root, rest, root, path)) return -1;
    path_folder(above, rest);
    int folder = walk_folders(real_root, strchr(rest, '/') ? above : (char[]){""}, false);
    int fd = folder < 0 ? -1
                        : openat(folder, rest[0] ? path_name(rest) : ".",
                                 O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
    if (fd < 0) err_set("%s: %s", path, strerror(errno));
    if (folder >= 0) close(folder);
    return fd;
}

static bool check_regular(int fd, const char *path, size_t max, size_t *size) {
    struct stat info;
    if (fstat(fd, &info) != 0) return err_set("%s: %s", path, strerror(errno));
    if (!S_ISREG(info.st_mode)) return err_set("%s: not a regular file", path);
    if ((uintmax_t)info.st_size > max)
        return err_set("%s: %jd bytes, more than the %zu accepted", path, (intmax_t)info.st_size,
                       max);
    *size = (size_t)info.st_size;
    return true;
}

// A file that is opened while standard output is closed must not take its number.
static int keep_above_standard(int fd) {
    if (fd < 0 || fd > STDERR_FILENO) return fd;
    int high = fcntl(fd, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    close(fd);
    return high;
}

int file_open_inside(const char *root, const char *path, size_t max, size_t *size) {
    int fd = root ? open_below(root, path) : open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    bool opened = fd >= 0;
    fd = keep_above_standard(fd);
    if (fd < 0) {
        if (!root || opened) err_set("%s: %s", path, strerror(errno));
        return -1;
    }
    if (check_regular(fd, path, max, size)) return fd;
    close(fd);
    return -1;
}
