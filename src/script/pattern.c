// string.find, match, gmatch and gsub on top of our own matcher (script/match.h).
#include "script/match.h"
#include <ctype.h>
#include <string.h>

static void push_capture(matcher *m, int i, const char *s, const char *end) {
    if (i >= m->level) {
        if (i != 0) vm_error(m->L, "invalid capture index %%%d", i + 1);
        lua_pushlstring(m->L, s, (size_t)(end - s)); // no captures: the whole match
        return;
    }
    const match_capture *c = &m->captures[i];
    if (c->length == MATCH_OPEN) vm_error(m->L, "unfinished capture");
    if (c->length == MATCH_POSITION)
        lua_pushinteger(m->L, c->start - m->text + 1);
    else
        lua_pushlstring(m->L, c->start, (size_t)c->length);
}

static int push_captures(matcher *m, const char *s, const char *end) {
    int count = m->level == 0 && s ? 1 : m->level;
    luaL_checkstack(m->L, count, "too many captures");
    for (int i = 0; i < count; i++) push_capture(m, i, s, end);
    return count;
}

static matcher matcher_begin(lua_State *L, const char *text, size_t length, const char *pattern,
                             size_t pattern_length) {
    return (matcher){
        .L = L, .text = text, .text_end = text + length, .pattern_end = pattern + pattern_length};
}

// Returns the optional argument `init` as an offset; more than `length` when it is after the text.
static size_t start_offset(lua_State *L, int arg, size_t length) {
    lua_Integer at = luaL_optinteger(L, arg, 1);
    if (at > 0) return (size_t)at - 1;
    if (at == 0 || at < -(lua_Integer)length) return 0;
    return length - (size_t)-at;
}

static int find_or_match(lua_State *L, bool find) {
    size_t length, pattern_length;
    const char *text = luaL_checklstring(L, 1, &length);
    const char *pattern = luaL_checklstring(L, 2, &pattern_length);
    size_t at = start_offset(L, 3, length);
    if (at > length) {
        luaL_pushfail(L);
        return 1;
    }
    bool plain = lua_toboolean(L, 4) ||
                 (strlen(pattern) == pattern_length && !strpbrk(pattern, "^$*+?.([%-"));
    if (find && plain) {
        vm_charge(L, (length - at) / 8);
        const char *found = memmem(text + at, length - at, pattern, pattern_length);
        if (!found) {
            luaL_pushfail(L);
            return 1;
        }
        lua_pushinteger(L, found - text + 1);
        lua_pushinteger(L, found - text + (lua_Integer)pattern_length);
        return 2;
    }
    matcher m = matcher_begin(L, text, length, pattern, pattern_length);
    bool anchored = pattern_length > 0 && *pattern == '^';
    const char *s = text + at;
    do {
        vm_charge(L, 1);
        const char *end = match_at(&m, s, pattern + anchored);
        if (!end) continue;
        if (!find) return push_captures(&m, s, end);
        lua_pushinteger(L, s - text + 1);
        lua_pushinteger(L, end - text);
        return 2 + push_captures(&m, NULL, NULL);
    } while (s++ < m.text_end && !anchored);
    luaL_pushfail(L);
    return 1;
}

static int l_find(lua_State *L) {
    return find_or_match(L, true);
}

static int l_match(lua_State *L) {
    return find_or_match(L, false);
}

// ---- gmatch -----------------------------------------------------------------------------------

// Upvalues: text, pattern, offset of the next search, end of the last match (-1: none).
static int l_gmatch_next(lua_State *L) {
    size_t length, pattern_length;
    const char *text = lua_tolstring(L, lua_upvalueindex(1), &length);
    const char *pattern = lua_tolstring(L, lua_upvalueindex(2), &pattern_length);
    lua_Integer last = lua_tointeger(L, lua_upvalueindex(4));
    matcher m = matcher_begin(L, text, length, pattern, pattern_length);
    for (const char *s = text + lua_tointeger(L, lua_upvalueindex(3)); s <= m.text_end; s++) {
        vm_charge(L, 1);
        const char *end = match_at(&m, s, pattern);
        if (!end || end - text == last) continue;
        lua_pushinteger(L, end - text);
        lua_copy(L, -1, lua_upvalueindex(3));
        lua_replace(L, lua_upvalueindex(4));
        return push_captures(&m, s, end);
    }
    return 0;
}

