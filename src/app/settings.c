// Settings of an effect from the command line: a picture's recipe, presets, single values.
#include "app/app.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>

void app_add_preset(app_settings *s, const char *preset) {
    *MEM_ADD(s->presets, s->preset_count, s->preset_capacity) = preset;
}

bool app_add_set(app_settings *s, char *text) {
    char *equals = strchr(text, '=');
    if (!equals || equals == text) return err_set("--set '%s'; accepted: NAME=VALUE", text);
    *equals = '\0';
    *MEM_ADD(s->sets, s->set_count, s->set_capacity) = (roil_setting){text, equals + 1};
    return true;
}

void app_add_event(app_settings *s, const char *text) {
    size_t i = 0, before = s->events ? strlen(s->events) : 0;
    while (i < s->set_count && s->sets[i].value != s->events) i++;
    char *joined = mem_alloc(before + strlen(text) + 3);
    if (before) memcpy(joined, s->events, before);
    snprintf(joined + before, strlen(text) + 3, "%s%s", before ? "; " : "", text);
    if (i == s->set_count) {
        MEM_RESERVE(s->sets, s->set_count + 1, s->set_capacity);
        s->set_count++;
    }
    s->sets[i] = (roil_setting){"effect.events", joined};
    mem_free(s->events);
    s->events = joined;
}

static void add_all(app_settings *s, const roil_setting *settings, size_t count) {
    MEM_RESERVE(s->all, s->count + count, s->capacity);
    for (size_t i = 0; i < count; i++) s->all[s->count++] = settings[i];
}

static void settings_clear(app_settings *s) { // what was collected before
    for (size_t i = 0; i < s->loaded_count; i++) roil_free_preset(s->loaded[i]);
    mem_free(s->loaded);
    s->loaded = NULL;
    s->loaded_count = s->count = 0;
}

static bool refuse_missing(const char *effect) {
    strbuf pattern = {0};
    strbuf_append(&pattern, effect, (size_t)(path_name(effect) - effect));
    strbuf_add(&pattern, "*.lua");
    file_list beside = {0};
    const char *near = file_glob(strbuf_text(&pattern), &beside)
                           ? str_nearest(effect, (const char *const *)beside.paths, beside.count)
                           : NULL;
    if (near)
        err_set("%s: %s; did you mean '%s'?", effect, strerror(ENOENT), near);
    else
        err_set("%s: %s", effect, strerror(ENOENT));
    file_list_free(&beside);
    strbuf_free(&pattern);
    return false;
}

bool app_check_effect(const char *file) {
    static const struct {
        const char *ending, *is;
    } others[] = {
        {".png", "a picture; `roil render --from` draws one again by what it holds"},
        {".exr", "a picture; an effect is a .lua file"},
        {".mp4", "a video; an effect is a .lua file"},
        {".vdb", "a volume; `roil info` tells about it, and an effect reads it by `vdb`"},
    };
    if (file_is_folder(file)) return err_set("%s is a folder; an effect is a .lua file", file);
    for (size_t i = 0; i < COUNT_OF(others); i++)
        if (str_ends_with(file, others[i].ending)) return err_set("%s is %s", file, others[i].is);
    return file_exists(file) || refuse_missing(file);
}

bool app_collect_settings(app_settings *s, roil *r, const char *effect, const roil_recipe *from) {
    settings_clear(s);
    if (!app_check_effect(effect)) return false;
    s->loaded = mem_alloc(s->preset_count * sizeof *s->loaded);
    if (from) add_all(s, from->settings, from->setting_count);
    for (size_t i = 0; i < s->preset_count; i++) {
        roil_preset *preset = roil_read_preset(r, effect, s->presets[i]);
        if (!preset) return false;
        s->loaded[s->loaded_count++] = preset;
        add_all(s, preset->settings, preset->count);
    }
    add_all(s, s->sets, s->set_count);
    return true;
}

void app_free_settings(app_settings *s) {
    settings_clear(s);
    mem_free(s->presets);
    mem_free(s->sets);
    mem_free(s->events);
    mem_free(s->all);
    *s = (app_settings){0};
}

bool app_declares_effect(const char *path) {
    void *text;
    size_t size;
    if (!file_read(path, 1 << 20, &text, &size)) return false;
    bool found = false;
    for (const char *at = text; !found && (at = strstr(at, "effect")); at++) {
        const char *next = at + 6 + strspn(at + 6, " ");
        found = *next == '{' || *next == '(';
    }
    mem_free(text);
    return found;
}
