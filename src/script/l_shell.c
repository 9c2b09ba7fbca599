// Fireballs: explosions { {0.5, position = {0, 0, 1}}, ... } is a list of times and places, shell {
// at = list, ... } draws them. While the effect runs, list:add { } adds one.
#include "base/memory.h"
#include "effect/events.h"
#include "pass/shell/shell.h"
#include "script/binding.h"
#include <math.h>

typedef struct explosions_object {
    scene_explosions *list;
} explosions_object;

static const char who[] = "explosions";

static scene_explosions *self(lua_State *L, const char *method) {
    const explosions_object *object = object_test(L, 1, who);
    if (!object)
        vm_error(L, "%s is a method of explosions { }: blasts:%s(...), with a colon", method,
                 method);
    return object->list;
}

// ---- one of them ------------------------------------------------------------------------------

static const char *name_of(lua_State *L, int number) {
    return number > 0 ? lua_pushfstring(L, "explosions: number %d", number) : "explosions:add";
}

static double first_number(lua_State *L, int table, const char *name, double otherwise) {
    int type = lua_rawgeti(L, table, 1);
    if (type != LUA_TNIL && type != LUA_TNUMBER)
        vm_error(L, "%s: its time is %s; a number of seconds is accepted", name,
                 object_kind(L, -1));
    double time = type == LUA_TNUMBER ? lua_tonumber(L, -1) : otherwise;
    lua_pop(L, 1);
    return time;
}

// Reads { time, position = ... } at the top of the stack. `number`: its place in the list; 0: it
// comes from `add`.
static scene_explosion read_one(lua_State *L, int number, double time, uint32_t seed) {
    int table = lua_gettop(L);
    const char *name = name_of(L, number);
    float place[3] = {0, 0, 0};
    if (!value_is_plain_table(L, table))
        vm_error(L, "%s is %s; a table is accepted, as in { 0.5, position = {0, 0, 1} }", name,
                 object_kind(L, table));
    value_check_row(L, table, name, script_object_find(who));
    value_get_vector(L, table, name, "position", place);
    scene_explosion one = {
        .time = first_number(L, table, name, time),
        .place = {place[0], place[1], place[2]},
        .size = (float)value_get_number(L, table, name, "size", 1),
        .life = (float)value_get_number(L, table, name, "life", 1),
        .seed = value_get_count(L, table, name, "seed", seed),
    };
    if (!scene_explosion_check(&one)) vm_error(L, "%s: %s", name, err_get());
    lua_settop(L, table);
    return one;
}

// ---- the list ---------------------------------------------------------------------------------

static int l_explosions(lua_State *L) {
    script_require_loading(L, who);
    if (lua_gettop(L) != 1 || !value_is_plain_table(L, 1) || value_has_names(L, 1))
        vm_error(L, "explosions takes a list, as in explosions { {0.5, position = {0, 0, 1}} }");
    lua_Unsigned count = lua_rawlen(L, 1);
    if (count > SCENE_EXPLOSIONS_MAX)
        vm_error(L, "explosions: %d of them; at most %d are accepted", (int)count,
                 SCENE_EXPLOSIONS_MAX);
    vm_charge_memory(L, sizeof(scene_explosions));
    scene_explosions *list = arena_alloc(script_memory(L), sizeof *list);
    for (int i = 1; i <= (int)count; i++) {
        lua_rawgeti(L, 1, i);
        scene_explosion one = read_one(L, i, 0, scene_explosions_seed(list));
        scene_explosions_add(list, &one);
        lua_pop(L, 1);
    }
    list->fixed = list->count;
    script *s = script_of(L);
    list->next = s->explosions;
    s->explosions = list;
    effect_add_systems(s->effect); // so that it is told when time goes back
    explosions_object *object = object_new(L, who, sizeof *object);
    object->list = list;
    return 1;
}

