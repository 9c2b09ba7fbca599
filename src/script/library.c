// Functions of Lua's own libraries that loop in C, where the instruction hook is not called: over
// ranges and repetitions given by their caller, or once for each item of a table. They are written
// again, or wrapped, so that they charge their work and check the limits meanwhile. Functions that
// loop once over a string or their arguments are left unchanged; script/vm.c bounds them.
#include "script/vm.h"
#include <math.h>
#include <stdint.h>

enum {
    MOST_FORMATTED = 10000, // values; one takes up to 3 us
    MOST_CHARACTERS = 1 << 16,
    FORMAT_COST = 32, // of one value
    REPETITIONS_AT_ONCE = 4,
    BYTES_AT_ONCE = 64, // that are copied at the cost of one instruction
    BYTES_COMPARED = 8, // the same; strings full of zeros take long
};

// Upvalue 1: Lua's own function, which is called once its work is charged.
static int call_original(lua_State *L) {
    int n = lua_gettop(L);
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, n, LUA_MULTRET);
    return lua_gettop(L);
}

static lua_Integer plain_length(lua_State *L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    if (luaL_getmetafield(L, 1, "__len") != LUA_TNIL)
        vm_error(L, "table functions take no tables with __len");
    return (lua_Integer)lua_rawlen(L, 1);
}

static _Noreturn void fail_length(lua_State *L, const char *function) {
    vm_error(L, "%s memory limit of %zu MiB for one string exceeded", function,
             vm_get_desc(L)->longest >> 20);
}

// ---- base -------------------------------------------------------------------------------------

static int l_next(lua_State *L) { // a table may be large, and empty
    vm_look(L);
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_settop(L, 2);
    if (lua_next(L, 1)) return 2;
    lua_pushnil(L);
    return 1;
}

// ---- table ------------------------------------------------------------------------------------

static void move_one(lua_State *L, int from_table, lua_Integer from, int table, lua_Integer to) {
    vm_charge(L, 2);
    lua_geti(L, from_table, from);
    lua_seti(L, table, to);
}

static int l_insert(lua_State *L) {
    lua_Integer end = plain_length(L) + 1, at = end;
    int n = lua_gettop(L);
    if (n != 2 && n != 3) vm_error(L, "wrong number of arguments to 'insert'");
    if (n == 3) {
        at = luaL_checkinteger(L, 2);
        luaL_argcheck(L, at >= 1 && at <= end, 2, "position out of bounds");
        for (lua_Integer i = end; i > at; i--) move_one(L, 1, i - 1, 1, i);
    }
    lua_seti(L, 1, at);
    return 0;
}

static int l_remove(lua_State *L) {
    lua_Integer length = plain_length(L), at = luaL_optinteger(L, 2, length);
    luaL_argcheck(L, at == length || (at >= 1 && at <= length + 1), 2, "position out of bounds");
    lua_geti(L, 1, at);
    for (; at < length; at++) move_one(L, 1, at + 1, 1, at);
    lua_pushnil(L);
    lua_seti(L, 1, at);
    return 1;
}

static int l_move(lua_State *L) {
    lua_Integer first = luaL_checkinteger(L, 2), last = luaL_checkinteger(L, 3);
    lua_Integer to = luaL_checkinteger(L, 4);
    int table = lua_isnoneornil(L, 5) ? 1 : 5;
    luaL_checktype(L, 1, LUA_TTABLE);
    luaL_checktype(L, table, LUA_TTABLE);
    lua_pushvalue(L, table);
    if (last < first) return 1;
    luaL_argcheck(L, first > 0 || last < LUA_MAXINTEGER + first, 3, "too many elements to move");
    lua_Integer n = last - first + 1;
    luaL_argcheck(L, to <= LUA_MAXINTEGER - n + 1, 4, "destination wrap around");
    bool apart = to > last || to <= first || !lua_rawequal(L, 1, table);
    for (lua_Integer i = 0; i < n; i++) {
        lua_Integer k = apart ? i : n - 1 - i;
        move_one(L, 1, first + k, table, to + k);
    }
    return 1;
}

static int l_concat(lua_State *L) {
    size_t between, size;
    lua_Integer length = plain_length(L);
    const char *separator = luaL_optlstring(L, 2, "", &between);
    lua_Integer i = luaL_optinteger(L, 3, 1), last = luaL_optinteger(L, 4, length);
    luaL_Buffer b;
    luaL_buffinit(L, &b);
    for (bool more = i <= last; more; i++) {
        lua_geti(L, 1, i);
        if (!lua_isstring(L, -1))
            vm_error(L, "invalid value (at index %lld) in table for 'concat'", (long long)i);
        lua_tolstring(L, -1, &size);
        vm_charge(L, 2 + (size + between) / BYTES_AT_ONCE);
        luaL_addvalue(&b);
        more = i < last;
        if (more) luaL_addlstring(&b, separator, between);
    }
    luaL_pushresult(&b);
    return 1;
}

