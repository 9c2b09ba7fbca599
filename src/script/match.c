// The matcher of Lua's own library backtracks inside of one C call, where no hook can stop it: n
// repetitions in a pattern take the n-th power of the text's length. This matcher has the same
// semantics and charges every step. Recursion is bounded by MAX_DEPTH, as in Lua.
#include "script/match.h"
#include "base/memory.h"
#include <ctype.h>
#include <string.h>

enum {
    MAX_DEPTH = 200,
    STEPS_CHARGED = 64, // at once
};

static const char *match_pattern(matcher *m, const char *s, const char *p);

static void matcher_step(matcher *m) {
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
    static const struct {
        int letter;
        int (*holds)(int c);
    } classes[] = {{'a', isalpha}, {'c', iscntrl}, {'d', isdigit}, {'g', isgraph}, {'l', islower},
                   {'p', ispunct}, {'s', isspace}, {'u', isupper}, {'w', isalnum}, {'x', isxdigit}};
    for (size_t i = 0; i < COUNT_OF(classes); i++)
        if (classes[i].letter == tolower(class)) return !classes[i].holds(c) == !!isupper(class);
    return class == c;
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

// Returns whether the item [p, end) matches the character at s.
static bool item_matches(matcher *m, const char *s, const char *p, const char *end) {
    matcher_step(m);
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
        const char *result = match_pattern(m, s + i, end + 1);
        if (result) return result;
    }
    return NULL;
}

static const char *match_shortest(matcher *m, const char *s, const char *p, const char *end) {
    for (;;) {
        const char *result = match_pattern(m, s, end + 1);
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
        matcher_step(m);
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
    if (m->level >= MATCH_MAX_CAPTURES) vm_error(m->L, "too many captures");
    m->captures[m->level++] = (match_capture){s, kind};
    const char *result = match_pattern(m, s, p);
    if (!result) m->level--;
    return result;
}

static const char *end_capture(matcher *m, const char *s, const char *p) {
    int i = m->level - 1;
    while (i >= 0 && m->captures[i].length != MATCH_OPEN) i--;
    if (i < 0) vm_error(m->L, "invalid pattern capture");
    m->captures[i].length = s - m->captures[i].start;
    const char *result = match_pattern(m, s, p);
    if (!result) m->captures[i].length = MATCH_OPEN;
    return result;
}

// Matches the text of an earlier capture, %1 to %9.
static const char *match_back(matcher *m, const char *s, char digit) {
    int i = digit - '1';
    if (i < 0 || i >= m->level || m->captures[i].length == MATCH_OPEN)
        vm_error(m->L, "invalid capture index %%%d", i + 1);
    ptrdiff_t length = m->captures[i].length;
    if (length < 0) length = 0;
    if (m->text_end - s < length) return NULL;
    vm_charge(m->L, (uint64_t)length / 16);
    return memcmp(m->captures[i].start, s, (size_t)length) == 0 ? s + length : NULL;
}

// ---- the matcher ------------------------------------------------------------------------------

// Matches one item and its suffix. True: continue with the rest of the pattern at *s, *p. False: *s
// is the result of the whole match.
static bool match_item(matcher *m, const char **s, const char **p) {
    const char *item = *p, *end = item_end(m, item);
    char suffix = end < m->pattern_end ? *end : 0;
    switch (suffix) {
    case '?':
        if (item_matches(m, *s, item, end)) {
            const char *result = match_pattern(m, *s + 1, end + 1);
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

// Matches items that begin with '%' and are not a single character. Sets *s to where the match
// continues, or NULL. Returns false when the item is a plain one.
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
static const char *match_pattern(matcher *m, const char *s, const char *p) {
    if (++m->depth > MAX_DEPTH) vm_error(m->L, "pattern too complex");
    while (s && p < m->pattern_end) {
        matcher_step(m);
        if (*p == '(') {
            bool position = p + 1 < m->pattern_end && p[1] == ')';
            s = position ? start_capture(m, s, p + 2, MATCH_POSITION)
                         : start_capture(m, s, p + 1, MATCH_OPEN);
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

const char *match_at(matcher *m, const char *s, const char *p) {
    m->level = 0;
    m->depth = 0;
    return match_pattern(m, s, p);
}
