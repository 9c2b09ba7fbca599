// What of Lua's own libraries a script gets. Left out: all that reaches files or the system (io,
// os, debug, package, load and its kin), that would escape the instruction hook (coroutine,
// finalizers: Lua runs both without or with a fresh hook), or that differs from run to run
// (collectgarbage, the order of pairs, unseeded math.random).
// What is left and loops in C: script/library.c.
#include "base/log.h"
#include "base/memory.h"
#include "base/words.h"
#include "script/vm.h"
#include <lualib.h>
#include <math.h>
#include <string.h>

enum { PRINT_COST = 2000, PRINT_MAX = 2000 };

// ---- base -------------------------------------------------------------------------------------

static int l_print(lua_State *L) {
    int n = lua_gettop(L);
    vm_charge(L, PRINT_COST);
    luaL_Buffer b;
    luaL_buffinit(L, &b);
    for (int i = 1; i <= n; i++) {
        vm_charge(L, 16);
        luaL_tolstring(L, i, NULL);
        if (i > 1) {
            lua_pushliteral(L, "\t");
            lua_insert(L, -2);
            lua_concat(L, 2);
        }
        luaL_addvalue(&b);
    }
    luaL_pushresult(&b);
    size_t length;
    const char *text = lua_tolstring(L, -1, &length);
    char line[PRINT_MAX + 1];
    size_t count = length < PRINT_MAX ? length : PRINT_MAX;
    for (size_t i = 0; i < count; i++) {
        unsigned char c = (unsigned char)text[i];
        line[i] = (c < 32 && c != '\t' && c != '\n') || c == 127 ? '?' : (char)c;
    }
    line[count] = 0;
    log_write(LOG_INFO, "%s%s", line, length > count ? "..." : "");
    return 0;
}

// Lua runs message handlers before it unwinds; when the error came from the instruction hook, no
// hook would then stop the handler. Ours runs after.
static int l_xpcall(lua_State *L) {
    int n = lua_gettop(L);
    luaL_checktype(L, 2, LUA_TFUNCTION);
    lua_pushvalue(L, 1);
    lua_insert(L, 3); // function, handler, function, arguments
    bool ok = lua_pcall(L, n - 2, LUA_MULTRET, 0) == LUA_OK;
    if (!ok) {
        lua_pushvalue(L, 2);
        lua_insert(L, -2);
        lua_call(L, 1, 1);
    }
    lua_pushboolean(L, ok);
    lua_replace(L, 2);
    return lua_gettop(L) - 1;
}

static int l_setmetatable(lua_State *L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    int type = lua_type(L, 2);
    luaL_argexpected(L, type == LUA_TNIL || type == LUA_TTABLE, 2, "nil or table");
    if (type == LUA_TTABLE) {
        lua_pushliteral(L, "__gc");
        if (lua_rawget(L, 2) != LUA_TNIL)
            vm_error(L, "setmetatable: effects cannot have finalizers (__gc)");
        lua_pop(L, 1);
    }
    if (luaL_getmetafield(L, 1, "__metatable") != LUA_TNIL)
        vm_error(L, "setmetatable: cannot change a protected metatable");
    lua_settop(L, 2);
    lua_setmetatable(L, 1);
    return 1;
}

// ---- pairs in a fixed order -------------------------------------------------------------------

// Numbers before strings before the rest; Lua's own order depends on addresses and the clock.
static int type_rank(int type) {
    return type == LUA_TNUMBER ? -2 : type == LUA_TSTRING ? -1 : type;
}

static int l_before(lua_State *L) {
    int a = lua_type(L, 1), b = lua_type(L, 2);
    bool result;
    library_charge_comparison(L);
    if (a == b && (a == LUA_TNUMBER || a == LUA_TSTRING))
        result = lua_compare(L, 1, 2, LUA_OPLT);
    else if (a == b && a == LUA_TBOOLEAN)
        result = !lua_toboolean(L, 1) && lua_toboolean(L, 2);
    else
        result = type_rank(a) < type_rank(b);
    lua_pushboolean(L, result);
    return 1;
}

// Upvalues: keys in order, next index.
static int l_pairs_next(lua_State *L) {
    lua_Integer i = lua_tointeger(L, lua_upvalueindex(2));
    for (;;) {
        i++;
        if (lua_rawgeti(L, lua_upvalueindex(1), i) == LUA_TNIL) return 1;
        lua_pushvalue(L, -1);
        if (lua_rawget(L, 1) != LUA_TNIL) break; // else removed by the loop's body
        lua_pop(L, 2);
    }
    lua_pushinteger(L, i);
    lua_replace(L, lua_upvalueindex(2));
    return 2;
}

// Upvalue: table.sort.
static int l_pairs(lua_State *L) {
    luaL_checkany(L, 1);
    if (luaL_getmetafield(L, 1, "__pairs") != LUA_TNIL) {
        lua_pushvalue(L, 1);
        lua_call(L, 1, 3);
        return 3;
    }
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_settop(L, 1);
    vm_look(L);
    lua_newtable(L);
    lua_Integer n = 0;
    bool in_order = true; // the array part comes in order already
    for (lua_pushnil(L); lua_next(L, 1);) {
        lua_pop(L, 1);
        vm_charge(L, 1);
        n++;
        in_order = in_order && lua_isinteger(L, -1) && lua_tointeger(L, -1) == n;
        lua_pushvalue(L, -1);
        lua_rawseti(L, 2, n);
    }
    if (!in_order) {
        vm_charge(L, (uint64_t)((double)n * 4 * log2((double)n + 2)));
        lua_pushvalue(L, lua_upvalueindex(1));
        lua_pushvalue(L, 2);
        lua_pushcfunction(L, l_before);
        lua_call(L, 2, 0);
    }
    lua_pushinteger(L, 0);
    lua_pushcclosure(L, l_pairs_next, 2);
    lua_pushvalue(L, 1);
    lua_pushnil(L);
    return 3;
}

