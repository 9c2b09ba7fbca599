// Recipes, which are written for every picture, and checked when they are read.
#include "effect/recipe.h"
#include "base/error.h"
#include "base/file.h"
#include "base/str.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

static const char key_effect[] = "roil:effect", key_frame[] = "roil:frame";
static const char key_size[] = "roil:size", key_settings[] = "roil:settings";

enum { NAME_MAX_LENGTH = 128, SIDE_MAX = 16384, FRAME_MAX = 1000000000 };

void recipe_write(const effect *e, double frame, uint32_t width, uint32_t height, arena *memory,
                  png_text out[RECIPE_TEXTS]) {
    strbuf settings = {0};
    for (size_t i = 0; i < effect_control_count(e); i++) {
        const effect_control *c = effect_get_control(e, i);
        if (c->moved) strbuf_add(&settings, "%s=%s\n", c->name, effect_control_setting(c));
    }
    out[0] = (png_text){"Software", "roil " ROIL_VERSION};
    out[1] = (png_text){key_effect, effect_get_facts(e)->source};
    out[2] = (png_text){key_frame, arena_format(memory, "%.17g", frame)};
    out[3] = (png_text){key_size, arena_format(memory, "%ux%u", width, height)};
    out[4] = (png_text){key_settings, arena_string(memory, strbuf_text(&settings))};
    strbuf_free(&settings);
}

// ---- reading ----------------------------------------------------------------------------------

static const char *find_text(const png_text *texts, size_t count, const char *key) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(texts[i].key, key) == 0) return texts[i].value;
    return NULL;
}

bool recipe_is_plain(const char *text) {
    for (; *text; text++)
        if (iscntrl((unsigned char)*text)) return false;
    return true;
}

bool recipe_is_effect(const char *text) {
    return recipe_is_plain(text) && (str_ends_with(text, ".lua") || str_ends_with(text, ".roil"));
}

bool recipe_stays_below(const char *path) {
    if (path[0] == '/') return false;
    for (const char *part = path; part; part = strchr(part, '/')) {
        if (*part == '/') part++;
        if (strncmp(part, "..", 2) == 0 && (part[2] == '/' || part[2] == '\0')) return false;
    }
    return true;
}

static bool read_file(const char *text, arena *memory, recipe *out) {
    if (!recipe_is_effect(text) || strlen(text) >= PATH_CAP)
        return err_set("the recipe's effect is no .lua file and no bundle");
    out->file = recipe_stays_below(text) ? arena_string(memory, text) : NULL;
    return true;
}

static bool read_frame(const char *text, recipe *out) {
    char *end;
    out->frame = isdigit((unsigned char)text[0]) ? str_double(text, &end) : -1;
    if (out->frame >= 0 && out->frame <= FRAME_MAX && !*end) return true;
    return err_set("the recipe's frame is '%.32s'; accepted: 0 to %d", text, FRAME_MAX);
}

static bool read_size(const char *text, recipe *out) {
    char rest;
    if (isdigit((unsigned char)text[0]) &&
        sscanf(text, "%5ux%5u%c", &out->width, &out->height, &rest) == 2 && out->width >= 1 &&
        out->height >= 1 && out->width <= SIDE_MAX && out->height <= SIDE_MAX)
        return true;
    return err_set("the recipe's size is '%.32s'; accepted: 1x1 to %dx%d", text, SIDE_MAX,
                   SIDE_MAX);
}

bool recipe_is_name(const char *text) {
    size_t length = strlen(text);
    if (length == 0 || length > NAME_MAX_LENGTH) return false;
    for (; *text; text++)
        if (!isalnum((unsigned char)*text) && *text != '_' && *text != '.') return false;
    return true;
}

static bool read_settings(const char *text, arena *memory, recipe *out) {
    size_t capacity = 1;
    for (const char *at = text; *at; at++) capacity += *at == '\n';
    if (capacity > RECIPE_MAX_SETTINGS + 1)
        return err_set("the recipe has more than %d settings", RECIPE_MAX_SETTINGS);
    out->settings = arena_alloc(memory, capacity * sizeof *out->settings);
    for (char *line = arena_string(memory, text); *line;) {
        char *next = line + strcspn(line, "\n");
        if (*next) *next++ = '\0';
        char *equals = strchr(line, '=');
        if (equals) *equals = '\0';
        if (!equals || !recipe_is_name(line) || !recipe_is_plain(equals + 1))
            return err_set("setting %zu of the recipe is wrong; accepted: NAME=VALUE",
                           out->setting_count + 1);
        out->settings[out->setting_count++] = (effect_setting){.name = line, .text = equals + 1};
        line = next;
    }
    return true;
}

bool recipe_read(const png_text *texts, size_t count, arena *memory, recipe *out) {
    *out = (recipe){0};
    const char *file = find_text(texts, count, key_effect),
               *frame = find_text(texts, count, key_frame);
    const char *size = find_text(texts, count, key_size),
               *settings = find_text(texts, count, key_settings);
    if (!file || !frame || !size)
        return err_set("the picture has no recipe of how it was made; pictures of `roil render` "
                       "and of the window do");
    return read_file(file, memory, out) && read_frame(frame, out) && read_size(size, out) &&
           (!settings || read_settings(settings, memory, out));
}
