// Calls with a table, and the values in it, found in the text of a Lua file by its tokens: nothing
// is run. Offsets are bytes of the text, which ends with a NUL and may be anything.
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct source_range {
    size_t begin, end; // equal: nothing
} source_range;

typedef struct source_call {
    source_range name;  // of the function: "march"
    source_range table; // with its braces
} source_call;

// Finds the calls of a function with a table, NAME { ... } or NAME(..., { ... }), whose name or
// table begins in a line, from 1. Returns how many there are.
size_t source_find_calls(const char *text, const char *function, int line, source_call *out,
                         size_t capacity);
typedef struct source_entry {     // of a table
    source_range all, key, value; // key: empty where it has no name
    size_t next;                  // where the rest of the table begins
} source_entry;

// Reads the entry at `at`: one byte after the table's brace, or the `next` of the one before.
// False: the table has no more.
bool source_read_entry(const char *text, source_range table, size_t at, source_entry *out);
// Finds the value of a key in a table, or where `key` is NULL the value without a name at a place,
// from 1. False: the table does not have it.
bool source_find_value(const char *text, source_range table, const char *key, size_t place,
                       source_range *out);
// Returns where another entry of the table can be written, as in ", steps = 64"; `*first`: it is
// the only one, and needs no comma.
size_t source_table_end(const char *text, source_range table, bool *first);
// Returns whether the value is written out: a number, a text, true, false, or a table of these.
bool source_is_literal(const char *text, source_range value);
// Returns the name of the variable or the key that a call's value is assigned to; empty: none.
source_range source_assigned_name(const char *text, const source_call *call);
// Names what the value of the call at `at` is for: the variable or the key that it is a part of. A
// key of a call's table comes after what that call makes, by its key `name` before or its variable:
// local hot = splats { size = 2 * over_age { ... } } gives "hot_size". False: it has no name.
bool source_purpose(const char *text, size_t at, char *out, size_t capacity);