// ---- math -------------------------------------------------------------------------------------

static int l_random(lua_State *L) {
    uint64_t r = vm_random(L);
    lua_Integer low = 1, high;
    switch (lua_gettop(L)) {
    case 0:
        lua_pushnumber(L, (double)(r >> 11) * 0x1p-53);
        return 1;
    case 1:
        high = luaL_checkinteger(L, 1);
        break;
    case 2:
        low = luaL_checkinteger(L, 1);
        high = luaL_checkinteger(L, 2);
        break;
    default:
        vm_error(L, "math.random takes at most two arguments");
    }
    luaL_argcheck(L, low <= high, lua_gettop(L), "interval is empty");
    uint64_t range = (uint64_t)high - (uint64_t)low + 1; // 0: all of them
    lua_pushinteger(L, (lua_Integer)((uint64_t)low + (range ? r % range : r)));
    return 1;
}

static int l_randomseed(lua_State *L) {
    double seed = luaL_checknumber(L, 1);
    uint64_t bits;
    memcpy(&bits, &seed, sizeof bits);
    vm_set_seed(L, bits);
    return 0;
}

// ---- globals ----------------------------------------------------------------------------------

static const char *const withheld[] = {
    "io",       "os",     "debug",  "package",        "coroutine",  "load",
    "loadfile", "dofile", "module", "collectgarbage", "loadstring",
};

static const struct {
    const char *name, *hint;
} elsewhere[] = {
    {"sweep", "this is a sweep; `roil bench` measures it"},
    {"effect", "this is an effect; `roil render` draws it"},
};

static int l_unknown_global(lua_State *L) {
    if (lua_type(L, 2) != LUA_TSTRING) vm_error(L, "globals are named by strings");
    const char *name = lua_tostring(L, 2);
    if (words_find(withheld, COUNT_OF(withheld), name) >= 0)
        vm_error(L, "'%s' is not available in effects: they cannot reach files or the system",
                 name);
    for (size_t i = 0; i < COUNT_OF(elsewhere); i++)
        if (strcmp(elsewhere[i].name, name) == 0)
            vm_error(L, "unknown name '%s': %s", name, elsewhere[i].hint);
    int count = 0;
    lua_settop(L, 2);
    for (lua_pushnil(L); lua_next(L, 1); lua_pop(L, 1))
        if (lua_type(L, -2) == LUA_TSTRING) count++;
    const char **names = lua_newuserdatauv(L, sizeof *names * (size_t)(count + 1), 0);
    size_t n = 0;
    for (lua_pushnil(L); lua_next(L, 1); lua_pop(L, 1))
        if (lua_type(L, -2) == LUA_TSTRING) names[n++] = lua_tostring(L, -2);
    const char *nearest = str_nearest(name, names, n);
    if (nearest) vm_error(L, "unknown name '%s'; did you mean '%s'?", name, nearest);
    vm_error(L, "unknown name '%s'", name);
}

static void open_globals(lua_State *L) {
    lua_pushglobaltable(L);
    for (size_t i = 0; i < COUNT_OF(withheld); i++) {
        lua_pushnil(L);
        lua_setfield(L, -2, withheld[i]);
    }
    lua_createtable(L, 0, 2);
    lua_pushcfunction(L, l_unknown_global);
    lua_setfield(L, -2, "__index");
    lua_pushboolean(L, false);
    lua_setfield(L, -2, "__metatable");
    lua_setmetatable(L, -2);
    lua_pop(L, 1);
}

void sandbox_open(lua_State *L) {
    static const luaL_Reg libraries[] = {
        {LUA_GNAME, luaopen_base},        {LUA_TABLIBNAME, luaopen_table},
        {LUA_STRLIBNAME, luaopen_string}, {LUA_MATHLIBNAME, luaopen_math},
        {LUA_UTF8LIBNAME, luaopen_utf8},
    };
    for (size_t i = 0; i < COUNT_OF(libraries); i++) {
        luaL_requiref(L, libraries[i].name, libraries[i].func, 1);
        lua_pop(L, 1);
    }
    lua_register(L, "print", l_print);
    lua_register(L, "setmetatable", l_setmetatable);
    lua_register(L, "xpcall", l_xpcall);

    lua_getglobal(L, LUA_TABLIBNAME);
    lua_getfield(L, -1, "sort");
    lua_pushcclosure(L, l_pairs, 1);
    lua_setglobal(L, "pairs");
    lua_pop(L, 1);

    lua_getglobal(L, LUA_MATHLIBNAME);
    lua_pushcfunction(L, l_random);
    lua_setfield(L, -2, "random");
    lua_pushcfunction(L, l_randomseed);
    lua_setfield(L, -2, "randomseed");
    lua_pop(L, 1);

    lua_getglobal(L, LUA_STRLIBNAME);
    lua_pushnil(L);
    lua_setfield(L, -2, "dump");
    lua_pop(L, 1);
    lua_pushliteral(L, ""); // the metatable of all strings
    lua_getmetatable(L, -1);
    lua_pushboolean(L, false);
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 2);

    open_globals(L);
}
