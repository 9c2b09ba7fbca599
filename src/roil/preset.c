// Presets beside an effect: "explosion.presets/NAME.lua".
#include "script/preset.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/words.h"
#include "roil/roil_impl.h"
#include <ctype.h>
#include <string.h>

enum { NAME_CAP = 64 };

typedef struct owned_preset { // a roil_preset first: what roil_read_preset gives
    roil_preset preset;
    arena memory;
} owned_preset;

static bool is_name(const char *text, size_t length) {
    if (length == 0 || length >= NAME_CAP || *text == '-') return false;
    for (size_t i = 0; i < length; i++)
        if (!isalnum((unsigned char)text[i]) && text[i] != '_' && text[i] != '-') return false;
    return true;
}

// "effects/explosion.lua", "warm" -> "effects/explosion.presets/warm.lua"
static bool preset_path(char out[PATH_CAP], const char *effect_file, const char *name) {
    size_t stem = strlen(effect_file);
    if (str_ends_with(effect_file, ".lua")) stem -= 4;
    strbuf path = {0};
    strbuf_append(&path, effect_file, stem);
    strbuf_add(&path, ".presets/%s.lua", name);
    bool fits = str_copy(out, PATH_CAP, strbuf_text(&path));
    strbuf_free(&path);
    return fits || path_too_long(effect_file);
}

static size_t list_presets(const char *effect_file, char (*names)[64], size_t capacity) {
    char pattern[PATH_CAP];
    file_list files;
    roil_origin origin;
    if (!roil_find_origin(NULL, effect_file, &origin) || !preset_path(pattern, origin.file, "*") ||
        !file_glob(pattern, &files))
        return 0;
    size_t count = 0;
    for (size_t i = 0; i < files.count; i++) {
        const char *name = path_name(files.paths[i]);
        size_t length = strlen(name) - strlen(".lua");
        if (!is_name(name, length)) continue;
        if (count < capacity) {
            memcpy(names[count], name, length);
            names[count][length] = '\0';
        }
        count++;
    }
    file_list_free(&files);
    return count;
}

size_t roil_presets(const char *effect_file, char (*names)[64], size_t capacity) {
    mem_enter();
    return roil_leave_count(list_presets(effect_file, names, capacity));
}

// ---- reading ------------------------------------------------------------------------------------

static void refuse_preset(const char *effect_file, const char *name) {
    enum { MOST = 256 };
    char(*names)[64] = mem_alloc(MOST * sizeof *names);
    const char *known[MOST];
    size_t count = roil_presets(effect_file, names, MOST);
    if (count > MOST) count = MOST;
    for (size_t i = 0; i < count; i++) known[i] = names[i];
    strbuf list = {0};
    strbuf_add(&list, "it has ");
    words_print(known, count, &list);
    if (count)
        words_refuse(known, count, name, strbuf_text(&list), "%s has no preset '%.64s'",
                     effect_file, name);
    else
        err_set("%s has no presets, so no '%.64s'; a .lua file of settings can be named, too",
                effect_file, name);
    strbuf_free(&list);
    mem_free(names);
}

bool roil_preset_path(char out[PATH_CAP], const char *effect_file, const char *preset) {
    if (str_ends_with(preset, ".lua"))
        return str_copy(out, PATH_CAP, preset) || path_too_long(preset);
    if (!is_name(preset, strlen(preset)))
        return err_set("preset '%.64s' is not a name (letters, digits, _ and -), nor a .lua file",
                       preset);
    roil_origin origin;
    return roil_find_origin(NULL, effect_file, &origin) && preset_path(out, origin.file, preset);
}

static roil_preset *read_preset(roil *r, const char *effect_file, const char *preset) {
    (void)r;
    char path[PATH_CAP];
    if (!roil_preset_path(path, effect_file, preset)) return NULL;
    if (!str_ends_with(preset, ".lua") && !file_exists(path)) {
        refuse_preset(effect_file, preset);
        return NULL;
    }
    char folder[PATH_CAP], root[PATH_CAP];
    path_folder(folder, path);
    path_folder(root, folder); // of the effect
    owned_preset *own = mem_alloc(sizeof *own);
    effect_setting *settings;
    size_t count;
    if (!preset_read(str_ends_with(preset, ".lua") ? NULL : root, path, &own->memory, &settings,
                     &count)) {
        roil_free_preset(&own->preset);
        return NULL;
    }
    roil_setting *list = arena_alloc(&own->memory, count * sizeof *list);
    for (size_t i = 0; i < count; i++) list[i] = (roil_setting){settings[i].name, settings[i].text};
    own->preset = (roil_preset){list, count};
    return &own->preset;
}

roil_preset *roil_read_preset(roil *r, const char *effect_file, const char *preset) {
    RETURN_MADE(roil_preset, read_preset(r, effect_file, preset), roil_free_preset(made));
}

void roil_free_preset(roil_preset *preset) {
    if (!preset) return;
    owned_preset *own = (owned_preset *)preset;
    arena_free(&own->memory);
    mem_free(own);
}

// ---- writing ------------------------------------------------------------------------------------

static void print_preset(const roil_effect *e, const char *name, strbuf *out) {
    const char *file = path_name(effect_get_facts(e->effect)->file);
    int length = (int)strcspn(file, "\r\n"); // it stands in a comment
    strbuf_add(out, "-- Preset of %.*s, for --preset %s.\nreturn {\n", length, file, name);
    for (size_t i = 0; i < effect_control_count(e->effect); i++) {
        const effect_control *c = effect_get_control(e->effect, i);
        if (!c->moved || strncmp(c->name, "camera.", 7) == 0) continue;
        if (c->kind == EFFECT_CONTROL_EVENTS) continue; // what was done, not how it looks
        strbuf_add(out, "  ");
        roil_add_lua_key(c->name, out);
        roil_add_lua(e, c, false, out);
        strbuf_add(out, ",\n");
    }
    strbuf_add(out, "}\n");
}

bool roil_write_preset(roil_effect *e, const char *name) {
    mem_enter();
    char path[PATH_CAP], root[PATH_CAP];
    if (!is_name(name, strlen(name)))
        return mem_leave(err_set("preset '%.64s' is not a name (letters, digits, _ and -)", name));
    if (!roil_may_write(e) || !preset_path(path, effect_get_facts(e->effect)->file, name))
        return mem_leave(false);
    path_folder(root, effect_get_facts(e->effect)->file);
    strbuf text = {0};
    print_preset(e, name, &text);
    bool done = file_write_inside(root, path, text.text, text.length);
    strbuf_free(&text);
    return mem_leave(done);
}
