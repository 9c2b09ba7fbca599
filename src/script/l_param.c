// param { "density", 20, min = 0, max = 100, unit = "1/m", help = "..." }: its type follows from
// the default: a number (integer = true: a whole one), true or false, "#rrggbb", {x, y, z} (color =
// true: a colour); with words = { ... } one of these.
#include "script/binding.h"
#include <math.h>

static const char who[] = "param";

static void read_words(lua_State *L, value_desc *desc) {
    if (value_get(L, 1, "words") == LUA_TNIL) {
        lua_pop(L, 1);
        return;
    }
    lua_Unsigned count = lua_type(L, -1) == LUA_TTABLE ? lua_rawlen(L, -1) : 0;
    if (count < 1 || count > 64)
        vm_error(L, "param '%s': words must be a list of 1 to 64 words", desc->name);
    arena *memory = script_memory(L);
    const char **words = arena_alloc(memory, (size_t)count * sizeof *words);
    for (size_t i = 0; i < count; i++) {
        if (lua_rawgeti(L, -1, (lua_Integer)i + 1) != LUA_TSTRING)
            vm_error(L, "param '%s': words must be strings", desc->name);
        vm_charge_memory(L, lua_rawlen(L, -1) + 1);
        words[i] = arena_string(memory, lua_tostring(L, -1));
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    desc->type = VALUE_WORD;
    desc->words = words;
    desc->word_count = (size_t)count;
}

// The default lies at the top of the stack.
static void read_default(lua_State *L, value_desc *desc) {
    int type = lua_type(L, -1);
    desc->components = 1;
    if (desc->words) {
        desc->value[0] =
            (float)value_word(L, -1, desc->name, "default", desc->words, desc->word_count);
        return;
    }
    int count = value_numbers(L, -1, desc->value);
    bool integer = value_get_bool(L, 1, who, "integer", false);
    bool color = value_get_bool(L, 1, who, "color", false);
    bool hex = type == LUA_TSTRING && count >= 3, vector = type == LUA_TTABLE && count == 3;
    if (type == LUA_TBOOLEAN)
        desc->type = VALUE_BOOL;
    else if (hex || vector)
        desc->type = hex || color ? VALUE_COLOR : VALUE_NUMBER;
    else if (type == LUA_TNUMBER)
        desc->type = integer ? VALUE_WHOLE : VALUE_NUMBER;
    else
        vm_error(L,
                 "param '%s': the default must be a number, true or false, \"#rrggbb\", {x, y, z}, "
                 "or one of words = { ... }",
                 desc->name);
    if (hex || vector) desc->components = 3;
    if (color && desc->type != VALUE_COLOR)
        vm_error(L, "param '%s': color = true needs {r, g, b} as default", desc->name);
    if (integer && (desc->type != VALUE_WHOLE || desc->value[0] != rintf(desc->value[0])))
        vm_error(L, "param '%s': integer = true needs a whole number as default", desc->name);
}

static const char *get_text(lua_State *L, const char *key) {
    const char *text = value_get_string(L, 1, who, key);
    return text ? text : "";
}

int l_param(lua_State *L) {
    script_require_loading(L, who);
    value_check_object(L, 1, who);
    lua_settop(L, 1);
    arena *memory = script_memory(L);
    if (lua_rawgeti(L, 1, 1) != LUA_TSTRING)
        vm_error(L, "param: its name comes first, as in param { \"density\", 20 }");
    vm_charge_memory(L, sizeof(effect_param) + EFFECT_CONTROL_COST + lua_rawlen(L, -1));
    effect_param param = {
        .desc = {.name = arena_string(memory, lua_tostring(L, -1)),
                 .unit = get_text(L, "unit"),
                 .help = get_text(L, "help")},
        .group = get_text(L, "group"),
        .log_scale = value_get_bool(L, 1, who, "log", false),
    };
    value_desc *desc = &param.desc;
    read_words(L, desc);
    if (lua_rawlen(L, 1) > 2) vm_error(L, "param '%s': one default is accepted", desc->name);
    lua_rawgeti(L, 1, 2);
    read_default(L, desc);
    if (desc->type == VALUE_WORD || desc->type == VALUE_BOOL) {
        desc->max = desc->words ? (float)desc->word_count - 1 : 1;
    } else {
        desc->min = (float)value_get_number(L, 1, who, "min", -(double)INFINITY);
        desc->max = (float)value_get_number(L, 1, who, "max", (double)INFINITY);
    }
    if (param.log_scale && !(desc->min > 0))
        vm_error(L, "param '%s': log = true needs min above 0", desc->name);
    int index = effect_add_param(script_of(L)->effect, &param);
    if (index < 0) script_raise(L);
    script_note_place(L, effect_get_param(script_of(L)->effect, (size_t)index), who);
    field_push_param(L, field_param(memory, desc->components, index), index);
    return 1;
}
