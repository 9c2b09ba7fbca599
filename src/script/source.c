#include "script/source.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

// ---- tokens -------------------------------------------------------------------------------------

typedef enum token_kind { END, NAME, NUMBER, STRING, SYMBOL } token_kind;

typedef struct token {
    token_kind kind;
    source_range at;
} token;

static bool is_part(char c) { // of a name
    return isalnum((unsigned char)c) || c == '_';
}

// Returns the end of "[[...]]" or "[==[...]==]" that begins at `at`; `at`: there is none.
static size_t skip_long(const char *text, size_t at) {
    size_t level = strspn(text + at + 1, "="), open = at + 1 + level;
    if (text[open] != '[') return at;
    for (const char *end = text + open; (end = strchr(end, ']')); end++)
        if (strspn(end + 1, "=") == level && end[1 + level] == ']')
            return (size_t)(end - text) + level + 2;
    return open + strlen(text + open);
}

static size_t skip_quoted(const char *text, size_t at) {
    char quote = text[at++];
    while (text[at] && text[at] != quote && text[at] != '\n')
        at += text[at] == '\\' && text[at + 1] ? 2 : 1;
    return at + (text[at] == quote);
}

// Spaces and comments.
static size_t skip_blank(const char *text, size_t at) {
    for (;;) {
        at += strspn(text + at, " \t\r\n\v\f");
        if (text[at] != '-' || text[at + 1] != '-') return at;
        size_t end = text[at + 2] == '[' ? skip_long(text, at + 2) : at + 2;
        at = end > at + 2 ? end : at + strcspn(text + at, "\n");
    }
}

static size_t skip_number(const char *text, size_t at) {
    for (; is_part(text[at]) || text[at] == '.'; at++) {
        bool power = strchr("eEpP", text[at]) && strchr("+-", text[at + 1]) && text[at + 1];
        at += power;
    }
    return at;
}

// Returns the token at or after `at`. Its range is empty at the end of the text.
static token next_token(const char *text, size_t at) {
    at = skip_blank(text, at);
    char c = text[at];
    token t = {SYMBOL, {at, at + 1}};
    if (!c) {
        t = (token){END, {at, at}};
    } else if (isdigit((unsigned char)c) || (c == '.' && isdigit((unsigned char)text[at + 1]))) {
        t = (token){NUMBER, {at, skip_number(text, at)}};
    } else if (is_part(c)) {
        t.kind = NAME;
        while (is_part(text[t.at.end])) t.at.end++;
    } else if (c == '"' || c == '\'') {
        t = (token){STRING, {at, skip_quoted(text, at)}};
    } else if (c == '[' && skip_long(text, at) > at) {
        t = (token){STRING, {at, skip_long(text, at)}};
    } else if (strchr("=~<>", c) && text[at + 1] == '=') {
        t.at.end++;
    }
    return t;
}

static bool is(const char *text, const token *t, const char *word) {
    size_t length = strlen(word);
    return t->kind != STRING && t->at.end - t->at.begin == length &&
           strncmp(text + t->at.begin, word, length) == 0;
}

static bool is_separator(const char *text, const token *t) {
    return is(text, t, ",") || is(text, t, ";");
}

// By how much a token opens or closes a bracket, or a block: `for` and `while` have a `do`.
static int depth_of(const char *text, const token *t) {
    static const char *const open[] = {"(", "{", "[", "function", "if", "do", "repeat"},
                             *const close[] = {")", "}", "]", "end", "until"};
    for (size_t i = 0; i < sizeof open / sizeof *open; i++)
        if (is(text, t, open[i])) return 1;
    for (size_t i = 0; i < sizeof close / sizeof *close; i++)
        if (is(text, t, close[i])) return -1;
    return 0;
}

// Returns the end of what is opened by the token at `begin`; 0: it has none.
static size_t skip_nested(const char *text, size_t begin) {
    int depth = 0;
    for (token t = next_token(text, begin); t.kind != END; t = next_token(text, t.at.end)) {
        depth += depth_of(text, &t);
        if (depth <= 0) return t.at.end;
    }
    return 0;
}

// ---- calls --------------------------------------------------------------------------------------

// Finds the table of a call whose arguments begin at `at`: itself, or the last one in brackets.
static bool find_table(const char *text, size_t at, source_range *out) {
    token t = next_token(text, at), before = t;
    *out = (source_range){t.at.begin, 0};
    if (is(text, &t, "{")) return (out->end = skip_nested(text, t.at.begin)) > 0;
    if (!is(text, &t, "(")) return false;
    for (t = next_token(text, t.at.end); t.kind != END && !is(text, &t, ")");) {
        bool begins = is(text, &before, "(") || is(text, &before, ",");
        size_t end = depth_of(text, &t) > 0 ? skip_nested(text, t.at.begin) : t.at.end;
        if (begins && is(text, &t, "{")) *out = (source_range){t.at.begin, end};
        if (end == 0) return false;
        before = t;
        t = next_token(text, end);
    }
    return out->end > 0;
}

