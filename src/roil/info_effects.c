// The effects that come with the program, by the comments that they begin with and the pictures
// that tests hold them against.
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "roil/info.h"
#include <stdlib.h>
#include <string.h>

enum { SOURCE_MAX = 1 << 20, PICTURE_MAX = 1 << 20 };

static char *read_text(const char *folder, const char *name, size_t max) {
    char path[PATH_CAP];
    void *data;
    size_t size;
    bool done = path_join(path, folder, name) && file_read(path, max, &data, &size);
    return done ? data : NULL;
}

// Returns the first paragraph of the comment that a file begins with, as one line.
static json_t *read_summary(const char *source) {
    strbuf out = {0};
    for (const char *at = source; strncmp(at, "-- ", 3) == 0;) {
        size_t length = strcspn(at, "\n");
        strbuf_add(&out, out.length ? " " : "");
        strbuf_append(&out, at + 3, length - 3);
        at += length + (at[length] == '\n');
    }
    json_t *summary = json_string(strbuf_text(&out));
    strbuf_free(&out);
    return summary;
}

// Finds the first line "PICTURE EFFECT FRAME" of an effect in the list of pictures.
static bool find_picture(const char *list, const char *wanted, char *out, size_t capacity) {
    char name[64], of[64];
    for (const char *line = list; line && *line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (sscanf(line, "%63s %63s", name, of) == 2 && strcmp(of, wanted) == 0)
            return snprintf(out, capacity, "tests/golden/%s.png", name) < (int)capacity;
    }
    return false;
}

static json_t *effect_json(const roil *r, const char *file, const char *list) {
    const char *name = path_name(file);
    void *source;
    size_t size;
    if (!file_read(file, SOURCE_MAX, &source, &size)) return NULL;
    json_t *one = json_pack("{s:s%, s:s, s:o?}", "name", name, strlen(name) - strlen(".lua"),
                            "file", file, "summary", read_summary(source));
    mem_free(source);
    char relative[256], picture[PATH_CAP];
    if (list && find_picture(list, name, relative, sizeof relative) &&
        path_join(picture, r->home, relative) && file_exists(picture))
        json_object_set_new(one, "picture", json_string(picture));
    return one;
}

static json_t *effects_tree(const roil *r) {
    char pattern[PATH_CAP];
    file_list files = {0};
    if (!path_join(pattern, r->home, "effects/*.lua") || !file_glob(pattern, &files)) return NULL;
    if (!files.count) return ERR_NULL("%s: no effects lie there", pattern);
    char *list = read_text(r->home, "tests/golden/pictures.txt", SOURCE_MAX);
    json_t *all = json_array();
    for (size_t i = 0; i < files.count; i++) {
        json_t *one = effect_json(r, files.paths[i], list);
        if (one) json_array_append_new(all, one);
    }
    mem_free(list);
    file_list_free(&files);
    return all;
}

char *roil_info_effects_json(roil *r) {
    mem_enter();
    json_t *all = effects_tree(r);
    if (!all) return roil_leave_text(NULL);
    json_t *root = json_pack("{s:s, s:o}", "roil", roil_version(), "effects", all);
    char *text = json_text(root, JSON_INDENT(1));
    json_decref(root);
    return roil_leave_text(text);
}

static const char *text_of(const json_t *item, const char *key) {
    const char *text = json_string_value(json_object_get(item, key));
    return text ? text : "";
}

char *roil_info_effects(roil *r) {
    mem_enter();
    json_t *all = effects_tree(r);
    if (!all) return roil_leave_text(NULL);
    strbuf out = {0};
    for (size_t i = 0; i < json_array_size(all); i++) {
        const json_t *one = json_array_get(all, i);
        info_add_entry(&out, text_of(one, "name"), text_of(one, "summary"));
    }
    json_decref(all);
    strbuf_add(&out,
               "\nThey lie in %s/effects. `roil new NAME --from EFFECT` makes a folder of your own "
               "from one,\n`roil info effects -o FILE.html` a page with pictures.\n",
               r->home);
    return roil_leave_text(out.text);
}

// ---- page -------------------------------------------------------------------------------------

static void add_escaped(strbuf *out, const char *text) {
    for (; *text; text++)
        if (strchr("<>&\"'", *text))
            strbuf_add(out, "&#%d;", *text);
        else
            strbuf_append(out, text, 1);
}

static void add_card(strbuf *out, const json_t *one) {
    void *data;
    size_t size;
    strbuf_add(out, "<figure>");
    if (file_read(text_of(one, "picture"), PICTURE_MAX, &data, &size)) {
        strbuf_add(out, "<img alt=\"\" src=\"data:image/png;base64,");
        strbuf_add_base64(out, data, size);
        strbuf_add(out, "\">");
        mem_free(data);
    }
    strbuf_add(out, "<figcaption><h2>");
    add_escaped(out, text_of(one, "name"));
    strbuf_add(out, "</h2><p>");
    add_escaped(out, text_of(one, "summary"));
    strbuf_add(out, "</p><code>roil new mine --from ");
    add_escaped(out, text_of(one, "name"));
    strbuf_add(out, "</code></figcaption></figure>\n");
}

char *roil_info_effects_page(roil *r) {
    mem_enter();
    json_t *all = effects_tree(r);
    if (!all) return roil_leave_text(NULL);
    strbuf out = {0};
    strbuf_add(
        &out,
        "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Effects of roil "
        "%s</title>\n<style>\n"
        "body { margin: 32px auto; max-width: 1180px; padding: 0 24px; background: #141210; "
        "color: #ece7e1; font: 15px/1.45 system-ui, sans-serif; }\n"
        "main { display: grid; grid-template-columns: repeat(auto-fill, minmax(260px, 1fr)); "
        "gap: 20px; }\n"
        "figure { margin: 0; background: #1c1917; border-radius: 8px; overflow: hidden; }\n"
        "img { display: block; width: 100%%; }\n"
        "figcaption { padding: 10px 14px 14px; }\n"
        "h2 { font-size: 16px; margin: 0; }\np { margin: 4px 0 8px; color: #a8a096; }\n"
        "code { color: #fb923c; font-size: 13px; }\n</style>\n<h1>Effects of roil %s</h1>\n"
        "<main>\n",
        roil_version(), roil_version());
    for (size_t i = 0; i < json_array_size(all); i++) add_card(&out, json_array_get(all, i));
    strbuf_add(&out, "</main></html>\n");
    json_decref(all);
    return roil_leave_text(out.text);
}
