// What the parts of the sweep reader share: values of axes before they are crossed.
#pragma once
#include "base/str.h"
#include "script/sweep.h"
#include "script/vm.h"

// What a value of an axis, a reference or the sweep itself says of rows; what it does not say is
// zero, or below zero where zero says something.
typedef struct sweep_patch {
    const char *effect, *inside; // the latter is there with the former
    uint32_t width, height;
    double *frames;
    size_t frame_count;
    double first, last; // of `time`
    int warmup, repeats;
    double limit;
    const char **edits;
    size_t edit_count;
    const char *command;
    int empty_cache;
    sweep_pair *settings; // by rising name
    size_t setting_count;
} sweep_patch;

typedef struct sweep_value {
    const char *text, *label; // "16", "steps 16"
    const char *said;         // the text that functions of the file see
    bool named;               // the text is a name that the file gives
    sweep_patch patch;
    int type; // of Lua: what functions of the file get to see, a number, a boolean, else the text
    double number;
} sweep_value;

typedef struct sweep_list { // axis { }
    const char *name, *label;
    sweep_value *values;
    size_t count;
} sweep_list;

typedef struct sweep_group { // axes that go together: zip { }, or one alone
    const sweep_list *const *lists;
    size_t list_count;
} sweep_group;

typedef struct sweep_reader { // outlives the errors that Lua raises
    arena *memory;
    const sweep_options *options;
    char folder[PATH_CAP]; // of the file
    strbuf text;           // of the value being read
    sweep *out;
    sweep_patch base;
    const sweep_group *groups;
    size_t group_count;
    bool has_reference;
    sweep_patch reference;              // over a row's own
    const sweep_value **reference_axes; // by number of the axis: the value that stands in; NULL:
                                        // the row's own
    bool *reference_drops; // by number of the axis: a setting of the reference stands in
    int skip, published;   // functions: registry references, or LUA_NOREF
} sweep_reader;

sweep_reader *sweep_reader_of(lua_State *L);

// ---- sweep_value.c: all raise errors ----------------------------------------------------------

sweep_patch sweep_patch_empty(void);
bool sweep_is_special(const char *key); // is no setting, but what a row has beside them
// Takes the value at the top of the stack for `key`, a special key or a setting.
void sweep_patch_take(lua_State *L, const char *who, const char *key, sweep_patch *patch);
// Takes the table of settings at `table`.
void sweep_patch_take_settings(lua_State *L, int table, const char *who, sweep_patch *patch);
// One value of an axis, at the top of the stack.
void sweep_value_take(lua_State *L, const char *who, const sweep_list *of, sweep_value *out);
double sweep_take_number(lua_State *L, const char *who, const char *key, double min, double max);
uint32_t sweep_take_count(lua_State *L, const char *who, const char *key, uint32_t min,
                          uint32_t max);
const char *sweep_take_text(lua_State *L, const char *who, const char *key);

// ---- sweep_expand.c ---------------------------------------------------------------------------

// Crosses the groups: fills rows and references. Raises errors, those of `skip` and `published`
// included.
void sweep_expand(lua_State *L, sweep_reader *r);
