#include "app/recent.h"
#include "app/live.h"
#include "base/hash.h"
#include "base/json_text.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_BYTES = 1 << 20 };

static json_t *read_list(void) {
    char path[PATH_CAP];
    void *text;
    size_t size;
    if (!session_file(path, sizeof path, "recent.json") ||
        !file_read(path, MOST_BYTES, &text, &size))
        return NULL;
    json_t *root = json_loadb(text, size, 0, NULL);
    mem_free(text);
    return root;
}

size_t recent_list(char (*out)[PATH_CAP]) {
    json_t *root = read_list();
    size_t count = 0;
    for (size_t i = 0; i < json_array_size(root) && count < RECENT_MOST; i++) {
        const char *path = json_string_value(json_array_get(root, i));
        if (path && str_copy(out[count], PATH_CAP, path) && file_exists(path)) count++;
    }
    json_decref(root);
    return count;
}

static bool kept_picture(const char *real, char out[PATH_CAP]) {
    char name[64];
    snprintf(name, sizeof name, "pictures/%016" PRIx64 ".png", hash64(real, strlen(real)));
    return session_file(out, PATH_CAP, name);
}

void recent_add(const char *file, roil_effect *e) {
    char before[RECENT_MOST][PATH_CAP], real[PATH_CAP], path[PATH_CAP];
    if (!realpath(file, real)) return;
    size_t count = recent_list(before);
    json_t *root = json_array();
    json_array_append_new(root, json_string(real));
    for (size_t i = 0; i < count && json_array_size(root) < RECENT_MOST; i++)
        if (strcmp(before[i], real) != 0) json_array_append_new(root, json_string(before[i]));
    char *text = json_text(root, JSON_INDENT(1));
    if (text &&
        (!session_file(path, sizeof path, "recent.json") || !file_write(path, text, strlen(text))))
        log_write(LOG_DEBUG, "live: %s", roil_error());
    mem_free(text);
    json_decref(root);
    if (kept_picture(real, path) && !roil_save(e, path, NULL))
        log_write(LOG_DEBUG, "live: %s", roil_error());
}

bool recent_picture(const char *file, char out[PATH_CAP]) {
    char real[PATH_CAP], folder[PATH_CAP], name[256];
    if (realpath(file, real) && kept_picture(real, out) && file_exists(out)) return true;
    const char *last = path_name(file);
    path_folder(folder, file);
    snprintf(name, sizeof name, "gallery/small/%.*s.png", (int)strcspn(last, "."), last);
    return path_join(out, folder, name) && file_exists(out);
}
