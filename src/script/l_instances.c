// Instances while the effect runs: forest:get(i), forest:set(i, { ... }), forest:set_all { ... },
// forest:near({x, y, z}, radius), #forest. Counts from 1, as Lua does.
#include "base/memory.h"
#include "script/instances.h"
#include <math.h>
#include <string.h>

static const char type_name[] = "instances";
enum { ENTRY_COST = 4 }; // of one that is looked at or set, in instructions of the script

static scene_instances *self(lua_State *L, const char *method) {
    const instances_object *object = object_test(L, 1, type_name);
    if (!object)
        vm_error(L, "%s is a method of instances { }: forest:%s(...), with a colon", method,
                 method);
    return object->instances;
}

scene_instances *value_instances(lua_State *L, int index) {
    const instances_object *object = object_test(L, index, type_name);
    return object ? object->instances : NULL;
}

void instances_push(lua_State *L, const scene_instances *instances) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, instances);
}

static uint32_t check_index(lua_State *L, int index, const scene_instances *s) {
    uint32_t count = scene_instances_count(s);
    lua_Integer i =
        lua_isinteger(L, index) ? lua_tointeger(L, index)
        : lua_isnumber(L, index) && lua_tonumber(L, index) == floor(lua_tonumber(L, index))
            ? (lua_Integer)lua_tonumber(L, index)
            : 0;
    if (i < 1 || i > (lua_Integer)count)
        vm_error(L, "%s: there is no instance %s; 1 to %d are there", scene_instances_name(s),
                 luaL_tolstring(L, index, NULL), (int)count);
    return (uint32_t)i - 1;
}

// ---- get --------------------------------------------------------------------------------------

static int l_get(lua_State *L) {
    const scene_instances *s = self(L, "get");
    const struct instance_entry *e = &scene_instances_entries(s)[check_index(L, 2, s)];
    float random;
    memcpy(&random, &e->kind.v[2], sizeof random);
    lua_createtable(L, 0, 9);
    value_put_numbers(L, "position", e->place.v, 3);
    value_put_number(L, "scale", (double)e->place.v[3]);
    value_put_number(L, "yaw", (double)instance_yaw(e));
    value_put_numbers(L, "color", e->color.v, 3);
    value_put_number(L, "glow", (double)e->color.v[3]);
    value_put_numbers(L, "state", e->state.v, 4);
    value_put_number(L, "random", (double)random);
    lua_pushinteger(L, e->kind.v[0] == INSTANCE_HIDDEN ? 0 : (lua_Integer)e->kind.v[0] + 1);
    lua_setfield(L, -2, "kind");
    return 1;
}

// ---- set --------------------------------------------------------------------------------------

static _Noreturn void refuse_key(lua_State *L, const char *who, const char *name) {
    value_unknown(L, who, "key", name, instance_key_names, INSTANCE_KEYS);
}

// Pushes the values of the table at `table` in the order of instance_key; nil: not given.
static int push_values(lua_State *L, int table, const char *who) {
    if (!value_is_plain_table(L, table))
        vm_error(L, "%s: what is set is a table, as in { kind = 2, scale = 1 }; got %s", who,
                 object_kind(L, table));
    luaL_checkstack(L, 2 * INSTANCE_KEYS + LUA_MINSTACK, who); // lists stand beside them in set_all
    int base = lua_gettop(L) + 1, given = 0, known = 0;
    for (int k = 0; k < INSTANCE_KEYS; k++)
        known += value_get(L, table, instance_key_names[k]) != LUA_TNIL;
    for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) given++;
    if (given == known) return base;
    for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) { // some key is none
        if (lua_type(L, -2) != LUA_TSTRING)
            vm_error(L, "%s: a key is %s; keys are names", who, object_kind(L, -2));
        bool found = false;
        for (int k = 0; k < INSTANCE_KEYS; k++)
            found = found || strcmp(lua_tostring(L, -2), instance_key_names[k]) == 0;
        if (!found) refuse_key(L, who, lua_tostring(L, -2));
    }
    return base;
}

static void set_one(lua_State *L, scene_instances *s, uint32_t index, int base) {
    scene_mesh *const *kinds;
    size_t kind_count = scene_instances_kinds(s, &kinds);
    struct instance_entry entry = scene_instances_entries(s)[index];
    for (int k = 0; k < INSTANCE_KEYS; k++)
        if (!lua_isnil(L, base + k))
            instance_read(L, base + k, scene_instances_name(s), (instance_key)k, kind_count,
                          &entry);
    scene_instances_set(s, index, &entry);
}