static int l_unpack(lua_State *L) {
    plain_length(L);
    lua_Integer first = luaL_optinteger(L, 2, 1);
    lua_Integer last = luaL_optinteger(L, 3, (lua_Integer)lua_rawlen(L, 1));
    lua_settop(L, 3);
    if (last >= first) vm_charge(L, (uint64_t)last - (uint64_t)first);
    return call_original(L);
}

// Charges for the comparison of the two values at the bottom of the stack.
void library_charge_comparison(lua_State *L) {
    size_t a = lua_type(L, 1) == LUA_TSTRING ? lua_rawlen(L, 1) : 0;
    size_t b = lua_type(L, 2) == LUA_TSTRING ? lua_rawlen(L, 2) : 0;
    vm_charge(L, 4 + (a < b ? a : b) / BYTES_COMPARED);
}

static int l_less(lua_State *L) {
    library_charge_comparison(L);
    lua_pushboolean(L, lua_compare(L, 1, 2, LUA_OPLT));
    return 1;
}

static int l_less_by(lua_State *L) { // upvalue: a C function
    library_charge_comparison(L);
    return call_original(L);
}

static int l_sort(lua_State *L) {
    double n = (double)plain_length(L);
    vm_charge(L, (uint64_t)(n * log2(n + 2)));
    lua_settop(L, 2);
    if (lua_isnil(L, 2)) {
        lua_pop(L, 1);
        lua_pushcfunction(L, l_less);
    } else if (lua_iscfunction(L, 2)) {
        lua_pushcclosure(L, l_less_by, 1);
    }
    return call_original(L);
}

// ---- string -----------------------------------------------------------------------------------

static int l_rep(lua_State *L) {
    size_t size, between;
    luaL_checklstring(L, 1, &size);
    lua_Integer n = luaL_checkinteger(L, 2);
    luaL_optlstring(L, 3, "", &between);
    size_t each = size + between;
    if (n <= 0 || each == 0) {
        lua_pushliteral(L, "");
        return 1;
    }
    if ((uint64_t)n > vm_get_desc(L)->longest / each) fail_length(L, "string.rep:");
    vm_charge(L, (uint64_t)n / REPETITIONS_AT_ONCE + (uint64_t)n * each / BYTES_AT_ONCE);
    return call_original(L);
}

static int l_format(lua_State *L) {
    int n = lua_gettop(L);
    size_t sum = 0;
    if (n > MOST_FORMATTED) vm_error(L, "string.format: takes up to %d values", MOST_FORMATTED);
    for (int i = 1; i <= n; i++)
        if (lua_type(L, i) == LUA_TSTRING) sum += lua_rawlen(L, i);
    if (sum > vm_get_desc(L)->longest) fail_length(L, "string.format:");
    vm_charge(L, (uint64_t)n * FORMAT_COST + sum / BYTES_AT_ONCE);
    return call_original(L);
}

// "c1000000" pads with so many bytes.
static int l_pack(lua_State *L) {
    uint64_t sum = 0, number = 0;
    for (const char *c = luaL_checkstring(L, 1); *c && sum <= VM_STRING_MAX; c++) {
        bool digit = *c >= '0' && *c <= '9';
        number = digit ? number * 10 + (uint64_t)(*c - '0') : 0;
        if (c[1] < '0' || c[1] > '9' || number > VM_STRING_MAX) sum += number;
    }
    if (sum > VM_STRING_MAX) fail_length(L, "string.pack:");
    vm_charge(L, (uint64_t)lua_gettop(L) + sum / BYTES_COMPARED);
    return call_original(L);
}

static int l_utf8_char(lua_State *L) {
    int n = lua_gettop(L);
    if (n > MOST_CHARACTERS) vm_error(L, "utf8.char: takes up to %d values", MOST_CHARACTERS);
    vm_charge(L, (uint64_t)n * 4);
    return call_original(L);
}

// ---- opening ----------------------------------------------------------------------------------

static void library_wrap(lua_State *L, const char *library, const luaL_Reg *functions) {
    lua_getglobal(L, library);
    for (; functions->name; functions++) {
        lua_getfield(L, -1, functions->name);
        lua_pushcclosure(L, functions->func, 1);
        lua_setfield(L, -2, functions->name);
    }
    lua_pop(L, 1);
}

void library_open(lua_State *L) {
    static const luaL_Reg table[] = {{"insert", l_insert}, {"remove", l_remove}, {"move", l_move},
                                     {"concat", l_concat}, {"unpack", l_unpack}, {"sort", l_sort},
                                     {NULL, NULL}};
    static const luaL_Reg string[] = {
        {"rep", l_rep}, {"format", l_format}, {"pack", l_pack}, {NULL, NULL}};
    static const luaL_Reg utf8[] = {{"char", l_utf8_char}, {NULL, NULL}};
    lua_register(L, "next", l_next);
    library_wrap(L, "table", table);
    library_wrap(L, "string", string);
    library_wrap(L, "utf8", utf8);
}
