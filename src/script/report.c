// Reports: converts JSON to tables, and a table to a page.
#include "script/report.h"
#include "base/file.h"
#include "script/vm.h"

enum {
    MEMORY_LIMIT = 1 << 30, // pictures are within the tree
    INSTRUCTION_LIMIT = 400000000,
    MAX_DEPTH = 16,
};

typedef struct request {
    const char *folder;
    const json_t *data;
    strbuf *out;
} request;

static void push_json(lua_State *L, const json_t *value, int depth);

// Lua tables have no order, so the names are also stored at 1, 2, 3 ... in the order of the file.
static void push_object(lua_State *L, const json_t *object, int depth) {
    int count = (int)json_object_size(object);
    const char *name;
    json_t *value;
    lua_Integer i = 0;
    lua_createtable(L, count, count);
    json_object_foreach((json_t *)object, name, value) {
        push_json(L, value, depth);
        lua_setfield(L, -2, name);
        lua_pushstring(L, name);
        lua_rawseti(L, -2, ++i);
    }
}

static void push_array(lua_State *L, const json_t *array, int depth) {
    size_t count = json_array_size(array);
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        push_json(L, json_array_get(array, i), depth);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

static void push_json(lua_State *L, const json_t *value, int depth) {
    if (depth > MAX_DEPTH) vm_error(L, "values within values, more than %d deep", MAX_DEPTH);
    luaL_checkstack(L, 4, "report");
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        push_object(L, value, depth + 1);
        break;
    case JSON_ARRAY:
        push_array(L, value, depth + 1);
        break;
    case JSON_STRING:
        lua_pushlstring(L, json_string_value(value), json_string_length(value));
        break;
    case JSON_INTEGER:
        lua_pushinteger(L, json_integer_value(value));
        break;
    case JSON_REAL:
        lua_pushnumber(L, json_real_value(value));
        break;
    case JSON_TRUE:
    case JSON_FALSE:
        lua_pushboolean(L, json_is_true(value));
        break;
    default:
        lua_pushnil(L);
    }
}

static int write_page(lua_State *L) {
    const request *r = lua_touserdata(L, 1);
    char path[PATH_CAP];
    if (!path_join(path, r->folder, "page.lua")) vm_error(L, "%s", err_get());
    vm_load_chunk(L, NULL, path, "report/page.lua", false);
    lua_call(L, 0, 1);
    push_json(L, r->data, 0);
    lua_call(L, 1, 1);
    size_t length;
    const char *text = luaL_checklstring(L, -1, &length);
    strbuf_append(r->out, text, length);
    return 0;
}

bool script_report(const char *folder, const json_t *data, strbuf *out) {
    vm *v = vm_create(&(vm_desc){
        .root = folder, .shown = "report/", .memory = MEMORY_LIMIT, .longest = MEMORY_LIMIT});
    if (!v) return false;
    bool done = vm_protect(v, write_page, &(request){folder, data, out}, INSTRUCTION_LIMIT);
    vm_destroy(v);
    return done;
}
