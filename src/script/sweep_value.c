// Sweeps: reads what the values of a file set in rows.
#include "base/frames.h"
#include "base/memory.h"
#include "base/words.h"
#include "script/binding.h"
#include "script/setting.h"
#include "script/sweep_parts.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_MAX = 65536, MAX_EDITS = 256, MAX_SIDE = 16384, MAX_REPEATS = 100000 };
static const double MAX_SECONDS = 86400;

static const char *const special_keys[] = {"effect",  "size",  "frames", "time",    "warmup",
                                           "repeats", "limit", "edit",   "command", "cache"};

bool sweep_is_special(const char *key) {
    return words_find(special_keys, COUNT_OF(special_keys), key) >= 0;
}

sweep_patch sweep_patch_empty(void) {
    return (sweep_patch){.warmup = -1, .repeats = -1, .limit = -1, .empty_cache = -1};
}

// ---- plain values -----------------------------------------------------------------------------

_Noreturn static void wrong(lua_State *L, const char *who, const char *key, const char *accepted) {
    vm_error(L, "%s: '%.64s' must be %s; got %s", who, key, accepted, object_kind(L, -1));
}

double sweep_take_number(lua_State *L, const char *who, const char *key, double min, double max) {
    if (lua_type(L, -1) != LUA_TNUMBER) wrong(L, who, key, "a number");
    double value = lua_tonumber(L, -1);
    if (!(value >= min && value <= max))
        vm_error(L, "%s: '%s' is %g; %g to %g are accepted", who, key, value, min, max);
    return value;
}

uint32_t sweep_take_count(lua_State *L, const char *who, const char *key, uint32_t min,
                          uint32_t max) {
    double value = sweep_take_number(L, who, key, min, max);
    if (value != floor(value))
        vm_error(L, "%s: '%s' is %g; a whole number is accepted", who, key, value);
    return (uint32_t)value;
}

static const char *keep(lua_State *L, const char *text) {
    vm_charge_memory(L, strlen(text) + 1);
    return arena_string(sweep_reader_of(L)->memory, text);
}

// Texts of a file are shown on terminals and in tables. `lines`: it may contain line breaks.
static const char *take_text(lua_State *L, const char *who, const char *key, bool lines) {
    size_t length;
    if (lua_type(L, -1) != LUA_TSTRING) wrong(L, who, key, "a text in quotes");
    const char *text = lua_tolstring(L, -1, &length);
    if (length > TEXT_MAX)
        vm_error(L, "%s: '%s' has %d bytes; at most %d are accepted", who, key, (int)length,
                 TEXT_MAX);
    for (size_t i = 0; i < length; i++)
        if (iscntrl((unsigned char)text[i]) && !(lines && (text[i] == '\n' || text[i] == '\t')))
            vm_error(L, "%s: '%s' must be one line of text", who, key);
    return keep(L, text);
}

const char *sweep_take_text(lua_State *L, const char *who, const char *key) {
    return take_text(L, who, key, false);
}

static int take_word(lua_State *L, const char *who, const char *key, const char *const *words,
                     size_t count) {
    const char *word = sweep_take_text(L, who, key);
    int found = words_find(words, count, word);
    if (found >= 0) return found;
    value_unknown(L, who, lua_pushfstring(L, "value of '%s'", key), word, words, count);
}

// ---- special keys -----------------------------------------------------------------------------

