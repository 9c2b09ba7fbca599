// Lua's patterns (Reference Manual 6.4.1) under the instruction budget.
//
// The matcher of Lua's own library backtracks inside one C call, where no hook can stop it: n
// repetitions in a pattern take the n-th power of the text's length. This one has the same
// semantics and charges the budget for every step. Recursion is bounded by MAX_DEPTH, as in Lua.
#include "script/vm.h"
#include <ctype.h>
#include <string.h>

enum {
    MAX_CAPTURES = 32,
    MAX_DEPTH = 200,
    STEPS_CHARGED = 1024, // at once
    CAPTURE_OPEN = -1,
    CAPTURE_POSITION = -2,
};

typedef struct capture {
    const char *start;
    ptrdiff_t length; // or CAPTURE_OPEN, CAPTURE_POSITION
} capture;

typedef struct matcher {
    lua_State *L;
    const char *text, *text_end, *pattern_end;
    int depth, steps;
    int level;
    capture captures[MAX_CAPTURES];
} matcher;

static const char *match(matcher *m, const char *s, const char *p);

static void step(matcher *m) {
    if (++m->steps < STEPS_CHARGED) return;
    m->steps = 0;
    vm_charge(m->L, STEPS_CHARGED);
}

// ---- single characters ------------------------------------------------------------------------

// End of the item (a character, a class or a set) that begins at p.
static const char *item_end(matcher *m, const char *p) {
    char c = *p++;
    if (c == '%') {
        if (p == m->pattern_end) vm_error(m->L, "malformed pattern (ends with '%%')");
        return p + 1;
    }
    if (c != '[') return p;
    if (p < m->pattern_end && *p == '^') p++;
    do { // the first character may be a ']'
        if (p == m->pattern_end) vm_error(m->L, "malformed pattern (missing ']')");
        if (*p++ == '%' && p < m->pattern_end) p++;
    } while (p == m->pattern_end || *p != ']');
    return p + 1;
}

static bool in_class(int c, int class) {
    bool result;
    switch (tolower(class)) {
    case 'a':
        result = isalpha(c);
        break;
    case 'c':
        result = iscntrl(c);
        break;
    case 'd':
        result = isdigit(c);
        break;
    case 'g':
        result = isgraph(c);
        break;
    case 'l':
        result = islower(c);
        break;
    case 'p':
        result = ispunct(c);
        break;
    case 's':
        result = isspace(c);
        break;
    case 'u':
        result = isupper(c);
        break;
    case 'w':
        result = isalnum(c);
        break;
    case 'x':
        result = isxdigit(c);
        break;
    default:
        return class == c;
    }
    return isupper(class) ? !result : result;
}

// `p` at the '[', `last` at the ']'.
static bool in_set(int c, const char *p, const char *last) {
    bool found = true;
    if (p[1] == '^') {
        found = false;
        p++;
    }
    while (++p < last) {
        if (*p == '%') {
            p++;
            if (in_class(c, (unsigned char)*p)) return found;
        } else if (p[1] == '-' && p + 2 < last) {
            p += 2;
            if ((unsigned char)p[-2] <= c && c <= (unsigned char)*p) return found;
        } else if ((unsigned char)*p == c) {
            return found;
        }
    }
    return !found;
}

// Whether the character at s is one that the item [p, end) stands for.
static bool item_matches(matcher *m, const char *s, const char *p, const char *end) {
    step(m);
    if (s >= m->text_end) return false;
    int c = (unsigned char)*s;
    switch (*p) {
    case '.':
        return true;
    case '%':
        return in_class(c, (unsigned char)p[1]);
    case '[':
        if (end - p > 16) vm_charge(m->L, (uint64_t)(end - p));
        return in_set(c, p, end - 1);
    default:
        return (unsigned char)*p == c;
    }
}

// ---- repetitions, balances, captures ----------------------------------------------------------

static const char *match_longest(matcher *m, const char *s, const char *p, const char *end) {
    ptrdiff_t i = 0;
    while (item_matches(m, s + i, p, end)) i++;
    for (; i >= 0; i--) {
        const char *result = match(m, s + i, end + 1);
        if (result) return result;
    }
    return NULL;
}

static const char *match_shortest(matcher *m, const char *s, const char *p, const char *end) {
    for (;;) {
        const char *result = match(m, s, end + 1);
        if (result) return result;
        if (!item_matches(m, s, p, end)) return NULL;
        s++;
    }
}

// %bxy, with p at the x.
static const char *match_balance(matcher *m, const char *s, const char *p) {
    if (p + 1 >= m->pattern_end) vm_error(m->L, "malformed pattern (missing arguments to '%%b')");
    if (s >= m->text_end || *s != *p) return NULL;
    int nested = 1;
    while (++s < m->text_end) {
        step(m);
        if (*s == p[1]) {
            if (--nested == 0) return s + 1;
        } else if (*s == *p) {
            nested++;
        }
    }
    return NULL;
}

// %f[set], with p at the '['. Sets *end behind the set.
static bool at_frontier(matcher *m, const char *s, const char *p, const char **end) {
    if (p >= m->pattern_end || *p != '[') vm_error(m->L, "missing '[' after '%%f' in pattern");
    *end = item_end(m, p);
    int before = s == m->text ? 0 : (unsigned char)s[-1];
    int after = s < m->text_end ? (unsigned char)*s : 0;
    return !in_set(before, p, *end - 1) && in_set(after, p, *end - 1);
}

static const char *start_capture(matcher *m, const char *s, const char *p, ptrdiff_t kind) {
    if (m->level >= MAX_CAPTURES) vm_error(m->L, "too many captures");
    m->captures[m->level++] = (capture){s, kind};
    const char *result = match(m, s, p);
    if (!result) m->level--;
    return result;
}

