// param { "density", 20, min = 0, max = 100, unit = "1/m", help = "..." }: its type follows from
// the default: a number (integer = true: a whole one), true or false, "#rrggbb", {x, y, z} (color =
// true: a colour); with words = { ... } one of these.
#include "base/memory.h"
#include "script/binding.h"
#include <math.h>
#include <string.h>

static const char who[] = "param";

static void read_words(lua_State *L, effect_param *param) {
    if (value_get(L, 1, "words") == LUA_TNIL) {
        lua_pop(L, 1);
        return;
    }
    lua_Unsigned count = lua_type(L, -1) == LUA_TTABLE ? lua_rawlen(L, -1) : 0;
    if (count < 1 || count > 64)
        vm_error(L, "param '%s': words must be a list of 1 to 64 words", param->name);
    arena *memory = script_memory(L);
    const char **words = arena_alloc(memory, (size_t)count * sizeof *words);
    for (size_t i = 0; i < count; i++) {
        if (lua_rawgeti(L, -1, (lua_Integer)i + 1) != LUA_TSTRING)
            vm_error(L, "param '%s': words must be strings", param->name);
        vm_charge_memory(L, lua_rawlen(L, -1) + 1);
        words[i] = arena_string(memory, lua_tostring(L, -1));
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    param->type = EFFECT_ENUM;
    param->words = words;
    param->word_count = (size_t)count;
}

// The default lies at the top of the stack.
static void read_default(lua_State *L, effect_param *param) {
    int type = lua_type(L, -1);
    if (param->words) {
        param->initial[0] =
            (float)value_word(L, -1, param->name, "default", param->words, param->word_count);
        return;
    }
    int count = value_numbers(L, -1, param->initial);
    bool integer = value_get_bool(L, 1, who, "integer", false);
    bool color = value_get_bool(L, 1, who, "color", false);
    if (type == LUA_TBOOLEAN)
        param->type = EFFECT_BOOL;
    else if (type == LUA_TSTRING && count >= 3)
        param->type = EFFECT_COLOR;
    else if (type == LUA_TTABLE && count == 3)
        param->type = color ? EFFECT_COLOR : EFFECT_VEC3;
    else if (type == LUA_TNUMBER)
        param->type = integer ? EFFECT_INT : EFFECT_FLOAT;
    else
        vm_error(L,
                 "param '%s': the default must be a number, true or false, \"#rrggbb\", {x, y, z}, "
                 "or one of words = { ... }",
                 param->name);
    if (color && param->type != EFFECT_COLOR)
        vm_error(L, "param '%s': color = true needs {r, g, b} as default", param->name);
    if (integer && (param->type != EFFECT_INT || param->initial[0] != rintf(param->initial[0])))
        vm_error(L, "param '%s': integer = true needs a whole number as default", param->name);
}

static int l_param(lua_State *L) {
    script_require_loading(L, who);
    value_check_object(L, 1, who);
    lua_settop(L, 1);
    arena *memory = script_memory(L);
    if (lua_rawgeti(L, 1, 1) != LUA_TSTRING)
        vm_error(L, "param: its name comes first, as in param { \"density\", 20 }");
    vm_charge_memory(L, sizeof(effect_param) + EFFECT_CONTROL_COST + lua_rawlen(L, -1));
    effect_param param = {
        .name = arena_string(memory, lua_tostring(L, -1)),
        .unit = value_get_string(L, 1, who, "unit"),
        .help = value_get_string(L, 1, who, "help"),
        .group = value_get_string(L, 1, who, "group"),
        .log_scale = value_get_bool(L, 1, who, "log", false),
        .min = -INFINITY,
        .max = INFINITY,
    };
    if (!param.unit) param.unit = "";
    if (!param.help) param.help = "";
    if (!param.group) param.group = "";
    read_words(L, &param);
    if (lua_rawlen(L, 1) > 2) vm_error(L, "param '%s': one default is accepted", param.name);
    lua_rawgeti(L, 1, 2);
    read_default(L, &param);
    bool ranged = param.type != EFFECT_ENUM && param.type != EFFECT_BOOL;
    if (ranged) {
        param.min = (float)value_get_number(L, 1, who, "min", -(double)INFINITY);
        param.max = (float)value_get_number(L, 1, who, "max", (double)INFINITY);
    } else {
        param.min = 0;
        param.max = param.type == EFFECT_ENUM ? (float)param.word_count - 1 : 1;
    }
    if (param.log_scale && !(param.min > 0))
        vm_error(L, "param '%s': log = true needs min above 0", param.name);
    memcpy(param.value, param.initial, sizeof param.value);
    int index = effect_add_param(script_of(L)->effect, &param);
    if (index < 0) script_raise(L);
    int components = param.type == EFFECT_VEC3 || param.type == EFFECT_COLOR ? 3 : 1;
    field_push_param(L, field_param(memory, components, index), index);
    return 1;
}

void l_param_open(lua_State *L) {
    lua_register(L, who, l_param);
}