static int count_lines(const char *text, size_t from, size_t to) {
    int count = 0;
    for (size_t i = from; i < to; i++) count += text[i] == '\n';
    return count;
}

size_t source_find_calls(const char *text, const char *function, int line, source_call *out,
                         size_t capacity) {
    size_t count = 0, seen = 0;
    int at = 1;
    token before = {END, {0, 0}};
    for (token t = next_token(text, 0); t.kind != END && at <= line;
         before = t, t = next_token(text, t.at.end)) {
        at += count_lines(text, seen, t.at.begin);
        seen = t.at.begin;
        source_call call = {.name = t.at};
        if (t.kind != NAME || !is(text, &t, function) || is(text, &before, "function")) continue;
        if (!find_table(text, t.at.end, &call.table)) continue;
        int opens = at + count_lines(text, t.at.begin, call.table.begin);
        if (line < at || line > opens) continue;
        if (count < capacity) out[count] = call;
        count++;
    }
    return count;
}

source_range source_assigned_name(const char *text, const source_call *call) {
    token last[3] = {{END, {0, 0}}, {END, {0, 0}}, {END, {0, 0}}};
    for (token t = next_token(text, 0); t.kind != END && t.at.begin < call->name.begin;
         t = next_token(text, t.at.end)) {
        bool attribute = is(text, &t, ">") && last[2].kind == NAME && is(text, &last[1], "<");
        last[0] = attribute ? last[0] : last[1];
        last[1] = attribute ? last[0] : last[2];
        last[2] = attribute ? last[0] : t;
    }
    bool named = is(text, &last[2], "=") && last[1].kind == NAME;
    return named ? last[1].at : (source_range){0, 0};
}

// ---- what a value is for ------------------------------------------------------------------------

enum { DEEPEST = 64 };

typedef struct level {  // what is between brackets, or a block of statements
    source_range key;   // that the value being read is for; empty: none
    source_range owner; // of a call's table: what the call makes
    bool table, block;
} level;

typedef struct walk {
    level levels[DEEPEST];
    size_t depth; // the innermost is levels[depth]
    token last[5];
} walk;

static bool is_one_of(const char *text, const token *t, const char *const *words) {
    for (; *words; words++)
        if (is(text, t, *words)) return true;
    return false;
}

static bool ends_value(const char *text, const token *t) {
    static const char *const closing[] = {")", "}", "]", "end", NULL}, *const operators[] = {
                                                                           "and",   "or",     "not",
                                                                           "local", "return", NULL};
    return t->kind == NUMBER || t->kind == STRING || is_one_of(text, t, closing) ||
           (t->kind == NAME && !is_one_of(text, t, operators));
}

// Returns what the table that opens now is given to a call for: after "hot = splats {", "hot".
static source_range owner_of(const walk *w, const char *text) {
    const level *l = &w->levels[w->depth];
    size_t name = 4; // in w->last
    if (is(text, &w->last[name], "(")) {
        name--;
        l = w->depth ? l - 1 : l;
    }
    bool direct = w->last[name].kind == NAME && is(text, &w->last[name - 1], "=");
    bool picture = is(text, &(token){NAME, l->key}, "output"); // of the effect: says nothing
    return direct && !picture ? l->key : (source_range){0, 0};
}

static void note_key(walk *w, const char *text, const token *next) {
    level *l = &w->levels[w->depth];
    const token *name = &w->last[4];
    if (is(text, name, ">")) name = &w->last[1]; // local fire <const> =
    if (name->kind == NAME) l->key = name->at;
    bool said = next->kind == STRING && next->at.end >= next->at.begin + 2;
    if (l->table && is(text, name, "name") && said)
        l->owner = (source_range){next->at.begin + 1, next->at.end - 1};
}

static bool note_token(walk *w, const char *text, const token *t) {
    static const char *const begins[] = {"local", "return", "if",   "for", "while",
                                         "then",  "do",     "else", "end", "repeat",
                                         "until", ";",      NULL};
    level *l = &w->levels[w->depth];
    int depth = depth_of(text, t);
    bool statement =
        is_one_of(text, t, begins) ||
        (t->kind == NAME && ends_value(text, &w->last[4]) && ends_value(text, t) && depth == 0);
    if (l->table ? is_separator(text, t) : l->block && statement) l->key = (source_range){0, 0};
    if (is(text, t, "=")) {
        token next = next_token(text, t->at.end);
        note_key(w, text, &next);
    } else if (depth > 0) {
        if (w->depth + 1 == DEEPEST) return false;
        bool table = is(text, t, "{");
        level inner = {.table = table, .block = !table && !strchr("([", text[t->at.begin])};
        if (table) inner.owner = owner_of(w, text);
        w->levels[++w->depth] = inner;
    } else if (depth < 0 && w->depth > 0) {
        w->depth--;
    }
    memmove(w->last, w->last + 1, 4 * sizeof *w->last);
    w->last[4] = *t;
    return true;
}

