// Reads the arguments of a script: every table is checked key by key, every value against what is
// accepted, and the message says which.
#include "base/value.h"
#include "base/memory.h"
#include "base/words.h"
#include "script/binding.h"
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- objects ----------------------------------------------------------------------------------

void object_type(lua_State *L, const char *name, const luaL_Reg *methods) {
    luaL_newmetatable(L, name);
    if (methods) luaL_setfuncs(L, methods, 0);
    lua_pushboolean(L, false);
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 1);
}

void *object_new(lua_State *L, const char *name, size_t size) {
    void *object = lua_newuserdatauv(L, size, 1);
    memset(object, 0, size);
    luaL_setmetatable(L, name);
    return object;
}

void *object_test(lua_State *L, int index, const char *name) {
    return luaL_testudata(L, index, name);
}

const char *object_kind(lua_State *L, int index) {
    static const char *const bare[] = {"nil",        "no value", "instances",
                                       "explosions", "slices",   "voxels"};
    if (field_param_of(L, index)) return "a parameter";
    index = lua_absindex(L, index);
    bool ours =
        lua_type(L, index) == LUA_TUSERDATA && luaL_getmetafield(L, index, "__name") == LUA_TSTRING;
    const char *name = ours ? lua_tostring(L, -1) : luaL_typename(L, index);
    const int place = words_find(bare, COUNT_OF(bare), name);
    if (place >= 0) return bare[place];
    return lua_pushfstring(L, "%s %s", strchr("aeio", name[0]) ? "an" : "a", name);
}

int object_method(lua_State *L, const char *type, const luaL_Reg *methods) {
    const char *known[16], *name = luaL_checkstring(L, 2);
    size_t count = 0;
    for (; methods[count].name; count++) {
        assert(count < COUNT_OF(known));
        known[count] = methods[count].name;
        if (strcmp(name, known[count]) != 0) continue;
        lua_pushcfunction(L, methods[count].func);
        return 1;
    }
    value_unknown(L, type, "method", name, known, count);
}

bool value_is_plain_table(lua_State *L, int index) {
    return lua_type(L, index) == LUA_TTABLE;
}

bool value_has_names(lua_State *L, int index) {
    index = lua_absindex(L, index);
    for (lua_pushnil(L); lua_next(L, index); lua_pop(L, 1))
        if (lua_type(L, -2) == LUA_TSTRING) {
            lua_pop(L, 2);
            return true;
        }
    return false;
}

// ---- keys -------------------------------------------------------------------------------------

void value_unknown(lua_State *L, const char *who, const char *what, const char *name,
                   const char *const *known, size_t count) {
    words_refuse(known, count, name, NULL, "%s: unknown %s '%.64s'", who, what, name);
    script_raise(L);
}

static int by_name(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

int value_get(lua_State *L, int table, const char *key) {
    table = lua_absindex(L, table);
    if (!lua_istable(L, table)) { // what takes a table may look before it has refused another value
        lua_pushnil(L);
        return LUA_TNIL;
    }
    lua_pushstring(L, key);
    return lua_rawget(L, table);
}

const char **value_names(lua_State *L, int table, const char *who, size_t *count) {
    table = lua_absindex(L, table);
    lua_Unsigned length = lua_rawlen(L, table);
    size_t n = 0;
    for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) {
        int type = lua_type(L, -2);
        bool in_array = lua_isinteger(L, -2) && lua_tointeger(L, -2) >= 1 &&
                        (lua_Unsigned)lua_tointeger(L, -2) <= length;
        if (type != LUA_TSTRING && !in_array)
            vm_error(L, "%s: a key is %s; keys are names, or 1, 2, 3 ... without gaps", who,
                     object_kind(L, -2));
        n += type == LUA_TSTRING;
    }
    const char **names = lua_newuserdatauv(L, (n + 1) * sizeof *names, 1);
    lua_newtable(L); // keeps the names when a function of time empties the script's table
    *count = 0;
    for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) {
        if (lua_type(L, -2) != LUA_TSTRING) continue;
        names[(*count)++] = lua_tostring(L, -2);
        lua_pushvalue(L, -2);
        lua_rawseti(L, -4, (lua_Integer)*count);
    }
    lua_setiuservalue(L, -2, 1);
    qsort(names, *count, sizeof *names, by_name);
    return names;
}

