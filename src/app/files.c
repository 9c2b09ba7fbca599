// What an effect reads: for folders and bundles that hold all of it.
#include "app/app.h"
#include "base/file.h"
#include "base/memory.h"
#include <stdlib.h>
#include <string.h>

static void add_file(app_files *files, const char *path) {
    for (size_t i = 0; i < files->count; i++)
        if (strcmp(files->paths[i], path) == 0) return;
    MEM_RESERVE(files->paths, files->count + 1, files->capacity);
    files->paths[files->count++] = mem_copy(path, strlen(path) + 1);
}

// Adds what lies below the effect's folder, by its path from there.
static void add_files(app_files *files, const char *folder, const roil_effect *e) {
    size_t count = roil_files(e, NULL, 0);
    const char **paths = mem_alloc(count * sizeof *paths);
    roil_files(e, paths, count);
    for (size_t i = 0; i < count; i++) {
        char root[PATH_CAP], rest[PATH_CAP];
        if (file_exists(paths[i]) && path_split_inside(root, rest, folder, paths[i]) && rest[0])
            add_file(files, rest);
    }
    mem_free(paths);
}

// Loads the effect once more for each word of a choice: another word may read other files.
static bool add_choices(app_files *files, roil *r, const char *file, const char *folder,
                        roil_effect *e) {
    for (size_t i = 0; i < roil_control_count(e); i++) {
        roil_control c;
        roil_get_control(e, i, &c);
        if (!c.parameter || !c.structural || (c.type != ROIL_ENUM && c.type != ROIL_BOOL)) continue;
        static const char *const switches[] = {"false", "true"};
        size_t count = c.type == ROIL_BOOL ? 2 : c.word_count;
        for (size_t w = 0; w < count; w++) {
            if (w == (size_t)c.value[0]) continue;
            const char *word = c.type == ROIL_BOOL ? switches[w] : c.words[w];
            roil_effect *other = roil_load(r, file, &(roil_setting){c.name, word}, 1);
            if (!other || !roil_check(other)) {
                roil_unload(other);
                return false;
            }
            add_files(files, folder, other);
            roil_unload(other);
        }
    }
    return true;
}

static int by_name(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

bool app_collect_files(roil *r, const char *file, app_files *out) {
    char folder[PATH_CAP];
    path_folder(folder, file);
    roil_effect *e = roil_load(r, file, NULL, 0);
    bool done = e && roil_check(e);
    if (done) {
        add_files(out, folder, e);
        done = add_choices(out, r, file, folder, e);
    }
    roil_unload(e);
    qsort(out->paths, out->count, sizeof *out->paths, by_name);
    return done;
}

void app_free_files(app_files *files) {
    for (size_t i = 0; i < files->count; i++) mem_free(files->paths[i]);
    mem_free(files->paths);
    *files = (app_files){0};
}