static int l_set(lua_State *L) {
    scene_instances *s = self(L, "set");
    lua_settop(L, 3);
    int base = push_values(L, 3, scene_instances_name(s));
    if (!value_is_plain_table(L, 2)) {
        set_one(L, s, check_index(L, 2, s), base);
        return 0;
    }
    lua_Unsigned count = lua_rawlen(L, 2);
    vm_charge(L, ENTRY_COST * count);
    for (lua_Unsigned i = 1; i <= count; i++) {
        lua_rawgeti(L, 2, (lua_Integer)i);
        uint32_t index = check_index(L, -1, s);
        lua_pop(L, 1);
        set_one(L, s, index, base);
    }
    return 0;
}

// Lists, which start at `base`, have a value for each instance; they are replaced one by one.
static int l_set_all(lua_State *L) {
    scene_instances *s = self(L, "set_all");
    const char *who = scene_instances_name(s);
    uint32_t count = scene_instances_count(s);
    lua_settop(L, 2);
    int base = push_values(L, 2, who), lists[INSTANCE_KEYS];
    for (int k = 0; k < INSTANCE_KEYS; k++) {
        lists[k] = 0;
        if (lua_isnil(L, base + k) || !instance_is_list(L, base + k, (instance_key)k)) continue;
        if (lua_rawlen(L, base + k) != count)
            vm_error(L, "%s: '%s' has %d values; one, or %d are accepted", who,
                     instance_key_names[k], (int)lua_rawlen(L, base + k), (int)count);
        lua_pushvalue(L, base + k);
        lists[k] = lua_gettop(L);
    }
    vm_charge(L, (uint64_t)ENTRY_COST * count);
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < INSTANCE_KEYS; k++) {
            if (!lists[k]) continue;
            lua_rawgeti(L, lists[k], (lua_Integer)i + 1);
            lua_replace(L, base + k);
        }
        set_one(L, s, i, base);
    }
    return 0;
}

static int l_reset(lua_State *L) {
    scene_instances *s = self(L, "reset");
    vm_charge(L, scene_instances_count(s));
    scene_instances_reset(s);
    return 0;
}

// ---- asking -----------------------------------------------------------------------------------

static int l_near(lua_State *L) {
    scene_instances *s = self(L, "near");
    lua_settop(L, 3);
    float point[4];
    int count = value_numbers(L, 2, point);
    double radius = lua_tonumber(L, 3);
    if (count != 2 && count != 3)
        vm_error(L,
                 "%s: near takes a point and a radius, as in near({0, 0, 0}, 4); its point is "
                 "%s",
                 scene_instances_name(s), object_kind(L, 2));
    for (int i = 0; i < count; i++)
        if (!isfinite(point[i])) vm_error(L, "near: its point must be finite");
    if (lua_type(L, 3) != LUA_TNUMBER || !(radius >= 0 && radius <= 1e6))
        vm_error(L, "near: its radius is %s; 0 to 1e6 m is accepted", luaL_tolstring(L, 3, NULL));
    uint32_t few[64], *found = few;
    size_t n = scene_instances_near(s, point, (float)radius, few, COUNT_OF(few));
    vm_charge(L, ENTRY_COST * (n + 16));
    if (n > COUNT_OF(few)) {
        found = lua_newuserdatauv(L, n * sizeof *found, 0);
        scene_instances_near(s, point, (float)radius, found, n);
    }
    lua_createtable(L, (int)n, 0);
    for (size_t i = 0; i < n; i++) {
        lua_pushinteger(L, (lua_Integer)found[i] + 1);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

static int l_length(lua_State *L) {
    lua_pushinteger(L, scene_instances_count(self(L, "#")));
    return 1;
}

static int l_index(lua_State *L) {
    static const luaL_Reg methods[] = {{"get", l_get},     {"set", l_set},   {"set_all", l_set_all},
                                       {"reset", l_reset}, {"near", l_near}, {NULL, NULL}};
    return object_method(L, type_name, methods);
}

void l_instances_open(lua_State *L) {
    static const luaL_Reg methods[] = {{"__index", l_index}, {"__len", l_length}, {NULL, NULL}};
    object_type(L, type_name, methods);
    lua_register(L, type_name, l_instances);
}