static bool is_there(source_range range) {
    return range.end > range.begin;
}

bool source_purpose(const char *text, size_t at, char *out, size_t capacity) {
    walk w = {.levels = {{.block = true}}};
    for (token t = next_token(text, 0); t.kind != END && t.at.begin <= at;
         t = next_token(text, t.at.end))
        if (!note_token(&w, text, &t)) return false;
    size_t i = w.depth;
    while (i > 0 && !is_there(w.levels[i].key) && !w.levels[i].block) i--;
    source_range key = w.levels[i].key;
    source_range owner = w.levels[i].table ? w.levels[i].owner : (source_range){0, 0};
    size_t length = key.end - key.begin, before = owner.end - owner.begin + is_there(owner);
    if (length == 0 || before + length >= capacity) return false;
    if (before) snprintf(out, capacity, "%.*s_", (int)before - 1, text + owner.begin);
    memcpy(out + before, text + key.begin, length);
    out[before + length] = 0;
    return true;
}

// ---- tables -------------------------------------------------------------------------------------

bool source_read_entry(const char *text, source_range table, size_t at, source_entry *out) {
    token first = next_token(text, at), second = next_token(text, first.at.end);
    *out = (source_entry){.next = 0};
    if (is(text, &first, "}") || first.kind == END) return false;
    size_t begin = first.at.begin;
    if (first.kind == NAME && is(text, &second, "=")) {
        out->key = first.at;
        begin = next_token(text, second.at.end).at.begin;
    } else if (is(text, &first, "[")) {
        size_t end = skip_nested(text, first.at.begin);
        token equals = next_token(text, end ? end : first.at.end);
        bool quoted = second.kind == STRING && text[second.at.begin] != '[';
        if (is(text, &equals, "=")) begin = next_token(text, equals.at.end).at.begin;
        if (quoted && second.at.end - second.at.begin >= 2)
            out->key = (source_range){second.at.begin + 1, second.at.end - 1};
    }
    out->value = (source_range){begin, begin};
    token t = next_token(text, begin);
    while (t.kind != END && !is_separator(text, &t) && !is(text, &t, "}")) {
        size_t end = depth_of(text, &t) > 0 ? skip_nested(text, t.at.begin) : t.at.end;
        if (end == 0) return false;
        out->value.end = end;
        t = next_token(text, end);
    }
    out->all = (source_range){first.at.begin, out->value.end};
    out->next = is_separator(text, &t) ? t.at.end : t.at.begin;
    return t.kind != END && out->next <= table.end; // brackets may not match
}

static bool is_range(const char *text, source_range range, const char *word) {
    return range.end - range.begin == strlen(word) &&
           strncmp(text + range.begin, word, range.end - range.begin) == 0;
}

bool source_find_value(const char *text, source_range table, const char *key, size_t place,
                       source_range *out) {
    size_t unnamed = 0;
    source_entry e = {.next = table.begin + 1};
    while (source_read_entry(text, table, e.next, &e)) {
        bool named = e.key.end > e.key.begin;
        unnamed += !named;
        *out = e.value;
        if (key ? named && is_range(text, e.key, key) : !named && unnamed == place) return true;
    }
    return false;
}

size_t source_table_end(const char *text, source_range table, bool *first) {
    source_entry e = {.next = table.begin + 1};
    size_t end = table.begin + 1;
    *first = true;
    while (source_read_entry(text, table, e.next, &e)) {
        end = e.value.end;
        *first = false;
    }
    return end;
}

bool source_is_literal(const char *text, source_range value) {
    bool wanted = true; // a value, and no operator, may come next
    for (token t = next_token(text, value.begin); t.at.begin < value.end && t.kind != END;
         t = next_token(text, t.at.end)) {
        token next = next_token(text, t.at.end);
        bool key = t.kind == NAME && is(text, &next, "=") && next.at.begin < value.end;
        bool constant =
            t.kind == NUMBER || t.kind == STRING || is(text, &t, "true") || is(text, &t, "false");
        bool opens = is(text, &t, "{"), closes = is(text, &t, "}");
        if (is_separator(text, &t) || is(text, &t, "=")) {
            wanted = true;
        } else if (is(text, &t, "-") || opens) {
            if (!wanted) return false;
        } else if (constant) {
            if (!wanted) return false;
            wanted = false;
        } else if (closes) {
            wanted = false;
        } else if (!key) {
            return false;
        }
    }
    return value.end > value.begin && !wanted;
}
