// Where a script is: its chunks, which are called after their files, the lines of them that run,
// and messages that name these. Functions of the prelude and the library speak of the effect's line
// that called them.
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include "script/vm.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SCRIPT_MAX_BYTES = 4 << 20 }; // of one file

enum { OF_EFFECT = '@', OF_ROIL = '=' }; // first letters of chunk names; OF_ROIL: prelude, library

// Returns the innermost line of the effect's author, else one of the library's; none in C.
static bool find_line(lua_State *L, lua_Debug *ar) {
    int ours = -1;
    for (int level = 0; lua_getstack(L, level, ar); level++) {
        lua_getinfo(L, "Sl", ar);
        if (ar->currentline <= 0) continue;
        if (ar->source[0] != OF_ROIL) return true;
        if (ours < 0) ours = level;
    }
    return ours >= 0 && lua_getstack(L, ours, ar) && lua_getinfo(L, "Sl", ar);
}

void vm_locate(lua_State *L, char *out, size_t size) {
    lua_Debug ar;
    out[0] = 0;
    if (find_line(L, &ar)) snprintf(out, size, "%s:%d: ", ar.short_src, ar.currentline);
}

// ---- errors -----------------------------------------------------------------------------------

void vm_error(lua_State *L, const char *format, ...) {
    char where[96], text[VM_MESSAGE_MAX];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    vm_locate(L, where, sizeof where);
    lua_pushfstring(L, "%s%s", where, text);
    lua_error(L);
    abort();
}

// Returns whether a message has a place in the library, such as "lib/spread.lua:12: ...". It says
// where the error occurred, but not what the author did.
static bool is_in_library(lua_State *L, const char *text) {
    lua_Debug ar;
    for (int level = 0; level < 32 && lua_getstack(L, level, &ar); level++) {
        lua_getinfo(L, "S", &ar);
        if (ar.source[0] == OF_EFFECT) break;
        size_t n = strlen(ar.short_src);
        if (ar.source[0] == OF_ROIL && strncmp(text, ar.short_src, n) == 0 && text[n] == ':')
            return true;
    }
    return false;
}

// Appends the lines of the effect's files that led to the error, one per line.
static void add_callers(lua_State *L, char *text, size_t capacity) {
    enum { MOST_CALLERS = 8 };
    lua_Debug ar;
    for (int level = 0, own = 0; own <= MOST_CALLERS && lua_getstack(L, level, &ar); level++) {
        lua_getinfo(L, "Sl", &ar);
        size_t n = strlen(text);
        if (ar.source[0] != OF_EFFECT || ar.currentline < 0 || own++ == 0) continue;
        snprintf(text + n, capacity - n, "%s%s:%d", VM_CALLED_FROM, ar.short_src, ar.currentline);
    }
}

int vm_describe_error(lua_State *L) {
    const char *message = lua_tostring(L, 1);
    if (!message) {
        if (luaL_callmeta(L, 1, "__tostring") && lua_type(L, -1) == LUA_TSTRING)
            message = lua_tostring(L, -1);
        else
            message = lua_pushfstring(L, "(error object is a %s value)", luaL_typename(L, 1));
    }
    char where[96] = "", text[VM_MESSAGE_MAX];
    if (!str_has_place(message) || is_in_library(L, message)) vm_locate(L, where, sizeof where);
    if (strncmp(message, where, strlen(where)) == 0) where[0] = 0;
    snprintf(text, sizeof text, "%s%s", where, message);
    add_callers(L, text, sizeof text);
    lua_pushstring(L, text);
    return 1;
}

// ---- chunks -----------------------------------------------------------------------------------

// Lua cuts chunk names at LUA_IDSIZE: a long path loses its folders instead of its line number.
static void chunk_name(const char *shown, char owner, char out[LUA_IDSIZE]) {
    size_t length = strlen(shown), most = LUA_IDSIZE - 2;
    const char *text = shown;
    if (length > most) text = path_name(shown);
    snprintf(out, LUA_IDSIZE, "%c%s", owner, text);
}

