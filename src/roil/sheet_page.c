// The page of a sheet: one HTML file with the description and the pictures inside, made of
// scripts/sheet/page.html.
#include "base/error.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "roil/sheet.h"
#include <string.h>

enum { MOST_BYTES = 1 << 30, MOST_TEMPLATE = 1 << 20 };

static const char mark[] = "@DATA@";

static void add_base64(strbuf *out, const uint8_t *data, size_t size) {
    static const char letters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t bits = (uint32_t)data[i] << 16;
        if (i + 1 < size) bits |= (uint32_t)data[i + 1] << 8;
        if (i + 2 < size) bits |= data[i + 2];
        char four[4] = {letters[bits >> 18], letters[bits >> 12 & 63], letters[bits >> 6 & 63],
                        letters[bits & 63]};
        if (i + 1 >= size) four[2] = '=';
        if (i + 2 >= size) four[3] = '=';
        strbuf_append(out, four, sizeof four);
    }
}

// "</script>" in a name would end the element that the text stands in.
static void add_json(strbuf *out, const json_t *value) {
    char *text = json_text(value, JSON_COMPACT | JSON_ENCODE_ANY | JSON_REAL_PRECISION(7));
    for (const char *at = text; at && *at; at++) {
        if (*at == '<')
            strbuf_add(out, "\\u003c");
        else
            strbuf_append(out, at, 1);
    }
    mem_free(text);
}

static bool add_picture(const char *folder, const json_t *name, strbuf *out) {
    char path[PATH_CAP];
    void *bytes;
    size_t size;
    if (!path_join(path, folder, json_string_value(name)))
        return err_set("%s: the path is too long", json_string_value(name));
    if (!file_read(path, MOST_BYTES, &bytes, &size)) return false;
    add_json(out, name);
    strbuf_add(out, ":\"data:image/png;base64,");
    add_base64(out, bytes, size);
    strbuf_add(out, "\"");
    mem_free(bytes);
    return true;
}

static bool add_data(const roil_sheet *s, const char *file, const json_t *description,
                     strbuf *out) {
    char folder[PATH_CAP];
    bool done = true;
    path_folder(folder, file);
    strbuf_add(out, "{\"description\":");
    add_json(out, description);
    strbuf_add(out, ",\"pictures\":{");
    for (size_t i = 0; done && i < json_array_size(s->files); i++) {
        if (i) strbuf_add(out, ",");
        done = add_picture(folder, json_object_get(json_array_get(s->files, i), "file"), out);
    }
    strbuf_add(out, "}}");
    return done;
}

bool sheet_write_page(const roil_sheet *s, const char *page, const char *file,
                      json_t *description) {
    char *line = sheet_recipe(s, page);
    if (line) json_object_set_new(description, "made", json_loads(line, 0, NULL));
    mem_free(line);
    char path[PATH_CAP];
    void *template;
    size_t size;
    if (!path_join(path, s->owner->owner->scripts, "sheet/page.html"))
        return err_set("%s: the path is too long", s->owner->owner->scripts);
    if (!file_read(path, MOST_TEMPLATE, &template, &size)) return false;
    strbuf text = {0};
    const char *begin = template, *at = memmem(template, size, mark, strlen(mark));
    bool done = at || err_set("%s: no %s in it", path, mark);
    if (done) {
        strbuf_append(&text, begin, (size_t)(at - begin));
        done = add_data(s, file, description, &text);
        at += strlen(mark);
        strbuf_append(&text, at, size - (size_t)(at - begin));
    }
    done =
        done && file_make_parent_folders(page) && file_write(page, strbuf_text(&text), text.length);
    strbuf_free(&text);
    mem_free(template);
    return done;
}
