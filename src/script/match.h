// Matching of Lua's patterns (Reference Manual 6.4.1) under the instruction budget.
#pragma once
#include "script/vm.h"

enum { MATCH_MAX_CAPTURES = 32 };

typedef enum match_length { // in place of a capture's length
    MATCH_OPEN = -1,        // its ')' was not reached
    MATCH_POSITION = -2,    // "()": stands for its position
} match_length;

typedef struct match_capture {
    const char *start;
    ptrdiff_t length; // or a match_length
} match_capture;

typedef struct matcher { // the first four are the caller's, the rest zero
    lua_State *L;
    const char *text, *text_end, *pattern_end;
    int depth, steps;
    int level; // captures of the last match
    match_capture captures[MATCH_MAX_CAPTURES];
} matcher;

// End of the match of the pattern that begins at p, if there is one exactly at s; else NULL. Raises
// an error when the pattern is malformed or the budget is spent.
const char *match_at(matcher *m, const char *s, const char *p);