static const char *end_capture(matcher *m, const char *s, const char *p) {
    int i = m->level - 1;
    while (i >= 0 && m->captures[i].length != CAPTURE_OPEN) i--;
    if (i < 0) vm_error(m->L, "invalid pattern capture");
    m->captures[i].length = s - m->captures[i].start;
    const char *result = match(m, s, p);
    if (!result) m->captures[i].length = CAPTURE_OPEN;
    return result;
}

// The text that %1 .. %9 stand for.
static const char *match_back(matcher *m, const char *s, char digit) {
    int i = digit - '1';
    if (i < 0 || i >= m->level || m->captures[i].length == CAPTURE_OPEN)
        vm_error(m->L, "invalid capture index %%%d", i + 1);
    ptrdiff_t length = m->captures[i].length;
    if (length < 0) length = 0;
    if (m->text_end - s < length) return NULL;
    vm_charge(m->L, (uint64_t)length / 16);
    return memcmp(m->captures[i].start, s, (size_t)length) == 0 ? s + length : NULL;
}

// ---- the matcher ------------------------------------------------------------------------------

// One item and its suffix. True: go on with the rest of the pattern at *s, *p. False: *s is the
// result of the whole match.
static bool match_item(matcher *m, const char **s, const char **p) {
    const char *item = *p, *end = item_end(m, item);
    char suffix = end < m->pattern_end ? *end : 0;
    switch (suffix) {
    case '?':
        if (item_matches(m, *s, item, end)) {
            const char *result = match(m, *s + 1, end + 1);
            if (result) {
                *s = result;
                return false;
            }
        }
        *p = end + 1;
        return true;
    case '+':
        *s = item_matches(m, *s, item, end) ? match_longest(m, *s + 1, item, end) : NULL;
        return false;
    case '*':
        *s = match_longest(m, *s, item, end);
        return false;
    case '-':
        *s = match_shortest(m, *s, item, end);
        return false;
    default:
        if (!item_matches(m, *s, item, end)) {
            *s = NULL;
            return false;
        }
        *s += 1;
        *p = end;
        return true;
    }
}

// Items that begin with '%' and are not a single character. Sets *s to where the match goes on, or
// NULL; returns false when the item is a plain one.
static bool match_special(matcher *m, const char **s, const char **p) {
    const char *after = *p + 2;
    if (*p + 1 >= m->pattern_end) return false;
    switch ((*p)[1]) {
    case 'b':
        *s = match_balance(m, *s, after);
        *p = after + 2;
        return true;
    case 'f': {
        const char *end;
        if (!at_frontier(m, *s, after, &end)) *s = NULL;
        *p = end;
        return true;
    }
    case '0':
    case '1':
    case '2':
    case '3':
    case '4':
    case '5':
    case '6':
    case '7':
    case '8':
    case '9':
        *s = match_back(m, *s, (*p)[1]);
        *p = after;
        return true;
    default:
        return false;
    }
}

// End of the match of pattern p at s, or NULL.
static const char *match(matcher *m, const char *s, const char *p) {
    if (++m->depth > MAX_DEPTH) vm_error(m->L, "pattern too complex");
    while (s && p < m->pattern_end) {
        step(m);
        if (*p == '(') {
            bool position = p + 1 < m->pattern_end && p[1] == ')';
            s = position ? start_capture(m, s, p + 2, CAPTURE_POSITION)
                         : start_capture(m, s, p + 1, CAPTURE_OPEN);
            break;
        }
        if (*p == ')') {
            s = end_capture(m, s, p + 1);
            break;
        }
        if (*p == '$' && p + 1 == m->pattern_end) {
            if (s != m->text_end) s = NULL;
            break;
        }
        if (*p == '%' && match_special(m, &s, &p)) continue;
        if (!match_item(m, &s, &p)) break;
    }
    m->depth--;
    return s;
}

static const char *match_anew(matcher *m, const char *s, const char *p) {
    m->level = 0;
    m->depth = 0;
    return match(m, s, p);
}

// ---- results ----------------------------------------------------------------------------------

static void push_capture(matcher *m, int i, const char *s, const char *end) {
    if (i >= m->level) {
        if (i != 0) vm_error(m->L, "invalid capture index %%%d", i + 1);
        lua_pushlstring(m->L, s, (size_t)(end - s)); // no captures: the whole match
        return;
    }
    const capture *c = &m->captures[i];
    if (c->length == CAPTURE_OPEN) vm_error(m->L, "unfinished capture");
    if (c->length == CAPTURE_POSITION)
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

static matcher begin(lua_State *L, const char *text, size_t length, const char *pattern,
                     size_t pattern_length) {
    return (matcher){
        .L = L, .text = text, .text_end = text + length, .pattern_end = pattern + pattern_length};
}

// The optional argument `init` as an offset; more than `length` when it lies behind the text.
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
    matcher m = begin(L, text, length, pattern, pattern_length);
    bool anchored = pattern_length > 0 && *pattern == '^';
    const char *s = text + at;
    do {
        const char *end = match_anew(&m, s, pattern + anchored);
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
    matcher m = begin(L, text, length, pattern, pattern_length);
    for (const char *s = text + lua_tointeger(L, lua_upvalueindex(3)); s <= m.text_end; s++) {
        const char *end = match_anew(&m, s, pattern);
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

// Adds what replaces the match [s, end); false when it stays as it is.
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
    matcher m = begin(L, text, length, pattern, pattern_length);
    luaL_Buffer b;
    luaL_buffinit(L, &b);
    const char *s = text, *last = NULL;
    while (count < most) {
        const char *end = match_anew(&m, s, pattern + anchored);
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
