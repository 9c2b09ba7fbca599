// Values of a script as texts of settings.
#include "script/setting.h"
#include "script/binding.h"
#include <ctype.h>
#include <math.h>
#include <string.h>

_Noreturn static void wrong(lua_State *L, const setting_text *r, const char *accepted) {
    vm_error(L, "%s: '%.64s' must be %s", r->who, r->key, accepted);
}

static const char accepted_values[] =
    "a number, true or false, a word, {x, y, z}, stops { {position, colour, alpha}, ... } or keys "
    "{ {time, value}, ..., shape = \"linear\" }";

static void add_numbers(lua_State *L, const setting_text *r, const float *value, int count) {
    for (int i = 0; i < count; i++) {
        if (!isfinite(value[i])) wrong(L, r, "of finite numbers");
        if (i > 0) strbuf_append(r->text, ",", 1);
        strbuf_add_float(r->text, value[i]);
    }
}

static void add_word(lua_State *L, const setting_text *r, int index) {
    size_t length;
    const char *text = lua_tolstring(L, index, &length);
    for (size_t i = 0; i < length; i++)
        if (iscntrl((unsigned char)text[i])) wrong(L, r, "one line of text");
    strbuf_append(r->text, text, length);
}

// Appends number `i` of the entry at the top of the stack.
static void add_number_at(lua_State *L, const setting_text *r, int i) {
    if (lua_rawgeti(L, -1, i) != LUA_TNUMBER) wrong(L, r, accepted_values);
    float value = (float)lua_tonumber(L, -1);
    lua_pop(L, 1);
    add_numbers(L, r, &value, 1);
}

// Appends one stop or key at the top of the stack.
static void add_entry(lua_State *L, const setting_text *r, bool keys) {
    lua_Unsigned length = lua_type(L, -1) == LUA_TTABLE ? lua_rawlen(L, -1) : 0;
    float value[4];
    if (length < 2 || length > (keys ? 2 : 3)) wrong(L, r, accepted_values);
    add_number_at(L, r, 1);
    strbuf_append(r->text, " ", 1);
    lua_rawgeti(L, -1, 2);
    int count = value_numbers(L, -1, value);
    if (count == 0 || (!keys && count < 3)) wrong(L, r, accepted_values);
    if (!keys && lua_type(L, -1) == LUA_TSTRING)
        add_word(L, r, -1);
    else
        add_numbers(L, r, value, count);
    lua_pop(L, 1);
    if (length < 3) return;
    strbuf_append(r->text, " ", 1);
    add_number_at(L, r, 3);
}

static bool first_value_is_number(lua_State *L) {
    lua_rawgeti(L, -1, 1);
    bool number = lua_rawgeti(L, -1, 2) == LUA_TNUMBER;
    lua_pop(L, 2);
    return number;
}

// Appends the list of stops or keys at the top of the stack.
static void add_entries(lua_State *L, const setting_text *r) {
    size_t names;
    const char **name = value_names(L, -1, r->who, &names);
    for (size_t i = 0; i < names; i++)
        if (strcmp(name[i], "shape") != 0) wrong(L, r, accepted_values);
    lua_pop(L, 1);
    int shape = value_get(L, -1, "shape");
    bool keys = shape != LUA_TNIL;
    if (keys && shape != LUA_TSTRING) wrong(L, r, accepted_values);
    if (keys) add_word(L, r, -1);
    lua_pop(L, 1);
    if (!keys && first_value_is_number(L)) {
        keys = true;
        strbuf_add(r->text, "linear");
    }
    lua_Integer count = (lua_Integer)lua_rawlen(L, -1);
    for (lua_Integer i = 1; i <= count; i++) {
        if (i > 1 || keys) strbuf_add(r->text, i > 1 ? "; " : " ");
        lua_rawgeti(L, -1, i);
        add_entry(L, r, keys);
        lua_pop(L, 1);
    }
}

void setting_add_text(lua_State *L, const setting_text *r) {
    float value[4];
    switch (lua_type(L, -1)) {
    case LUA_TBOOLEAN:
        strbuf_add(r->text, lua_toboolean(L, -1) ? "true" : "false");
        return;
    case LUA_TSTRING:
        add_word(L, r, -1);
        return;
    case LUA_TNUMBER:
        value[0] = (float)lua_tonumber(L, -1);
        add_numbers(L, r, value, 1);
        return;
    case LUA_TTABLE: {
        bool entries = lua_rawgeti(L, -1, 1) == LUA_TTABLE;
        lua_pop(L, 1);
        int count = entries ? 0 : value_numbers(L, -1, value);
        if (entries)
            add_entries(L, r);
        else if (count == 0 || value_has_names(L, -1))
            wrong(L, r, accepted_values);
        add_numbers(L, r, value, count);
        return;
    }
    default:
        wrong(L, r, accepted_values);
    }
}

bool setting_is_name(const char *text) {
    for (; *text; text++)
        if (!isalnum((unsigned char)*text) && *text != '_' && *text != '.') return false;
    return true;
}
