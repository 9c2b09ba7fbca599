// Folders that effects may read besides their own: named by the user, by the environment, or by the
// file roil.json of a project, which may come from a stranger and opens nothing but what lies below
// it.
#include "base/error.h"
#include "base/memory.h"
#include "roil/roil_impl.h"
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

enum { PROJECT_MAX = 64 << 10 };
static const char project_name[] = "roil.json";

static bool refuse_more(void) {
    return err_set("more than %d folders of assets; put what belongs together into one",
                   EFFECT_MAX_ASSETS);
}

static bool take(roil *r, const char *folder, size_t length, const char *who) {
    char path[PATH_CAP];
    if (length >= sizeof path) return path_too_long(folder);
    memcpy(path, folder, length);
    path[length] = '\0';
    if (!file_is_folder(path)) return err_set("%s %s: there is no such folder", who, path);
    if (r->asset_count == EFFECT_MAX_ASSETS) return refuse_more();
    r->assets[r->asset_count++] = mem_copy(path, length + 1);
    return true;
}

bool roil_take_assets(roil *r, const roil_desc *desc) {
    for (size_t i = 0; desc->assets && desc->assets[i]; i++)
        if (!take(r, desc->assets[i], strlen(desc->assets[i]), "--assets")) return false;
    const char *set = getenv("ROIL_ASSETS");
    while (set && *set) {
        size_t length = strcspn(set, ":");
        if (length && !take(r, set, length, "ROIL_ASSETS")) return false;
        set += length + (set[length] == ':');
    }
    return true;
}

// ---- roil.json --------------------------------------------------------------------------------

// Finds the project file in the effect's folder or the nearest one above it.
static bool find_project(const char *file, char out[PATH_CAP]) {
    char folder[PATH_CAP], real[PATH_CAP], rest[PATH_CAP];
    path_folder(folder, file);
    if (!path_split_inside(real, rest, folder, folder)) return false;
    for (;;) {
        if (path_join(out, real, project_name) && file_exists(out)) return true;
        char *slash = strrchr(real, '/');
        if (!slash || slash == real) return false;
        *slash = '\0';
    }
}

static bool read_folder(const json_t *item, const char *root, roil_assets *out) {
    char path[PATH_CAP];
    const char *name = json_string_value(item);
    if (!name) return err_set("'assets' is a list of folders, as in {\"assets\": [\"models\"]}");
    if (!path_confine(path, root, name))
        return err_prefix("a project's assets lie below it; --assets or ROIL_ASSETS name others: ");
    if (!file_is_folder(path)) return err_set("assets '%s': there is no such folder", name);
    if (out->count == EFFECT_MAX_ASSETS) return refuse_more();
    out->folders[out->count++] = arena_string(&out->memory, path);
    return true;
}

static bool read_tree(const json_t *tree, const char *root, roil_assets *out) {
    const char *key;
    json_t *value;
    if (!json_is_object(tree))
        return err_set("an object is accepted, as in {\"assets\": [\"models\"]}");
    json_object_foreach((json_t *)tree, key, value) {
        if (strcmp(key, "assets") != 0)
            return err_set("unknown key '%.64s'; accepted: assets", key);
        if (!json_is_array(value)) return read_folder(NULL, root, out);
        for (size_t i = 0; i < json_array_size(value); i++)
            if (!read_folder(json_array_get(value, i), root, out)) return false;
    }
    return true;
}

static bool read_project(const char *path, roil_assets *out) {
    char root[PATH_CAP];
    void *text;
    size_t size;
    json_error_t error;
    path_folder(root, path);
    if (!file_read(path, PROJECT_MAX, &text, &size)) return false;
    json_t *tree = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
    mem_free(text);
    bool done = tree ? read_tree(tree, root, out) || err_prefix("%s: ", path)
                     : err_set("%s:%d: %s", path, error.line, error.text);
    json_decref(tree);
    return done;
}

bool roil_is_project(const char *file) {
    return strcmp(path_name(file), project_name) == 0;
}

bool roil_find_assets(const roil *r, const roil_origin *origin, roil_assets *out) {
    char path[PATH_CAP];
    *out = (roil_assets){0};
    if (origin->bundle) return true; // it holds all
    out->count = r->asset_count;
    for (size_t i = 0; i < r->asset_count; i++) out->folders[i] = r->assets[i];
    if (!find_project(origin->file, path)) return true;
    out->project = arena_string(&out->memory, path);
    return read_project(path, out);
}