// list:add { position = {0, 0, 1}, size = 2 }: adds an explosion now, or at a later time.
static int l_add(lua_State *L) {
    scene_explosions *list = self(L, "add");
    if (script_of(L)->loading)
        vm_error(L, "explosions:add: adds one while the effect runs; those that are known before "
                    "stand in the list itself");
    if (lua_gettop(L) != 2) vm_error(L, "explosions:add takes a table, as in { size = 2 }");
    field_context context = script_context(L);
    scene_explosion one = read_one(L, 0, context.time, scene_explosions_seed(list));
    if (!scene_explosions_add(list, &one))
        vm_error(L, "explosions:add: the list is full: it began with %d", SCENE_EXPLOSIONS_MAX);
    return 0;
}

static void push_one(lua_State *L, const scene_explosion *one) {
    const float place[3] = {one->place.x, one->place.y, one->place.z};
    float chance[4];
    scene_explosion_chance(one, chance);
    lua_createtable(L, 0, 7);
    value_put_numbers(L, "position", place, 3);
    value_put_numbers(L, "shift", chance, 3);
    value_put_number(L, "random", (double)chance[3]);
    value_put_number(L, "time", one->time);
    value_put_number(L, "size", (double)one->size);
    value_put_number(L, "life", (double)one->life);
    value_put_number(L, "seed", one->seed);
}

// list:get(2): returns the second of the list, or nil.
static int l_get(lua_State *L) {
    const scene_explosions *list = self(L, "get");
    lua_Integer i = luaL_checkinteger(L, 2);
    if (i < 1 || i > (lua_Integer)list->count) return 0;
    push_one(L, &list->all[i - 1]);
    return 1;
}

// list:latest(t, 2): of those that have begun by then, returns the second youngest, or nil.
static int l_latest(lua_State *L) {
    const scene_explosions *list = self(L, "latest");
    double time = luaL_checknumber(L, 2);
    lua_Integer which = luaL_optinteger(L, 3, 1);
    const scene_explosion *alive[64];
    if (which < 1 || which > (lua_Integer)COUNT_OF(alive))
        vm_error(L, "explosions:latest: number %d; accepted: 1 to %d", (int)which,
                 (int)COUNT_OF(alive));
    vm_charge(L, list->count);
    size_t count = scene_explosions_alive(list, time, INFINITY, alive, (size_t)which);
    if (count < (size_t)which) return 0;
    push_one(L, alive[which - 1]);
    return 1;
}

static int l_count(lua_State *L) {
    lua_pushinteger(L, (lua_Integer)self(L, "#")->count);
    return 1;
}

static int l_index(lua_State *L) {
    static const luaL_Reg methods[] = {
        {"add", l_add}, {"get", l_get}, {"latest", l_latest}, {NULL, NULL}};
    return object_method(L, who, methods);
}

void explosions_reset(script *s) {
    for (scene_explosions *list = s->explosions; list; list = list->next)
        scene_explosions_reset(list);
}

// ---- shell ------------------------------------------------------------------------------------

static int l_shell(lua_State *L) {
    script_require_loading(L, "shell");
    if (lua_gettop(L) != 1 || !value_is_plain_table(L, 1))
        vm_error(L, "shell takes named values, as in shell { radius = 2, color = {4, 2, 1} }");
    const explosions_object *at = NULL;
    if (value_get(L, 1, "at") != LUA_TNIL && !(at = object_test(L, -1, who)))
        vm_error(L, "shell: 'at' takes explosions { }; got %s", object_kind(L, -1));
    lua_pop(L, 1);
    pass *p = pass_make(L, "shell", "shell", 1, script_object_find("shell")->keys);
    if (at) pass_shell_open(p, at->list);
    script_made(L, pass_declare(p));
    pass_push(L, p);
    return 1;
}

void l_shell_open(lua_State *L) {
    static const luaL_Reg meta[] = {{"__index", l_index}, {"__len", l_count}, {NULL, NULL}};
    object_type(L, who, meta);
    lua_register(L, who, l_explosions);
    lua_register(L, "shell", l_shell);
}