// Strangers' sweeps open no effects but those beside them, those of the folder that the user works
// in, and the program's own. Shown relative to the current folder where it lies there.
static void take_effect(lua_State *L, const char *who, sweep_patch *patch) {
    sweep_reader *r = sweep_reader_of(L);
    const char *name = sweep_take_text(L, who, "effect");
    char path[PATH_CAP], real[PATH_CAP], here[PATH_CAP];
    if (!path_join(path, r->folder, name)) vm_error(L, "%s: %s", who, err_get());
    if (!file_exists(path) || !realpath(path, real) || !realpath(".", here))
        vm_error(L, "%s: effect '%.256s': there is no file %s (paths begin at the sweep's folder)",
                 who, name, path);
    const char *const folders[] = {r->folder, here, r->options->home};
    patch->inside = NULL;
    for (size_t i = 0; i < COUNT_OF(folders) && !patch->inside; i++)
        if (folders[i] && path_require_inside(folders[i], real))
            patch->inside = keep(L, folders[i]);
    if (!patch->inside)
        vm_error(L,
                 "%s: effect '%.256s' lies neither in the sweep's folder nor in the current one "
                 "(run roil where both are)",
                 who, name);
    size_t length = strlen(here);
    bool below = strncmp(real, here, length) == 0 && real[length] == '/';
    patch->effect = keep(L, below ? real + length + 1 : real);
}

static void take_size(lua_State *L, const char *who, sweep_patch *patch) {
    uint32_t side[2];
    if (lua_type(L, -1) != LUA_TTABLE || lua_rawlen(L, -1) != 2)
        wrong(L, who, "size", "{width, height}");
    for (int i = 0; i < 2; i++) {
        lua_rawgeti(L, -1, i + 1);
        side[i] = sweep_take_count(L, who, "size", 1, MAX_SIDE);
        lua_pop(L, 1);
    }
    patch->width = side[0];
    patch->height = side[1];
}

// Frames are parsed into memory that a Lua error would lose, so they are copied at once.
static void take_frame_text(lua_State *L, const char *who, sweep_patch *patch) {
    const char *text = sweep_take_text(L, who, "frames");
    double *numbers;
    size_t count;
    if (!frames_parse(text, &numbers, &count)) vm_error(L, "%s: %s", who, err_get());
    if (count <= SWEEP_MAX_FRAMES)
        patch->frames =
            arena_copy(sweep_reader_of(L)->memory, numbers, count * sizeof *patch->frames);
    mem_free(numbers);
    patch->frame_count = count;
    if (count > SWEEP_MAX_FRAMES)
        vm_error(L, "%s: %d frames; at most %d are accepted", who, (int)count, SWEEP_MAX_FRAMES);
    vm_charge_memory(L, count * sizeof *patch->frames);
}

static void take_frame_list(lua_State *L, const char *who, sweep_patch *patch) {
    lua_Unsigned count = lua_type(L, -1) == LUA_TTABLE ? lua_rawlen(L, -1) : 0;
    if (count < 1 || count > SWEEP_MAX_FRAMES)
        wrong(L, who, "frames", "a number, a text as \"1-100\" or a list {10, 30}");
    patch->frames = sweep_reserve(L, count, sizeof *patch->frames);
    patch->frame_count = count;
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, -1, (lua_Integer)i + 1);
        patch->frames[i] = sweep_take_number(L, who, "frames", 0, 1e9);
        lua_pop(L, 1);
    }
}

static void take_frames(lua_State *L, const char *who, sweep_patch *patch) {
    patch->first = patch->last = 0;
    switch (lua_type(L, -1)) {
    case LUA_TNUMBER:
        patch->frames = sweep_reserve(L, 1, sizeof *patch->frames);
        patch->frames[0] = sweep_take_number(L, who, "frames", 0, 1e9);
        patch->frame_count = 1;
        return;
    case LUA_TSTRING:
        take_frame_text(L, who, patch);
        return;
    default:
        take_frame_list(L, who, patch);
    }
}

static void take_time(lua_State *L, const char *who, sweep_patch *patch) {
    double time[2];
    if (lua_type(L, -1) != LUA_TTABLE || lua_rawlen(L, -1) != 2)
        wrong(L, who, "time", "{first, last} in seconds");
    for (int i = 0; i < 2; i++) {
        lua_rawgeti(L, -1, i + 1);
        time[i] = sweep_take_number(L, who, "time", 0, MAX_SECONDS);
        lua_pop(L, 1);
    }
    if (time[1] <= time[0])
        vm_error(L, "%s: time {%g, %g} ends before it begins", who, time[0], time[1]);
    patch->first = time[0];
    patch->last = time[1];
    patch->frames = NULL;
    patch->frame_count = 0;
}