void value_check_keys(lua_State *L, int table, const char *who, const char *const *known,
                      size_t count) {
    if (!value_is_plain_table(L, table))
        vm_error(L, "%s takes a table, as in %s { ... }; got %s", who, who, object_kind(L, table));
    size_t n;
    const char **names = value_names(L, table, who, &n);
    for (size_t i = 0; i < n; i++)
        if (words_find(known, count, names[i]) < 0)
            value_unknown(L, who, "key", names[i], known, count);
    lua_pop(L, 1);
}

void value_check_row(lua_State *L, int table, const char *who, const script_object *object) {
    const char *known[64];
    const value_desc *key;
    size_t count = 0;
    for (; (key = script_object_key(object, count)); count++) {
        assert(count < COUNT_OF(known));
        known[count] = key->name;
    }
    value_check_keys(L, table, who, known, count);
}

const script_object *value_check_object(lua_State *L, int table, const char *name) {
    const script_object *object = script_object_find(name);
    value_check_row(L, table, name, object);
    return object;
}

// ---- simple values ----------------------------------------------------------------------------

_Noreturn static void wrong(lua_State *L, int index, const char *who, const char *key,
                            const char *accepted) {
    if (lua_type(L, index) == LUA_TSTRING && strstr(accepted, "#rrggbb"))
        vm_error(L,
                 "%s: '%s' must be a colour as \"#rrggbb\", or a number, {x, y, z}, a field, a "
                 "parameter, a curve or a function of time; got \"%s\"",
                 who, key, lua_tostring(L, index));
    vm_error(L, "%s: '%s' must be %s; got %s", who, key, accepted, object_kind(L, index));
}

// Reads a constant; a field that changes is not a number.
static bool plain_number(lua_State *L, int index, double *out) {
    if (lua_type(L, index) == LUA_TNUMBER) {
        *out = lua_tonumber(L, index);
        return true;
    }
    const field_object *object = object_test(L, index, "field");
    if (!object || object->node->components != 1 || !field_is_constant(object->node)) return false;
    *out = (double)object->node->value[0];
    return true;
}

double value_get_number(lua_State *L, int table, const char *who, const char *key,
                        double otherwise) {
    double value = otherwise;
    if (value_get(L, table, key) != LUA_TNIL) {
        if (!plain_number(L, -1, &value)) wrong(L, -1, who, key, "a plain number");
        if (!isfinite(value)) vm_error(L, "%s: '%s' must be a finite number", who, key);
    }
    lua_pop(L, 1);
    return value;
}

uint32_t value_get_count(lua_State *L, int table, const char *who, const char *key,
                         uint32_t otherwise) {
    double value = value_get_number(L, table, who, key, otherwise);
    if (!(value >= 0 && value <= UINT32_MAX && value == floor(value)))
        vm_error(L, "%s: '%s' is %g; a whole number from 0 is accepted", who, key, value);
    return (uint32_t)value;
}

bool value_get_bool(lua_State *L, int table, const char *who, const char *key, bool otherwise) {
    bool value = otherwise;
    int type = value_get(L, table, key);
    if (type == LUA_TBOOLEAN)
        value = lua_toboolean(L, -1);
    else if (type != LUA_TNIL)
        wrong(L, -1, who, key, "true or false");
    lua_pop(L, 1);
    return value;
}

const char *value_get_string(lua_State *L, int table, const char *who, const char *key) {
    const char *value = NULL;
    int type = value_get(L, table, key);
    if (type == LUA_TSTRING) {
        size_t length;
        const char *text = lua_tolstring(L, -1, &length);
        if (strlen(text) != length) vm_error(L, "%s: '%s' contains a zero byte", who, key);
        vm_charge_memory(L, length + 1);
        value = arena_string(script_memory(L), text);
    } else if (type != LUA_TNIL) {
        wrong(L, -1, who, key, "a string");
    }
    lua_pop(L, 1);
    return value;
}

