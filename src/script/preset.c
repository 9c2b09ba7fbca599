// Presets: a table of settings.
#include "script/preset.h"
#include "base/file.h"
#include "script/binding.h"
#include "script/setting.h"

enum { MEMORY_LIMIT = 8 << 20, INSTRUCTION_LIMIT = 5000000 };

typedef struct reader {      // outlives the errors that Lua raises
    const char *root, *path; // root: NULL when the user named the file
    arena *memory;
    effect_setting *settings;
    size_t count;
    strbuf text; // of the value being read
} reader;

static int read_preset(lua_State *L) {
    reader *r = lua_touserdata(L, 1);
    luaL_checkstack(L, 16, "preset");
    vm_load_chunk(L, r->root, r->path, r->path, false);
    lua_call(L, 0, 1);
    if (!value_is_plain_table(L, -1))
        vm_error(L, "%s: a preset returns a table, as in return { density = 30 }", r->path);
    size_t count;
    int table = lua_gettop(L);
    if (lua_rawlen(L, table) > 0)
        vm_error(L, "%s: a preset has names, as in return { density = 30 }", r->path);
    const char **names = value_names(L, table, r->path, &count);
    if (count > PRESET_MAX_SETTINGS)
        vm_error(L, "%s: %d values; at most %d are accepted", r->path, (int)count,
                 PRESET_MAX_SETTINGS);
    r->settings = arena_alloc(r->memory, count * sizeof *r->settings);
    for (size_t i = 0; i < count; i++) {
        if (!setting_is_name(names[i]))
            vm_error(L, "%s: key %d is no name of a control", r->path, (int)i);
        r->text.length = 0;
        strbuf_append(&r->text, "", 0);
        value_get(L, table, names[i]);
        setting_add_text(L, &(setting_text){r->path, names[i], &r->text});
        lua_pop(L, 1);
        r->settings[r->count++] =
            (effect_setting){.name = arena_string(r->memory, names[i]),
                             .text = arena_string(r->memory, strbuf_text(&r->text))};
    }
    return 0;
}

bool preset_read(const char *root, const char *path, arena *memory, effect_setting **out,
                 size_t *count) {
    char folder[PATH_CAP];
    path_folder(folder, path);
    vm *v = vm_create(&(vm_desc){.root = folder, .memory = MEMORY_LIMIT});
    if (!v) return false;
    reader r = {.root = root, .path = path, .memory = memory};
    bool done = vm_protect(v, read_preset, &r, INSTRUCTION_LIMIT);
    vm_destroy(v);
    strbuf_free(&r.text);
    *out = r.settings;
    *count = done ? r.count : 0;
    return done;
}
