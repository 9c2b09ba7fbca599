// Writes the areas of widgets for programs that operate the window: a JSON file of rectangles by
// name. A name is the innermost ui_push and the widget's own id, except for "##value", in lower
// case: "density", "fire/ramp", "search".
#include "base/file.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/str.h"
#include "ui/parts.h"
#include <ctype.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DEPTH = 16, MAX_NAME = 96 };

static struct {
    char stack[MAX_DEPTH][MAX_NAME];
    int depth;
    json_t *now;
    char *written;
} marks;

static const char *file(void) {
    const char *name = getenv("ROIL_WIDGETS");
    return name && name[0] ? name : NULL;
}

void marks_push(const char *id) {
    if (marks.depth < MAX_DEPTH) str_copy(marks.stack[marks.depth], MAX_NAME, id);
    marks.depth++;
}

void marks_pop(void) {
    marks.depth--;
}

void ui_mark(const char *name, ui_rect area) {
    if (!file()) return;
    const char *own = name + strspn(name, "#");
    const char *group = marks.depth && marks.depth <= MAX_DEPTH ? marks.stack[marks.depth - 1] : "";
    bool value = strcmp(own, "value") == 0;
    strbuf full = {0};
    strbuf_add(&full, "%s%s%.*s", group, group[0] && !value ? "/" : "",
               value ? 0 : (int)strcspn(own, "#"), own);
    for (char *at = full.text; at && *at; at++) *at = (char)tolower((unsigned char)*at);
    if (!marks.now) marks.now = json_object();
    json_object_set_new(marks.now, strbuf_text(&full),
                        json_pack("[f,f,f,f]", (double)area.left, (double)area.top,
                                  (double)area.right, (double)area.bottom));
    strbuf_free(&full);
}

void marks_write(void) {
    if (!marks.now) return;
    char *text = json_text(marks.now, JSON_INDENT(1));
    if (text && (!marks.written || strcmp(text, marks.written) != 0)) {
        file_write(file(), text, strlen(text));
        mem_free(marks.written);
        marks.written = text;
    } else {
        mem_free(text);
    }
    json_decref(marks.now);
    marks.now = NULL;
}

void marks_free(void) {
    mem_free(marks.written);
    marks.written = NULL;
}
