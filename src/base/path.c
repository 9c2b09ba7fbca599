// Paths as text. Only path_confine and its relatives ask the file system where links lead.
#include "base/error.h"
#include "base/file.h"
#include "base/str.h"
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <link.h>
#include <linux/openat2.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

bool path_too_long(const char *path) {
    return err_set("%.100s...: path too long; accepted: up to %d bytes", path, PATH_CAP - 1);
}

bool path_join(char out[PATH_CAP], const char *folder, const char *name) {
    int length = name[0] == '/' || !folder[0] ? snprintf(out, PATH_CAP, "%s", name)
                                              : snprintf(out, PATH_CAP, "%s/%s", folder, name);
    return length < PATH_CAP || path_too_long(name);
}

void path_folder(char out[PATH_CAP], const char *path) {
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) : 1;
    if (slash == path) length = 1;
    if (length >= PATH_CAP) length = PATH_CAP - 1;
    memcpy(out, slash ? path : ".", length);
    out[length] = '\0';
}

const char *path_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

const char *path_stem(const char *path, int *length) {
    const char *name = path_name(path);
    size_t whole = strlen(name), ending = 0;
    if (str_ends_with(name, ".lua")) ending = strlen(".lua");
    if (str_ends_with(name, ".roil")) ending = strlen(".roil");
    *length = (int)(whole - ending);
    return name;
}

const char *path_extension(const char *path) {
    const char *name = path_name(path), *dot = strrchr(name, '.');
    return dot && dot != name ? dot + 1 : "";
}

static bool is_normal(const char *path) {
    bool normal = path[0] == '/' && path[1];
    for (const char *slash = path; normal && slash; slash = strchr(slash + 1, '/')) {
        size_t length = strcspn(slash + 1, "/");
        normal = length && strncmp(slash + 1, "..", length) != 0;
    }
    return normal;
}

// realpath() by one question in most cases, where it asks about each folder above: a path without
// "." and ".." in which the kernel meets no link is its own real path, or does not exist.
static bool find_real(const char *path, char out[PATH_MAX]) {
    const struct open_how how = {.flags = O_PATH | O_CLOEXEC, .resolve = RESOLVE_NO_SYMLINKS};
    if (!is_normal(path)) return realpath(path, out) != NULL;
    int file = (int)syscall(SYS_openat2, AT_FDCWD, path, &how, sizeof how);
    if (file < 0) return errno != ENOENT && realpath(path, out) != NULL;
    close(file);
    return str_copy(out, PATH_MAX, path);
}

// Returns the real path of the longest existing part of `path`; the rest, which holds no "..", is
// kept as it is. A broken link is refused, because nobody can say where it will lead once its
// target exists.
static bool path_resolve(char out[PATH_CAP], const char *path) {
    char head[PATH_CAP], real[PATH_MAX];
    if (!str_copy(head, sizeof head, path)) return path_too_long(path);
    const char *rest = "";
    while (!find_real(head, real)) {
        if (errno != ENOENT && errno != ENOTDIR) return err_set("%s: %s", path, strerror(errno));
        struct stat link;
        if (errno == ENOENT && lstat(head, &link) == 0) return err_set("%s: broken link", path);
        char *slash = strrchr(head, '/');
        if (!slash || slash == head) return err_set("%s: no such folder", path);
        *slash = '\0';
        rest = path + (slash - head);
    }
    if (snprintf(out, PATH_CAP, "%s%s", real, rest) >= PATH_CAP) return path_too_long(path);
    return true;
}

static bool real_folder(char out[PATH_MAX], const char *root) {
    return find_real(root, out) || err_set("%s: %s", root, strerror(errno));
}

static bool lies_inside(const char *real_root, const char *real) {
    size_t length = strcmp(real_root, "/") == 0 ? 0 : strlen(real_root);
    return strncmp(real, real_root, length) == 0 && (real[length] == '/' || real[length] == '\0');
}

static bool path_refuse(const char *path, const char *real_root) {
    return err_set("%s: leads out of %s; files must lie in this folder or below it", path,
                   real_root);
}