static void take_edits(lua_State *L, const char *who, sweep_patch *patch) {
    lua_Unsigned count = lua_type(L, -1) == LUA_TTABLE ? lua_rawlen(L, -1) : 0;
    if (count < 2 || count > MAX_EDITS)
        wrong(L, who, "edit", "a list {text of the effect, text in its place, ...}");
    patch->edits = sweep_reserve(L, count, sizeof *patch->edits);
    patch->edit_count = count;
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, -1, (lua_Integer)i + 1);
        patch->edits[i] = take_text(L, who, "edit", true);
        lua_pop(L, 1);
    }
    if (!patch->edits[0][0]) vm_error(L, "%s: 'edit' replaces an empty text", who);
}

static void take_special(lua_State *L, const char *who, const char *key, sweep_patch *patch) {
    static const char *const commands[] = {"check", "render"}, *const caches[] = {"warm", "empty"};
    if (strcmp(key, "effect") == 0)
        take_effect(L, who, patch);
    else if (strcmp(key, "size") == 0)
        take_size(L, who, patch);
    else if (strcmp(key, "frames") == 0)
        take_frames(L, who, patch);
    else if (strcmp(key, "time") == 0)
        take_time(L, who, patch);
    else if (strcmp(key, "warmup") == 0)
        patch->warmup = (int)sweep_take_count(L, who, key, 0, 1000);
    else if (strcmp(key, "repeats") == 0)
        patch->repeats = (int)sweep_take_count(L, who, key, 1, MAX_REPEATS);
    else if (strcmp(key, "limit") == 0)
        patch->limit = sweep_take_number(L, who, key, 0, MAX_SECONDS);
    else if (strcmp(key, "edit") == 0)
        take_edits(L, who, patch);
    else if (strcmp(key, "command") == 0)
        patch->command = commands[take_word(L, who, key, commands, COUNT_OF(commands))];
    else
        patch->empty_cache = take_word(L, who, key, caches, COUNT_OF(caches));
}

// ---- settings ---------------------------------------------------------------------------------

static const char *setting_text_of(lua_State *L, const char *who, const char *key) {
    strbuf *text = &sweep_reader_of(L)->text;
    text->length = 0;
    strbuf_append(text, "", 0);
    setting_add_text(L, &(setting_text){who, key, text});
    return keep(L, strbuf_text(text));
}

static void take_setting(lua_State *L, const char *who, const char *key, sweep_patch *patch) {
    if (!*key || !setting_is_name(key))
        vm_error(L, "%s: '%.64s' is no name of a setting (letters, digits, _ and .)", who, key);
    if (patch->setting_count >= SWEEP_MAX_SETTINGS)
        vm_error(L, "%s: more than %d settings", who, SWEEP_MAX_SETTINGS);
    sweep_pair *more = sweep_reserve(L, patch->setting_count + 1, sizeof *more);
    if (patch->setting_count) memcpy(more, patch->settings, patch->setting_count * sizeof *more);
    more[patch->setting_count++] = (sweep_pair){keep(L, key), setting_text_of(L, who, key)};
    patch->settings = more;
}

void sweep_patch_take(lua_State *L, const char *who, const char *key, sweep_patch *patch) {
    if (sweep_is_special(key))
        take_special(L, who, key, patch);
    else
        take_setting(L, who, key, patch);
}

