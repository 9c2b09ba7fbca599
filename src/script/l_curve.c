// curve { {0, 1}, {0.5, 3}, shape = "cubic", period = 2 }: keys of time (s) and value.
#include "script/binding.h"

enum {
    KEYS_MAX = 4096,
    TEXT_COST = 64, // bytes of a key that is told as text
};

static const char who[] = "curve";

// Reads the value of key i at the top of the stack.
static int read_value(lua_State *L, int i, float out[4]) {
    int count = value_numbers(L, -1, out);
    if (count == 0)
        vm_error(L, "curve: key %d must be {time, value}: a number, {x, y, z} or \"#rrggbb\"", i);
    return count;
}

int l_curve(lua_State *L) {
    script_require_loading(L, who);
    const script_object *row = value_check_object(L, 1, who);
    lua_Unsigned count = lua_rawlen(L, 1);
    if (count < 1 || count > KEYS_MAX)
        vm_error(L, "curve: 1 to %d keys are accepted, as in curve { {0, 1}, {0.5, 3} }", KEYS_MAX);
    curve_key *list = lua_newuserdatauv(L, (size_t)count * sizeof *list, 0);
    curve desc = {
        .shape = (curve_shape)value_get_choice(L, 1, row, "shape"),
        .period = (float)value_get_number(L, 1, who, "period", 0),
        .keys = list,
        .count = (size_t)count,
    };
    for (int i = 1; i <= (int)count; i++) {
        curve_key *key = &list[i - 1];
        if (lua_rawgeti(L, 1, i) != LUA_TTABLE || lua_rawlen(L, -1) != 2)
            vm_error(L, "curve: key %d must be {time, value}", i);
        if (lua_rawgeti(L, -1, 1) != LUA_TNUMBER)
            vm_error(L, "curve: the time of key %d must be a number", i);
        key->time = (float)lua_tonumber(L, -1);
        lua_pop(L, 1);
        lua_rawgeti(L, -1, 2);
        int components = read_value(L, i, key->value);
        if (i > 1 && components != desc.components)
            vm_error(L, "curve: key %d has %d components, the first has %d", i, components,
                     desc.components);
        desc.components = components;
        lua_pop(L, 2);
    }
    vm_charge_memory(L, EFFECT_CONTROL_COST + desc.count * (sizeof *list + TEXT_COST));
    curve *c = curve_create(script_memory(L), &desc);
    const char *name = c ? value_name_or_purpose(L, 1, who) : NULL;
    if (!name || !effect_add_curve(script_of(L)->effect, c, name)) script_raise(L);
    script_note_place(L, c, who);
    field_push(L, field_curve(script_memory(L), c));
    return 1;
}
