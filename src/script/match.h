// Matches Lua's patterns (Reference Manual 6.4.1) within the limit of instructions.
#pragma once
#include "script/vm.h"

enum { MATCH_MAX_CAPTURES = 32 };

typedef enum match_length { // special lengths of captures
    MATCH_OPEN = -1,        // its ')' was not reached
    MATCH_POSITION = -2,    // "()": the capture is a position
} match_length;

typedef struct match_capture {
    const char *start;
    ptrdiff_t length; // or a match_length
} match_capture;

typedef struct matcher { // the caller sets the first four members, the rest is zero
    lua_State *L;
    const char *text, *text_end, *pattern_end;
    int depth, steps;
    int level; // captures of the last match
    match_capture captures[MATCH_MAX_CAPTURES];
} matcher;

// Matches the pattern at p exactly at s. Returns the end of the match, or NULL. Raises an error
// when the pattern is malformed or no instructions are left.
const char *match_at(matcher *m, const char *s, const char *p);