void sweep_patch_take_settings(lua_State *L, int table, const char *who, sweep_patch *patch) {
    table = lua_absindex(L, table);
    if (!value_is_plain_table(L, table) || lua_rawlen(L, table) > 0)
        vm_error(L, "%s: settings have names, as in { steps = 64, [\"march.mode\"] = \"paper\" }",
                 who);
    size_t count;
    const char **names = value_names(L, table, who, &count);
    for (size_t i = 0; i < count; i++) {
        value_get(L, table, names[i]);
        take_setting(L, who, names[i], patch);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

// ---- values of an axis ------------------------------------------------------------------------

// { name = "coarse", steps = 16, size = {960, 540}, set = { size = 2 } }
static void take_named(lua_State *L, const char *who, sweep_value *out) {
    int table = lua_gettop(L);
    size_t count;
    const char **names = value_names(L, table, who, &count);
    for (size_t i = 0; i < count; i++) {
        value_get(L, table, names[i]);
        if (strcmp(names[i], "name") == 0)
            out->text = sweep_take_text(L, who, "name");
        else if (strcmp(names[i], "set") == 0)
            sweep_patch_take_settings(L, -1, who, &out->patch);
        else
            sweep_patch_take(L, who, names[i], &out->patch);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    if (!out->text || !out->text[0])
        vm_error(L,
                 "%s: a value of several settings has a name, as in { name = \"coarse\", steps "
                 "= 16 }",
                 who);
    out->label = out->text;
    out->named = true;
}

static const char *format(lua_State *L, const char *first, const char *second) {
    sweep_reader *r = sweep_reader_of(L);
    vm_charge_memory(L, strlen(first) + strlen(second) + 2);
    return arena_format(r->memory, "%s %s", first, second);
}

static const char *stem(lua_State *L, const char *path) {
    int length;
    const char *name = path_stem(path, &length);
    return keep(L, lua_pushlstring(L, name, (size_t)length));
}

static const char *special_text(lua_State *L, const char *key, const sweep_patch *patch) {
    if (strcmp(key, "effect") == 0) return stem(L, patch->effect);
    if (strcmp(key, "size") == 0)
        return keep(L, lua_pushfstring(L, "%dx%d", (int)patch->width, (int)patch->height));
    if (strcmp(key, "time") == 0) {
        char text[64];
        snprintf(text, sizeof text, "%g-%g s", patch->first, patch->last);
        return keep(L, text);
    }
    if (lua_type(L, -1) == LUA_TTABLE)
        return keep(L, lua_pushfstring(L, "%d values", (int)lua_rawlen(L, -1)));
    return keep(L, luaL_tolstring(L, -1, NULL));
}

static const char *label_of(lua_State *L, const sweep_list *of, const sweep_value *v) {
    bool says_itself =
        v->type == LUA_TSTRING || strcmp(of->name, "size") == 0 || strcmp(of->name, "effect") == 0;
    return says_itself && strcmp(of->name, "frames") != 0 ? v->text : format(L, of->label, v->text);
}

void sweep_value_take(lua_State *L, const char *who, const sweep_list *of, sweep_value *out) {
    int top = lua_gettop(L);
    *out = (sweep_value){.patch = sweep_patch_empty(), .type = lua_type(L, -1)};
    out->number = out->type == LUA_TNUMBER    ? lua_tonumber(L, -1)
                  : out->type == LUA_TBOOLEAN ? lua_toboolean(L, -1)
                                              : 0;
    luaL_checkstack(L, 16, "axis");
    if (out->type == LUA_TTABLE && value_has_names(L, -1) && lua_rawlen(L, -1) == 0) {
        take_named(L, who, out);
    } else if (sweep_is_special(of->name)) {
        sweep_patch_take(L, who, of->name, &out->patch);
        out->text = special_text(L, of->name, &out->patch);
        out->label = label_of(L, of, out);
    } else {
        sweep_patch_take(L, who, of->name, &out->patch);
        out->text = out->patch.settings[0].text;
        out->label = label_of(L, of, out);
    }
    out->said = out->text;
    lua_settop(L, top);
}
