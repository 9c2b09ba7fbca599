// Numbers of layers { {2, 1}, {7, 0.4}, seed = 3 } become controls: "lumps.scale_1",
// "lumps.strength_1", "lumps.seed". The noise itself is made of them by the prelude.
#include "base/memory.h"
#include "base/str.h"
#include "script/binding.h"
#include <string.h>

enum { MOST = 64, SHARED = 16 };
static const char who[] = "layers";

typedef struct layer_list {
    field *values[MOST][2]; // NULL: no number is written there
    const value_desc *shared[SHARED];
    field *shared_values[SHARED];
    size_t count, shared_count;
} layer_list;

// Returns what a kind of noise says of its argument; NULL: there is none of that name.
static const value_desc *noise_argument(const char *name) {
    static const char *const kinds[] = {"perlin", "worley"};
    for (size_t k = 0; k < COUNT_OF(kinds); k++) {
        const field_kind *kind = field_kind_find(kinds[k]);
        for (size_t i = 0; i < FIELD_MAX_ARGS && kind->args[i].desc.name; i++)
            if (strcmp(kind->args[i].desc.name, name) == 0) return &kind->args[i].desc;
    }
    return NULL;
}

// Makes a field of the number at the top of the stack, in its place. NULL: it is no number.
static field *take_number(lua_State *L) {
    if (lua_type(L, -1) != LUA_TNUMBER) return NULL;
    float value[4] = {(float)lua_tonumber(L, -1)};
    field *node = field_constant(script_memory(L), 1, value);
    lua_pop(L, 1);
    field_push(L, node);
    script_note_place(L, node, who);
    return node;
}

// Pushes a copy of layer `i`, from 1, of the table at 1.
static void take_layer(lua_State *L, layer_list *list, size_t i) {
    lua_createtable(L, 2, 0);
    lua_rawgeti(L, 1, (lua_Integer)i);
    for (int part = 0; part < 2; part++) {
        lua_rawgeti(L, -1, part + 1);
        list->values[i - 1][part] = take_number(L);
        lua_rawseti(L, -3, part + 1);
    }
    lua_pop(L, 1);
}

// Moves the value at the top of the stack to the key `name` of the table at 2.
static void put_shared(lua_State *L, layer_list *list, const char *name) {
    const value_desc *desc = noise_argument(name);
    field *value = desc && list->shared_count < SHARED ? take_number(L) : NULL;
    if (value) {
        list->shared[list->shared_count] = desc;
        list->shared_values[list->shared_count++] = value;
    }
    lua_setfield(L, 2, name);
}

// Takes what is for all layers from the table at 1, and what it leaves open.
static void take_shared(lua_State *L, layer_list *list) {
    size_t count;
    const char **names = value_names(L, 1, who, &count);
    for (size_t i = 0; i < count; i++) {
        value_get(L, 1, names[i]);
        put_shared(L, list, names[i]);
    }
    lua_pop(L, 1);
    static const struct {
        const char *name;
        double value;
    } open[] = {{"seed", 0}, {"octaves", 1}};
    for (size_t i = 0; i < COUNT_OF(open); i++) {
        bool given = value_get(L, 1, open[i].name) != LUA_TNIL;
        lua_pop(L, 1);
        if (given) continue;
        lua_pushnumber(L, open[i].value);
        put_shared(L, list, open[i].name);
    }
}

// The prelude's layers calls it with a table that it has checked, for a copy with fields in the
// place of numbers.
int l_layers(lua_State *L) {
    effect *e = script_of(L)->effect;
    script_require_loading(L, who);
    layer_list list = {.count = lua_rawlen(L, 1)};
    lua_settop(L, 1);
    if (list.count > MOST || !effect_has_room_for_field(e)) return 1;
    vm_charge_memory(L, (2 * list.count + SHARED) * EFFECT_CONTROL_COST);
    lua_createtable(L, (int)list.count, SHARED);
    for (size_t i = 1; i <= list.count; i++) {
        take_layer(L, &list, i);
        lua_rawseti(L, 2, (lua_Integer)i);
    }
    take_shared(L, &list);
    char name[64];
    if (!value_variable(L, who, name, sizeof name)) str_copy(name, sizeof name, who);
    const effect_layers *made =
        effect_add_layers(e, name, (field *const(*)[2])list.values, list.count, list.shared,
                          list.shared_values, list.shared_count);
    if (!made) script_raise(L);
    script_note_place(L, made, who);
    return 1;
}