bool path_confine(char out[PATH_CAP], const char *root, const char *name) {
    char real_root[PATH_MAX], joined[PATH_CAP];
    if (!name[0]) return err_set("empty file name");
    if (!real_folder(real_root, root)) return false;
    if (name[0] == '/') return path_refuse(name, real_root);
    for (const char *part = name; part; part = strchr(part, '/')) {
        if (*part == '/') part++;
        if (strncmp(part, "..", 2) == 0 && (part[2] == '/' || !part[2]))
            return path_refuse(name, real_root);
    }
    if (!path_join(joined, real_root, name) || !path_resolve(out, joined)) return false;
    return lies_inside(real_root, out) || path_refuse(name, real_root);
}

static bool is_there(const char *path) {
    file_list list = {0};
    if (!strpbrk(path_name(path), "*?[")) return file_exists(path);
    bool found = file_glob(path, &list) && list.count > 0;
    file_list_free(&list);
    return found;
}

const char *path_find(char out[PATH_CAP], const char *const *folders, size_t count,
                      const char *name) {
    if (!path_confine(out, folders[0], name)) return NULL;
    if (count == 1 || is_there(out)) return folders[0];
    char other[PATH_CAP];
    for (size_t i = 1; i < count; i++)
        if (path_confine(other, folders[i], name) && is_there(other)) {
            str_copy(out, PATH_CAP, other);
            return folders[i];
        }
    return folders[0];
}

bool path_require_all_inside(const char *root, const char *const *paths, size_t count) {
    char real_root[PATH_MAX], real[PATH_MAX];
    if (!real_folder(real_root, root)) return false;
    for (size_t i = 0; i < count; i++) {
        if (!find_real(paths[i], real)) return err_set("%s: %s", paths[i], strerror(errno));
        if (!lies_inside(real_root, real)) return path_refuse(paths[i], real_root);
    }
    return true;
}

bool path_require_inside(const char *root, const char *path) {
    return path_require_all_inside(root, &path, 1);
}

bool path_split_inside(char real_root[PATH_CAP], char rest[PATH_CAP], const char *root,
                       const char *path) {
    char from_here[PATH_CAP], real[PATH_CAP];
    if (!real_folder(real_root, root)) return false;
    if (!path_join(from_here, path[0] == '/' ? "" : ".", path) || !path_resolve(real, from_here))
        return false;
    if (!lies_inside(real_root, real)) return path_refuse(path, real_root);
    size_t length = strcmp(real_root, "/") == 0 ? 0 : strlen(real_root);
    str_copy(rest, PATH_CAP, real + length + (real[length] == '/'));
    return true;
}

// The loader's name of a library is its path; that of the program is what its caller called it.
bool path_own_folder(char out[PATH_CAP]) {
    static const char here;
    char file[PATH_MAX];
    Dl_info info;
    struct link_map *map = NULL;
    if (dladdr1(&here, &info, (void **)&map, RTLD_DL_LINKMAP) && map && map->l_name[0]) {
        if (!realpath(map->l_name, file)) return err_set("%s: %s", map->l_name, strerror(errno));
    } else {
        ssize_t length = readlink("/proc/self/exe", file, sizeof file - 1);
        if (length < 0) return err_set("/proc/self/exe: %s", strerror(errno));
        file[length] = '\0';
    }
    path_folder(out, file);
    return true;
}

bool path_cache_folder(char out[PATH_CAP], const char *name) {
    const char *own = getenv("ROIL_CACHE_DIR"), *xdg = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    char base[PATH_CAP];
    int length;
    if (own && own[0])
        length = snprintf(base, sizeof base, "%s", own);
    else if (xdg && xdg[0] == '/')
        length = snprintf(base, sizeof base, "%s/roil", xdg);
    else if (home && home[0])
        length = snprintf(base, sizeof base, "%s/.cache/roil", home);
    else
        return err_set("no cache folder: none of ROIL_CACHE_DIR, XDG_CACHE_HOME, HOME is set");
    if (length >= (int)sizeof base) return err_set("cache folder: path too long");
    return path_join(out, base, name) && file_make_folders(out);
}
