// Names of palettes, curves and fields, taken from the script, so that they can be set by them:
// `local fire = palette { ... }` gives "fire", and `local hot = splats { size = over_age { ... } }`
// gives "hot_size".
#include "script/binding.h"
#include "script/source.h"
#include <ctype.h>
#include <string.h>

enum {
    LINES_ABOVE = 3, // a call that is split over lines is found by one of them
    LETTERS = 16,    // that cost an instruction to look through
};

static bool is_part(char c) { // of an identifier
    return isalnum((unsigned char)c) || c == '_';
}

// Returns the first call of `word` in the line that begins at `line`; NULL when there is none.
static const char *find_call(const char *text, const char *line, const char *word) {
    size_t length = strlen(word);
    const char *end = line + strcspn(line, "\n");
    for (const char *at = line; (at = strstr(at, word)) && at < end; at++) {
        if ((at > text && is_part(at[-1])) || is_part(at[length])) continue;
        const char *next = at + length + strspn(at + length, " \t\r\n");
        if (*next == '{' || *next == '(') return at;
    }
    return NULL;
}

static const char *skip_back(const char *text, const char *at) {
    while (at > text && isspace((unsigned char)at[-1])) at--;
    return at;
}

// Returns the name that the value of the call at `at` is assigned to, and whether it is a variable
// of its own, and no key of a table.
static bool read_name(const char *text, const char *at, char *out, size_t capacity, bool *local) {
    at = skip_back(text, at);
    if (at == text || *--at != '=') return false;
    if (at > text && strchr("=~<>", at[-1])) return false; // a comparison
    at = skip_back(text, at);
    if (at > text && at[-1] == '>') { // local fire <const> =
        while (at > text && *at != '<') at--;
        at = skip_back(text, at);
    }
    const char *end = at;
    while (at > text && is_part(at[-1])) at--;
    size_t length = (size_t)(end - at);
    if (length == 0 || length >= capacity || isdigit((unsigned char)*at)) return false;
    memcpy(out, at, length);
    out[length] = '\0';
    const char *before = skip_back(text, at);
    *local = before - text >= 5 && strncmp(before - 5, "local", 5) == 0;
    return true;
}

// Returns the next call of `word` in a line after the one that was named last: calls in one line
// run from left to right.
static const char *next_call(lua_State *L, const char *text, const char *line, const char *word) {
    const char *named = script_of(L)->named;
    const char *call = NULL;
    if (named && named >= line && named < line + strcspn(line, "\n"))
        call = find_call(text, named + 1, word);
    if (!call) call = find_call(text, line, word);
    if (call) script_of(L)->named = call;
    return call;
}

// Finds the call of `who` that the script is at. NULL: its text has none there.
static const char *call_at(lua_State *L, const char *who, const char **text) {
    size_t begin;
    *text = vm_caller_source(L, &begin);
    const char *line = *text ? *text + begin : NULL;
    for (int i = 0; line && i <= LINES_ABOVE; i++) {
        const char *call = next_call(L, *text, line, who);
        if (call) return call;
        if (line == *text) break;
        for (line--; line > *text && line[-1] != '\n';) line--;
    }
    return NULL;
}

bool value_variable(lua_State *L, const char *call, char *out, size_t capacity) {
    bool local;
    const char *text, *at = call_at(L, call, &text);
    return at && read_name(text, at, out, capacity, &local) && local;
}

static const char *given_name(lua_State *L, int table, const char *who) {
    const char *given = value_get_string(L, table, who, "name");
    if (given && !str_is_identifier(given))
        vm_error(L, "%s: name '%.64s' is not a name (letters, digits and _)", who, given);
    return given;
}

const char *value_name_or_variable(lua_State *L, int table, const char *who) {
    const char *given = given_name(L, table, who);
    char name[64];
    bool local;
    if (given) return given;
    const char *text, *at = call_at(L, who, &text);
    bool named = at && read_name(text, at, name, sizeof name, &local);
    return named ? arena_string(script_memory(L), name) : who;
}

const char *value_name_or_purpose(lua_State *L, int table, const char *who) {
    const char *given = given_name(L, table, who);
    char name[64];
    if (given) return given;
    const char *text, *at = call_at(L, who, &text);
    if (at) vm_charge(L, (uint64_t)(at - text) / LETTERS);
    bool named = at && source_purpose(text, (size_t)(at - text), name, sizeof name) &&
                 str_is_identifier(name);
    return named ? arena_string(script_memory(L), name) : who;
}