static int l_gmatch(lua_State *L) {
    size_t length;
    luaL_checklstring(L, 1, &length);
    luaL_checkstring(L, 2);
    size_t at = start_offset(L, 3, length);
    lua_settop(L, 2);
    lua_pushinteger(L, at > length ? (lua_Integer)length + 1 : (lua_Integer)at);
    lua_pushinteger(L, -1);
    lua_pushcclosure(L, l_gmatch_next, 4);
    return 1;
}

// ---- gsub -------------------------------------------------------------------------------------

static void add_template(matcher *m, luaL_Buffer *b, const char *s, const char *end) {
    size_t length;
    const char *text = lua_tolstring(m->L, 3, &length);
    const char *last = text + length;
    for (const char *p; (p = memchr(text, '%', (size_t)(last - text))); text = p + 1) {
        luaL_addlstring(b, text, (size_t)(p - text));
        p++;
        char c = p < last ? *p : 0;
        if (c == '%')
            luaL_addchar(b, '%');
        else if (c == '0')
            luaL_addlstring(b, s, (size_t)(end - s));
        else if (isdigit((unsigned char)c)) {
            push_capture(m, c - '1', s, end);
            luaL_tolstring(m->L, -1, NULL);
            lua_remove(m->L, -2);
            luaL_addvalue(b);
        } else
            vm_error(m->L, "invalid use of '%%' in replacement string");
    }
    luaL_addlstring(b, text, (size_t)(last - text));
}

// Appends the replacement of the match [s, end). False when the match is kept.
static bool add_replacement(matcher *m, luaL_Buffer *b, const char *s, const char *end, int type) {
    lua_State *L = m->L;
    switch (type) {
    case LUA_TFUNCTION:
        lua_pushvalue(L, 3);
        lua_call(L, push_captures(m, s, end), 1);
        break;
    case LUA_TTABLE:
        push_capture(m, 0, s, end);
        lua_gettable(L, 3);
        break;
    default:
        add_template(m, b, s, end);
        return true;
    }
    if (!lua_toboolean(L, -1)) {
        lua_pop(L, 1);
        luaL_addlstring(b, s, (size_t)(end - s));
        return false;
    }
    if (!lua_isstring(L, -1)) vm_error(L, "invalid replacement value (a %s)", luaL_typename(L, -1));
    luaL_addvalue(b);
    return true;
}

static int l_gsub(lua_State *L) {
    size_t length, pattern_length;
    const char *text = luaL_checklstring(L, 1, &length);
    const char *pattern = luaL_checklstring(L, 2, &pattern_length);
    int type = lua_type(L, 3);
    luaL_argexpected(L,
                     type == LUA_TNUMBER || type == LUA_TSTRING || type == LUA_TFUNCTION ||
                         type == LUA_TTABLE,
                     3, "string/function/table");
    lua_Integer most = luaL_optinteger(L, 4, (lua_Integer)length + 1), count = 0;
    bool anchored = pattern_length > 0 && *pattern == '^', changed = false;
    matcher m = matcher_begin(L, text, length, pattern, pattern_length);
    luaL_Buffer b;
    luaL_buffinit(L, &b);
    const char *s = text, *last = NULL;
    while (count < most) {
        vm_charge(L, 1);
        const char *end = match_at(&m, s, pattern + anchored);
        if (end && end != last) {
            count++;
            changed |= add_replacement(&m, &b, s, end, type);
            s = last = end;
        } else if (s < m.text_end) {
            luaL_addchar(&b, *s++);
        } else {
            break;
        }
        if (anchored) break;
    }
    if (changed) {
        luaL_addlstring(&b, s, (size_t)(m.text_end - s));
        luaL_pushresult(&b);
    } else {
        lua_pushvalue(L, 1);
    }
    lua_pushinteger(L, count);
    return 2;
}

void pattern_open(lua_State *L) {
    static const luaL_Reg functions[] = {
        {"find", l_find}, {"match", l_match}, {"gmatch", l_gmatch}, {"gsub", l_gsub}, {NULL, NULL}};
    lua_getglobal(L, "string");
    luaL_setfuncs(L, functions, 0);
    lua_pop(L, 1);
}
