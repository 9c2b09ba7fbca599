// Folders of shaders: the effect's, those of assets, the program's. A name is first normalised as
// text, so that "pass/../lib/a.glsl" works and "../a.glsl" does not; then path_confine ensures that
// no symbolic link leads out of the folder.
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "shader/unit.h"
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Code from the cache is passed to the driver unchanged, so nobody else may be able to put files
// there.
static bool is_private(const char *folder) {
    struct stat info;
    if (stat(folder, &info) != 0) return err_set("%s: %s", folder, strerror(errno));
    bool mine = info.st_uid == geteuid() || geteuid() == 0;
    if (mine && !(info.st_mode & S_IWOTH)) return true;
    return err_set("%s: others can write to this folder", folder);
}

shader_library *shader_library_create(const shader_library_desc *desc) {
    const char *roots[ROOT_COUNT] = {
        [ROOT_EFFECT] = desc->effect_root, [ROOT_PROGRAM] = desc->shader_root};
    for (size_t i = 0; i < desc->asset_count; i++) roots[ROOT_ASSETS + i] = desc->assets[i];
    for (int i = 0; i < ROOT_COUNT; i++) {
        if (roots[i] && !file_is_folder(roots[i]))
            return ERR_NULL("%s: no such folder of shaders", roots[i]);
    }
    shader_library *library = mem_alloc(sizeof *library);
    for (int i = 0; i < ROOT_COUNT; i++)
        library->roots[i] = roots[i] ? arena_string(&library->memory, roots[i]) : NULL;
    if (desc->remembers) {
        library->memo = memo_create();
        library->binaries = binary_memo_create();
    }
    if (desc->cache_dir) {
        if (file_make_folders(desc->cache_dir) && is_private(desc->cache_dir))
            library->cache_dir = arena_string(&library->memory, desc->cache_dir);
        else
            log_write(LOG_WARNING, "shaders are not cached: %s", err_get());
    }
    return library;
}

void shader_library_destroy(shader_library *library) {
    if (!library) return;
    memo_destroy(library->memo);
    binary_memo_destroy(library->binaries);
    arena memory = library->memory;
    mem_free(library);
    arena_free(&memory);
}

void shader_library_forget(shader_library *library) {
    if (library->memo) memo_forget(library->memo);
}

uint64_t shader_library_compiles(const shader_library *library) {
    return atomic_load(&library->compiles);
}

// Removes "." and ".." from a relative name. False when it climbs above its start.
static bool normalise(char out[PATH_CAP], const char *name) {
    size_t length = 0;
    out[0] = '\0';
    while (*name) {
        size_t part = strcspn(name, "/");
        bool dot = part == 1 && name[0] == '.', up = part == 2 && memcmp(name, "..", 2) == 0;
        if (up) {
            if (!length) return false;
            while (length && out[length - 1] != '/') length--;
            if (length) length--; // the slash
        } else if (part && !dot) {
            if (length) out[length++] = '/';
            memcpy(out + length, name, part);
            length += part;
        }
        out[length] = '\0';
        name += part + (name[part] == '/');
    }
    return true;
}

static int find_file(const char *top, const char *normal, const char *label, library_root root,
                     arena *memory, library_file *out) {
    char path[PATH_CAP];
    if (!path_confine(path, top, normal)) return -1;
    if (!file_exists(path) || file_is_folder(path)) return 0;
    *out = (library_file){.root = root,
                          .name = arena_string(memory, normal),
                          .path = arena_string(memory, path),
                          .label = arena_string(memory, label)};
    return 1;
}

int library_find(const shader_library *library, library_root root, const char *folder,
                 const char *name, arena *memory, library_file *out) {
    const char *top = library->roots[root];
    char joined[PATH_CAP], normal[PATH_CAP], label[PATH_CAP];
    if (!top) return 0;
    if (name[0] == '/') {
        err_set("\"%s\" must be relative to the file that includes it or to a folder of shaders",
                name);
        return -1;
    }
    if (!path_join(joined, folder, name)) return -1;
    if (!normalise(normal, joined)) {
        err_set("\"%s\" leaves %s", name, top);
        return -1;
    }
    if (!normal[0]) return 0;
    if (!path_join(label, top, normal)) return -1;
    int found;
    if (library->memo && memo_find(library->memo, root, normal, label, memory, &found, out))
        return found;
    found = find_file(top, normal, label, root, memory, out);
    if (library->memo && found >= 0) memo_keep(library->memo, root, normal, found, out);
    return found;
}