// Of the registry: texts, and paths of files, by chunk name.
static const char sources[] = "roil.sources", paths[] = "roil.paths";

typedef struct source {
    const char *name, *path, *text;
    size_t length;
} source;

static int keep_source(lua_State *L) {
    const source *s = lua_touserdata(L, 1);
    luaL_getsubtable(L, LUA_REGISTRYINDEX, sources);
    luaL_getsubtable(L, LUA_REGISTRYINDEX, paths);
    vm_set_ours(L, true);
    lua_pushstring(L, s->path);
    lua_setfield(L, -2, s->name);
    lua_pushlstring(L, s->text, s->length);
    vm_set_ours(L, false);
    lua_setfield(L, -3, s->name);
    return 0;
}

// Returns what a table of the registry has for a chunk; it keeps the text.
static const char *kept_text(lua_State *L, const char *table, const char *chunk) {
    luaL_getsubtable(L, LUA_REGISTRYINDEX, table);
    const char *text = lua_getfield(L, -1, chunk) == LUA_TSTRING ? lua_tostring(L, -1) : NULL;
    lua_pop(L, 2);
    return text;
}

const char *vm_caller_file(lua_State *L, int *line) {
    lua_Debug ar;
    if (!find_line(L, &ar) || ar.source[0] != OF_EFFECT) return NULL;
    *line = ar.currentline;
    return kept_text(L, paths, ar.source);
}

const char *vm_caller_source(lua_State *L, size_t *line) {
    lua_Debug ar;
    if (!find_line(L, &ar)) return NULL;
    const char *text = kept_text(L, sources, ar.source), *at = text;
    for (int i = 1; at && i < ar.currentline; i++) {
        at = strchr(at, '\n');
        if (at) at++;
    }
    if (!at) return NULL;
    *line = (size_t)(at - text);
    return text;
}

void vm_load_chunk(lua_State *L, const char *root, const char *path, const char *shown, bool ours) {
    const vm_desc *desc = vm_get_desc(L);
    void *data = NULL;
    size_t size = 0;
    if (!file_read_inside(root, path, SCRIPT_MAX_BYTES, &data, &size)) vm_error(L, "%s", err_get());
    if (desc->on_file) desc->on_file(desc->user, path);
    const char *text = data;
    size_t length = size;
    if (length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) {
        text += 3;
        length -= 3;
    }
    if (length && text[0] == LUA_SIGNATURE[0]) {
        mem_free(data);
        vm_error(L, "%s: compiled Lua; only its text is accepted", shown);
    }
    char name[LUA_IDSIZE];
    chunk_name(shown, ours ? OF_ROIL : OF_EFFECT, name);
    lua_pushcfunction(L, keep_source);
    lua_pushlightuserdata(L, &(source){name, path, text, length});
    int status = lua_pcall(L, 1, 0, 0);
    if (status == LUA_OK) status = luaL_loadbufferx(L, text, length, name, "t");
    mem_free(data);
    if (status == LUA_ERRMEM) luaL_error(L, "not enough memory");
    if (status != LUA_OK) lua_error(L);
}

typedef struct run_request {
    const char *root, *path, *shown;
    bool prelude;
} run_request;

static int run_chunk(lua_State *L) {
    const run_request *r = lua_touserdata(L, 1);
    vm_load_chunk(L, r->root, r->path, r->shown, r->prelude);
    lua_call(L, 0, 0);
    return 0;
}

bool vm_run_file(vm *v, const char *path, const char *shown, uint64_t instructions, bool prelude) {
    run_request request = {NULL, path, shown, prelude};
    return vm_protect(v, run_chunk, &request, instructions);
}

bool vm_run_file_inside(vm *v, const char *root, const char *path, const char *shown,
                        uint64_t instructions) {
    run_request request = {root, path, shown, false};
    return vm_protect(v, run_chunk, &request, instructions);
}
