// `require "name"`: runs name.lua of the effect's folder, or else of those of assets or the
// library's. Each module
// runs once; its result (or true) is remembered.
#include "base/file.h"
#include "script/vm.h"
#include <ctype.h>
#include <stdio.h>

// Accepts words of letters, digits, '_' and '-', separated by '.' or '/'; so no "..", no absolute
// path.
static bool is_module_name(const char *name, size_t length) {
    if (length == 0 || length > 200) return false;
    for (size_t i = 0; i < length; i++) {
        bool separator = name[i] == '.' || name[i] == '/';
        bool edge = i == 0 || i + 1 == length || name[i - 1] == '.' || name[i - 1] == '/';
        bool word = isalnum((unsigned char)name[i]) || name[i] == '_' || name[i] == '-';
        if (separator ? edge : !word) return false;
    }
    return true;
}

// False when the folder has no such file. Raises an error when a symbolic link leads out of it.
static bool find_in(lua_State *L, const char *folder, const char *file, char out[PATH_CAP]) {
    char plain[PATH_CAP];
    if (!folder || !path_join(plain, folder, file) || !file_exists(plain)) return false;
    if (!path_confine(out, folder, file)) vm_error(L, "require: %s", err_get());
    return true;
}

// Adds the missing file to those that a reload watches.
static void fail_missing(lua_State *L, const char *name, const char *file) {
    const vm_desc *desc = vm_get_desc(L);
    char path[PATH_CAP];
    if (desc->on_file && desc->root && path_join(path, desc->root, file))
        desc->on_file(desc->user, path);
    vm_error(L, "require: no module '%s': there is no %s in the effect's folder%s or the library",
             name, file, desc->asset_count ? ", those of --assets," : "");
}

// Upvalue: table of modules by name; `false` while one is loading.
static int l_require(lua_State *L) {
    size_t length;
    const char *name = luaL_checklstring(L, 1, &length);
    if (!is_module_name(name, length))
        vm_error(L,
                 "require: bad module name '%s'; a name is words separated by '.', and stands for "
                 "a file inside the effect's folder",
                 name);
    lua_settop(L, 1);
    lua_pushvalue(L, 1);
    if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL) {
        if (lua_isboolean(L, -1) && !lua_toboolean(L, -1))
            vm_error(L, "require: '%s' failed to load, or requires itself by way of others", name);
        return 1;
    }
    char file[256], path[PATH_CAP], shown[PATH_CAP];
    snprintf(file, sizeof file, "%s.lua", name);
    for (size_t i = 0; i < length; i++)
        if (file[i] == '.') file[i] = '/';
    const vm_desc *desc = vm_get_desc(L);
    const char *root = find_in(L, desc->root, file, path) ? desc->root : NULL;
    if (root) snprintf(shown, sizeof shown, "%s%s", desc->shown, file);
    for (size_t i = 0; !root && i < desc->asset_count; i++) {
        if (!find_in(L, desc->assets[i], file, path)) continue;
        root = desc->assets[i];
        snprintf(shown, sizeof shown, "%s/%s", root, file);
    }
    bool ours = !root && find_in(L, desc->library, file, path);
    if (ours) snprintf(shown, sizeof shown, "lib/%s", file);
    if (!root && !ours) fail_missing(L, name, file);

    lua_pushvalue(L, 1);
    lua_pushboolean(L, false);
    lua_rawset(L, lua_upvalueindex(1));
    vm_load_chunk(L, ours ? desc->library : root, path, shown, ours);
    lua_pushvalue(L, 1);
    lua_call(L, 1, 1);
    if (!lua_toboolean(L, -1)) {
        lua_pop(L, 1);
        lua_pushboolean(L, true);
    }
    lua_pushvalue(L, 1);
    lua_pushvalue(L, -2);
    lua_rawset(L, lua_upvalueindex(1));
    return 1;
}

void module_open(lua_State *L) {
    lua_newtable(L);
    lua_pushcclosure(L, l_require, 1);
    lua_setglobal(L, "require");
}
