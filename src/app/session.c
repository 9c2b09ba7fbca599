// Stores the state of the live window for the next start: a small JSON file in the user's state
// folder. Only programs write it; invalid values are ignored one by one.
#include "app/live.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_BYTES = 1 << 20, MAX_SIZE = 32768 };
static const float PANEL = 380, MIN_PANEL = 200, MAX_PANEL = 2000;
static const float LEAST_SCALE = 0.5f, MOST_SCALE = 3;

bool session_file(char *out, size_t capacity, const char *name) {
    const char *own = getenv("ROIL_STATE_DIR"), *xdg = getenv("XDG_STATE_HOME");
    const char *home = getenv("HOME");
    int length;
    if (own && own[0])
        length = snprintf(out, capacity, "%s/%s", own, name);
    else if (xdg && xdg[0] == '/')
        length = snprintf(out, capacity, "%s/roil/%s", xdg, name);
    else if (home && home[0])
        length = snprintf(out, capacity, "%s/.local/state/roil/%s", home, name);
    else
        return err_set("no folder of state: none of ROIL_STATE_DIR, XDG_STATE_HOME, HOME is set");
    if (length >= (int)capacity) return err_set("folder of state: path too long");
    return file_make_parent_folders(out);
}

// ---- load -------------------------------------------------------------------------------------

static double number(const json_t *root, const char *key, double low, double high,
                     double otherwise) {
    const json_t *value = json_object_get(root, key);
    double v = json_number_value(value);
    return json_is_number(value) && v >= low && v <= high ? v : otherwise;
}

static int whole(const json_t *root, const char *key, int low, int high, int otherwise) {
    return (int)lrint(number(root, key, low, high, otherwise));
}

static bool flag(const json_t *root, const char *key) {
    return json_is_true(json_object_get(root, key));
}

static void session_read_json(live_session *s, const json_t *root) {
    s->x = whole(root, "x", -MAX_SIZE, MAX_SIZE, 0);
    s->y = whole(root, "y", -MAX_SIZE, MAX_SIZE, 0);
    s->width = whole(root, "width", 1, MAX_SIZE, 0);
    s->height = whole(root, "height", 1, MAX_SIZE, 0);
    if (!s->height) s->width = 0;
    s->maximized = flag(root, "maximized");
    s->panel = (float)number(root, "panel", (double)MIN_PANEL, (double)MAX_PANEL, (double)PANEL);
    s->panel_hidden = flag(root, "panel_hidden");
    s->performance = flag(root, "performance");
    s->inspector = flag(root, "inspector");
    s->slices = flag(root, "slices");
    s->handles = flag(root, "handles");
    s->ground = flag(root, "ground");
    s->probe = flag(root, "probe");
    s->graph = flag(root, "graph");
    s->contrast = flag(root, "contrast");
    s->scale = (float)number(root, "scale", (double)LEAST_SCALE, (double)MOST_SCALE, 1);
    s->preview = whole(root, "preview", -1, LIVE_PREVIEWS - 1, -1);
    const char *image = json_string_value(json_object_get(root, "image"));
    if (!image || !str_copy(s->image, sizeof s->image, image)) s->image[0] = '\0';
}

void session_load(live_session *s) {
    *s = (live_session){.panel = PANEL, .preview = -1, .scale = 1};
    char path[PATH_CAP];
    void *text;
    size_t size;
    if (!session_file(path, sizeof path, "session.json") ||
        !file_read(path, MAX_BYTES, &text, &size))
        return;
    json_t *root = json_loadb(text, size, 0, NULL);
    if (json_is_object(root)) session_read_json(s, root);
    json_decref(root);
    mem_free(text);
}

void session_resize(live_session *s, float tenths) {
    s->scale = fminf(fmaxf(roundf(s->scale * 10 + tenths) / 10, LEAST_SCALE), MOST_SCALE);
}

// ---- save -------------------------------------------------------------------------------------

void session_save(const live_session *s) {
    char path[PATH_CAP];
    json_t *root = json_pack(
        "{s:i, s:i, s:i, s:i, s:b, s:f, s:b, s:b, s:b, s:b, s:b, s:b, s:b, s:b, s:b, s:f, s:s, "
        "s:i}",
        "x", s->x, "y", s->y, "width", s->width, "height", s->height, "maximized", s->maximized,
        "panel", (double)s->panel, "panel_hidden", s->panel_hidden, "performance", s->performance,
        "inspector", s->inspector, "slices", s->slices, "handles", s->handles, "ground", s->ground,
        "probe", s->probe, "graph", s->graph, "contrast", s->contrast, "scale", (double)s->scale,
        "image", s->image, "preview", s->preview);
    char *text = root ? json_text(root, JSON_INDENT(2) | JSON_REAL_PRECISION(6)) : NULL;
    if (text &&
        (!session_file(path, sizeof path, "session.json") || !file_write(path, text, strlen(text))))
        log_write(LOG_WARNING, "the window's place is not kept: %s", err_get());
    mem_free(text);
    json_decref(root);
}
