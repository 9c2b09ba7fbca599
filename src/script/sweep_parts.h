// Shared by the parts of the sweep reader: values of axes before they are combined.
#pragma once
#include "base/str.h"
#include "script/sweep.h"
#include "script/vm.h"

// What a value of an axis, a reference or the sweep itself sets in rows. Members that are not set
// are zero, or negative where zero has a meaning.
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
    const char *said;         // the text that functions of the file get
    bool named;               // the text is a name given by the file
    sweep_patch patch;
    int type; // Lua type of what functions of the file get: a number, a boolean, else the text
    double number;
} sweep_value;

typedef struct sweep_list { // axis { }
    const char *name, *label;
    sweep_value *values;
    size_t count;
} sweep_list;

typedef struct sweep_group { // axes that advance together: zip { }, or a single one
    const sweep_list *const *lists;
    size_t list_count;
} sweep_group;

typedef struct sweep_reader { // owned outside of Lua, so that errors do not lose it
    arena *memory;
    const sweep_options *options;
    char folder[PATH_CAP]; // of the file
    strbuf text;           // of the value being read
    sweep *out;
    sweep_patch base;
    const sweep_group *groups;
    size_t group_count;
    bool has_reference;
    sweep_patch reference;              // replaces a row's own
    const sweep_value **reference_axes; // by number of the axis: the reference's value; NULL: the
                                        // row's own
    bool *reference_drops; // by number of the axis: a setting of the reference replaces it
    int skip, published;   // functions: registry references, or LUA_NOREF
} sweep_reader;

sweep_reader *sweep_reader_of(lua_State *L);
void *sweep_reserve(lua_State *L, size_t count, size_t size); // zeroed; lives with the sweep

// ---- sweep_value.c: all raise errors ----------------------------------------------------------

sweep_patch sweep_patch_empty(void);
bool sweep_is_special(const char *key); // a key of a row that is not a setting
// Reads the value at the top of the stack as `key`, a special key or a setting.
void sweep_patch_take(lua_State *L, const char *who, const char *key, sweep_patch *patch);
// Reads the table of settings at `table`.
void sweep_patch_take_settings(lua_State *L, int table, const char *who, sweep_patch *patch);
// Reads one value of an axis at the top of the stack.
void sweep_value_take(lua_State *L, const char *who, const sweep_list *of, sweep_value *out);
double sweep_take_number(lua_State *L, const char *who, const char *key, double min, double max);
uint32_t sweep_take_count(lua_State *L, const char *who, const char *key, uint32_t min,
                          uint32_t max);
const char *sweep_take_text(lua_State *L, const char *who, const char *key);

// ---- sweep_expand.c ---------------------------------------------------------------------------

// Combines the groups and fills rows and references. Raises errors, including those of `skip` and
// `published`.
void sweep_expand(lua_State *L, sweep_reader *r);
