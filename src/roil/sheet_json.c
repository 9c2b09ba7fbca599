// The description of a sheet: all that whoever plays it has to know.
#include "base/memory.h"
#include "roil/sheet.h"
#include <string.h>

json_t *sheet_text(const char *from) {
    json_t *value = json_string(from);
    if (value) return value;
    char *clean = mem_copy(from, strlen(from) + 1);
    for (char *at = clean; *at; at++)
        if ((unsigned char)*at >= 128) *at = '?';
    value = json_string(clean);
    mem_free(clean);
    return value;
}

static json_t *pair(double a, double b) {
    return json_pack("[f, f]", a, b);
}

static json_t *camera(const roil_sheet *s) {
    json_t *all = json_object();
    static const char *const names[] = {"right", "up", "towards_camera"};
    for (int i = 0; i < 3; i++)
        json_object_set_new(all, names[i],
                            json_pack("[f, f, f]", (double)s->axes[i][0], (double)s->axes[i][1],
                                      (double)s->axes[i][2]));
    return all;
}

static json_t *lines(const char *const *from, size_t count, const char *file) {
    json_t *all = json_array();
    for (size_t i = 0; i < count; i++) {
        const char *mark = strstr(from[i], "%s");
        strbuf line = {0};
        if (mark)
            strbuf_add(&line, "%.*s%s%s", (int)(mark - from[i]), from[i], path_name(file),
                       mark + 2);
        else
            strbuf_add(&line, "%s", from[i]);
        json_array_append_new(all, sheet_text(strbuf_text(&line)));
        strbuf_free(&line);
    }
    return all;
}

char *sheet_recipe(const roil_sheet *s, const char *file) {
    static const char *const none[] = {NULL};
    const double frame = s->owner->shown;
    return roil_describe(s->owner, &(roil_making){.kind = "sheet",
                                                  .sheet = s->name,
                                                  .part = path_name(file),
                                                  .settings = s->settings,
                                                  .first = frame,
                                                  .last = frame,
                                                  .step = 1,
                                                  .options = s->made ? s->made : none});
}

static const char no_recipe[] = "\"made\": null";

void sheet_add_recipe(const roil_sheet *s, const char *file, const char *text, strbuf *out) {
    const char *at = strstr(text, no_recipe);
    char *line = at ? sheet_recipe(s, file) : NULL;
    if (line) {
        strbuf_append(out, text, (size_t)(at - text));
        strbuf_add(out, "\"made\": %s", line);
        text = at + strlen(no_recipe);
    }
    strbuf_append(out, text, strlen(text));
    mem_free(line);
}

json_t *sheet_describe(const roil_sheet *s, const char *file, const roil_sheet_options *options,
                       const sheet_engine *engine) {
    const sheet_area *a = &s->area;
    const double width = a->right - a->left, height = a->bottom - a->top, cell = s->cell;
    const double metres = (double)s->height / cell;
    json_t *all = json_object();
    json_object_set_new(all, "effect", sheet_text(effect_get_facts(s->owner->effect)->name));
    json_object_set_new(all, "version", json_string(roil_version()));
    json_object_set_new(all, "made", json_null()); // sheet_add_recipe
    json_object_set_new(all, "grid", json_pack("[i, i]", (int)s->columns, (int)s->rows));
    json_object_set_new(all, "order", json_string("left to right, top to bottom"));
    json_object_set_new(all, "frames", json_integer(s->used));
    json_object_set_new(all, "fps", json_real(options->fps));
    if (options->loop > 0) json_object_set_new(all, "loop_seconds", json_real(options->loop));
    if (s->fade)
        json_object_set_new(all, "dissolve",
                            json_pack("{s:i, s:s}", "cells", (int)s->fade, "blend",
                                      s->flows ? "moved along optical flow" : "in place"));
    json_object_set_new(all, "cell", pair(width, height));
    json_object_set_new(all, "gutter", json_integer(s->gutter));
    json_object_set_new(all, "size_m", pair(width * metres, height * metres));
    json_object_set_new(all, "pivot",
                        pair(((double)s->pivot[0] * cell - a->left) / width,
                             ((double)s->pivot[1] * cell - a->top) / height));
    json_object_set_new(
        all, "crop",
        json_pack("[i, i, i, i]", (int)a->left, (int)a->top, (int)a->right, (int)a->bottom));
    json_object_set_new(all, "camera", camera(s));
    json_object_set(all, "maps", s->files);
    if (engine->name) {
        size_t count = 0;
        while (engine->steps[count]) count++;
        json_object_set_new(all, "engine", json_string(engine->title));
        json_object_set_new(all, "steps", lines(engine->steps, count, file));
    }
    if (options->note_count)
        json_object_set_new(all, "notes", lines(options->notes, options->note_count, file));
    return all;
}
