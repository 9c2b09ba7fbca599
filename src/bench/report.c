// Makes a page from results: the tree of results.json with pictures instead of their names is
// passed to scripts/report.
#include "bench/report.h"
#include "base/file.h"
#include "base/memory.h"
#include "bench/json.h"
#include "script/report.h"
#include <string.h>

enum { PICTURE_MAX = 1 << 20, PICTURES_MAX = 128 << 20 }; // bytes of one, and of all

// Returns a PNG file as a data URL; NULL when there is none. `*room`: bytes that are left.
static json_t *picture(const char *folder, const char *name, size_t *room) {
    static const unsigned char magic[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    char path[PATH_CAP];
    void *data;
    size_t size;
    if (!path_confine(path, folder, name) ||
        !file_read_inside(folder, path, PICTURE_MAX, &data, &size))
        return NULL;
    json_t *address = NULL;
    if (size <= *room && size > sizeof magic && memcmp(data, magic, sizeof magic) == 0) {
        strbuf text = {0};
        strbuf_add(&text, "data:image/png;base64,");
        strbuf_add_base64(&text, data, size);
        address = json_string(text.text);
        strbuf_free(&text);
        *room -= size;
    }
    mem_free(data);
    return address;
}

// A report without a picture is better than none.
static void add_pictures(json_t *tree, const char *folder) {
    size_t i, room = PICTURES_MAX;
    json_t *row;
    json_array_foreach(json_object_get(tree, "rows"), i, row) {
        const char *name = json_string_value(json_object_get(row, "thumbnail"));
        json_t *address = name ? picture(folder, name, &room) : NULL;
        if (address)
            json_object_set_new(row, "thumbnail", address);
        else
            json_object_del(row, "thumbnail");
    }
}

bool bench_report(const bench_results *r, const char *folder, const char *home) {
    char scripts[PATH_CAP], path[PATH_CAP];
    if (!path_join(scripts, home, "scripts/report") || !path_join(path, folder, "report.html"))
        return false;
    json_t *tree = bench_to_tree(r);
    add_pictures(tree, folder);
    strbuf page = {0};
    bool done = script_report(scripts, tree, &page) &&
                file_write_inside(folder, path, page.text, page.length);
    json_decref(tree);
    strbuf_free(&page);
    return done;
}