bool value_get_vector(lua_State *L, int table, const char *who, const char *key, float out[3]) {
    if (value_get(L, table, key) == LUA_TNIL) {
        lua_pop(L, 1);
        return false;
    }
    float value[4];
    int count = value_numbers(L, -1, value);
    if (count == 1) value[1] = value[2] = value[0];
    if (count != 1 && count != 3) wrong(L, -1, who, key, "three plain numbers {x, y, z}");
    memcpy(out, value, 3 * sizeof *out);
    lua_pop(L, 1);
    return true;
}

void value_get_place(lua_State *L, int table, const char *call, const char *key, const char *name,
                     float3 *out) {
    float at[3] = {0};
    value_get_vector(L, table, call, key, at);
    vm_charge_memory(L, EFFECT_CONTROL_COST);
    const value_desc place = {.name = key,
                              .components = 3,
                              .unit = "m",
                              .help = "where it is; taken when the effect loads"};
    const value_desc *desc = arena_copy(script_memory(L), &place, sizeof place);
    script_note_place(L, desc, call);
    if (!effect_add_loaded(script_of(L)->effect, name, desc, desc, at)) script_raise(L);
    *out = (float3){at[0], at[1], at[2]};
}

int value_word(lua_State *L, int index, const char *who, const char *key, const char *const *words,
               size_t count) {
    if (lua_type(L, index) != LUA_TSTRING) wrong(L, index, who, key, "a word in quotes");
    const char *word = lua_tostring(L, index);
    int found = words_find(words, count, word);
    if (found >= 0) return found;
    const char *what = lua_pushfstring(L, "value of '%s'", key);
    value_unknown(L, who, what, word, words, count);
}

int value_get_choice(lua_State *L, int table, const script_object *object, const char *key) {
    const value_desc *row = script_key_find(object->keys, key);
    assert(row && row->words);
    int value = (int)row->value[0];
    if (value_get(L, table, key) != LUA_TNIL)
        value = value_word(L, -1, object->name, key, row->words, row->word_count);
    lua_pop(L, 1);
    return value;
}

// ---- numbers, vectors, colours ----------------------------------------------------------------

// Neither raises errors nor allocates, because the result of a function of time is read outside of
// any call.
int value_numbers(lua_State *L, int index, float out[4]) {
    index = lua_absindex(L, index);
    memset(out, 0, 4 * sizeof *out);
    double number;
    switch (lua_type(L, index)) {
    case LUA_TBOOLEAN:
        out[0] = lua_toboolean(L, index) ? 1 : 0;
        return 1;
    case LUA_TSTRING: {
        const char *text = lua_tostring(L, index);
        if (text[0] != '#' || !value_parse_color(text, out)) return 0;
        size_t length = strlen(text);
        return length == 5 || length == 9 ? 4 : 3;
    }
    case LUA_TTABLE: {
        lua_Unsigned count = lua_rawlen(L, index);
        if (count < 1 || count > 4) return 0;
        for (int i = 0; i < (int)count; i++) {
            lua_rawgeti(L, index, i + 1);
            bool right = lua_type(L, -1) == LUA_TNUMBER;
            out[i] = (float)lua_tonumber(L, -1);
            lua_pop(L, 1);
            if (!right) return 0;
        }
        return (int)count;
    }
    default:
        if (!plain_number(L, index, &number)) return 0;
        out[0] = (float)number;
        return 1;
    }
}

static const char accepted_values[] = "a number, {x, y, z}, a colour \"#rrggbb\", a field, a "
                                      "parameter, a curve or a function of time";

static const field *constant(lua_State *L, const char *who, const char *key, int count,
                             float value[4]) {
    for (int i = 0; i < count; i++)
        if (!isfinite(value[i])) vm_error(L, "%s: '%s' must be finite", who, key);
    vm_charge_memory(L, sizeof(field));
    return field_constant(script_memory(L), count == 2 ? 3 : count, value);
}

// Calls the function once, for time 0, to learn how many components it returns.
static const field *function_of_time(lua_State *L, int index, const char *who, const char *key) {
    script_require_loading(L, "a function of time");
    script *s = script_of(L);
    lua_pushvalue(L, index);
    lua_pushnumber(L, 0);
    s->loading = false;
    int status = lua_pcall(L, 1, 1, 0);
    s->loading = true;
    if (status != LUA_OK) lua_error(L);
    float value[4];
    int count = value_numbers(L, -1, value);
    if (count == 0)
        vm_error(L,
                 "%s: the function for '%s' must return a number, {x, y, z} or a colour; it "
                 "returned %s for time 0",
                 who, key, object_kind(L, -1));
    for (int i = 0; i < count; i++)
        if (!isfinite(value[i]))
            vm_error(L, "%s: the function for '%s' returned %g for time 0", who, key,
                     (double)value[i]);
    lua_pop(L, 1);
    lua_pushvalue(L, index);
    int reference = luaL_ref(L, LUA_REGISTRYINDEX);
    vm_charge_memory(L, sizeof(field));
    return field_call(script_memory(L), count == 2 ? 3 : count, reference);
}

// Reads {x, y, z} or {x, y} in which some values are fields.
static const field *mixed_vector(lua_State *L, int index, const char *who, const char *key) {
    const field *parts[FIELD_MAX_ARGS] = {0};
    lua_Unsigned count = lua_rawlen(L, index);
    if ((count != 2 && count != 3) || value_has_names(L, index))
        wrong(L, index, who, key, accepted_values);
    for (int i = 0; i < (int)count; i++) {
        lua_rawgeti(L, index, i + 1);
        if (value_is_plain_table(L, -1)) wrong(L, index, who, key, accepted_values);
        parts[i] = value_field(L, lua_absindex(L, -1), who, key, 1);
        lua_pop(L, 1);
    }
    vm_charge_memory(L, sizeof(field));
    const field *node = field_make(script_memory(L), "vec", parts, NULL);
    if (!node) script_raise(L);
    return node;
}

const field *value_field(lua_State *L, int index, const char *who, const char *key,
                         int components) {
    index = lua_absindex(L, index);
    luaL_checkstack(L, 8, "value");
    const field_object *object = object_test(L, index, "field");
    const field *node;
    float value[4];
    int count;
    if (object)
        node = object->node;
    else if (lua_type(L, index) == LUA_TFUNCTION)
        node = function_of_time(L, index, who, key);
    else if ((count = value_numbers(L, index, value)) > 0)
        node = constant(L, who, key, count, value);
    else if (lua_type(L, index) == LUA_TTABLE)
        node = mixed_vector(L, index, who, key);
    else if (object_test(L, index, "sequence"))
        vm_error(L, "%s: '%s' is a whole sequence; name one of its grids, as in burst.density", who,
                 key);
    else
        wrong(L, index, who, key, accepted_values);
    bool fits = components == 0 || node->components == 1 || node->components == components ||
                (components == 3 && node->components == 4) ||
                (components == 2 && node->components == 3);
    if (!fits)
        vm_error(L, "%s: '%s' takes %d component%s; this has %d", who, key, components,
                 components == 1 ? "" : "s", node->components);
    return node;
}

void value_refuse_two(lua_State *L, int index, const char *who, const char *key, int components) {
    if (components == 3 && value_is_plain_table(L, index) && lua_rawlen(L, index) == 2)
        vm_error(L, "%s: '%s' takes three numbers, {x, y, z}; this has two", who, key);
}

const field *value_uniform(lua_State *L, int index, const char *who, const char *key,
                           int components) {
    value_refuse_two(L, index, who, key, components);
    const field *node = value_field(L, index, who, key, components);
    if (!node->uniform)
        vm_error(L,
                 "%s: '%s' varies in space; a number, a parameter, a curve or a function of time "
                 "is accepted%s",
                 who, key, strcmp(key, "albedo") == 0 ? "; 'tint' colours what varies" : "");
    return node;
}

void value_put_number(lua_State *L, const char *key, double value) {
    lua_pushnumber(L, value);
    lua_setfield(L, -2, key);
}

void value_put_numbers(lua_State *L, const char *key, const float *values, int count) {
    lua_createtable(L, count, 0);
    for (int i = 0; i < count; i++) {
        lua_pushnumber(L, (double)values[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, key);
}

const field *value_get_uniform(lua_State *L, int table, const char *who, const char *key,
                               int components, const field *otherwise) {
    const field *node = otherwise;
    if (value_get(L, table, key) != LUA_TNIL) node = value_uniform(L, -1, who, key, components);
    lua_pop(L, 1);
    return node;
}
