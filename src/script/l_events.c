// Functions that a script runs from frame to frame: fx:on_start, fx:on_frame, fx:on_key,
// fx:on_click; and fx.events, the list of its events. effect/events.h says when they run.
#include "base/memory.h"
#include "effect/events.h"
#include "script/instances.h"
#include <math.h>
#include <string.h>

enum { MOST_FUNCTIONS = 64, STATUS_LENGTH = 48 };
enum { FUNCTION_COST = 256, PICK_COST = 2000 }; // bytes; instructions
static const char key_list[] = "key ";          // and its name

// ---- declaring --------------------------------------------------------------------------------

// Pushes the list of functions of a kind, which is created if there is none.
static void push_list(lua_State *L, const char *kind) {
    script *s = script_of(L);
    if (s->handlers == LUA_NOREF) {
        lua_newtable(L);
        s->handlers = luaL_ref(L, LUA_REGISTRYINDEX);
    }
    lua_rawgeti(L, LUA_REGISTRYINDEX, s->handlers);
    if (lua_getfield(L, -1, kind) == LUA_TNIL) {
        lua_pop(L, 1);
        lua_newtable(L);
        lua_pushvalue(L, -1);
        lua_setfield(L, -3, kind);
    }
    lua_remove(L, -2);
}

static void add_function(lua_State *L, int index, const char *method, const char *kind) {
    script_require_loading(L, method);
    if (lua_type(L, index) != LUA_TFUNCTION)
        vm_error(L, "%s takes a function%s; got %s", method,
                 index == 3 ? " after the key, as fx:on_key(\"f\", function(event) end)" : "",
                 object_kind(L, index));
    push_list(L, kind);
    lua_Integer count = (lua_Integer)lua_rawlen(L, -1);
    if (count == MOST_FUNCTIONS) vm_error(L, "%s: more than %d functions", method, MOST_FUNCTIONS);
    vm_charge_memory(L, FUNCTION_COST);
    lua_pushvalue(L, index);
    lua_rawseti(L, -2, count + 1);
    lua_pop(L, 1);
    effect_add_systems(script_of(L)->effect);
}

static int l_on_start(lua_State *L) {
    luaL_checkudata(L, 1, "effect");
    add_function(L, 2, "fx:on_start", "start");
    return 0;
}

static int l_on_frame(lua_State *L) {
    luaL_checkudata(L, 1, "effect");
    add_function(L, 2, "fx:on_frame", "frame");
    return 0;
}

// Reads the help: a text after the function.
static const char *read_help(lua_State *L, int index, const char *method) {
    if (lua_isnoneornil(L, index)) return "";
    if (lua_type(L, index) != LUA_TSTRING)
        vm_error(L, "%s: what comes after the function says in a text what it does; got %s", method,
                 object_kind(L, index));
    vm_charge_memory(L, lua_rawlen(L, index) + FUNCTION_COST);
    return lua_tostring(L, index);
}

static int l_on_click(lua_State *L) {
    luaL_checkudata(L, 1, "effect");
    const char *help = read_help(L, 3, "fx:on_click");
    add_function(L, 2, "fx:on_click", "click");
    if (!effect_add_hearing(script_of(L)->effect, "", help)) script_raise(L);
    return 0;
}

static int l_on_key(lua_State *L) {
    luaL_checkudata(L, 1, "effect");
    if (lua_type(L, 2) != LUA_TSTRING)
        vm_error(L,
                 "fx:on_key takes the name of a key first, as fx:on_key(\"f\", function(event) "
                 "end); got %s",
                 object_kind(L, 2));
    const char *help = read_help(L, 4, "fx:on_key");
    add_function(L, 3, "fx:on_key", lua_pushfstring(L, "%s%s", key_list, lua_tostring(L, 2)));
    if (!lua_tostring(L, 2)[0]) vm_error(L, "fx:on_key: the key has no name");
    if (!effect_add_hearing(script_of(L)->effect, lua_tostring(L, 2), help)) script_raise(L);
    return 0;
}

// fx:status("burning", n, "trees"): shows a number, or true or false, to users while the effect
// runs.
static int l_status(lua_State *L) {
    luaL_checkudata(L, 1, "effect");
    size_t length;
    const char *name = luaL_checklstring(L, 2, &length);
    if (length < 1 || length > STATUS_LENGTH)
        vm_error(L, "fx:status: the name has %d letters; accepted: 1 to %d", (int)length,
                 STATUS_LENGTH);
    double value = lua_toboolean(L, 3);
    const char *unit = lua_type(L, 3) == LUA_TBOOLEAN ? "bool" : luaL_optstring(L, 4, "");
    if (lua_type(L, 3) != LUA_TBOOLEAN) value = luaL_checknumber(L, 3);
    if (strlen(unit) > STATUS_LENGTH) vm_error(L, "fx:status: the unit is too long");
    if (!effect_set_status(script_of(L)->effect, name, value, unit)) script_raise(L);
    return 0;
}

bool events_push_method(lua_State *L, const char *name) {
    static const luaL_Reg methods[] = {{"on_start", l_on_start}, {"on_frame", l_on_frame},
                                       {"on_key", l_on_key},     {"on_click", l_on_click},
                                       {"status", l_status},     {NULL, NULL}};
    for (const luaL_Reg *m = methods; m->name; m++) {
        if (strcmp(m->name, name) != 0) continue;
        lua_pushcfunction(L, m->func);
        return true;
    }
    return false;
}

// ---- fx.events ----------------------------------------------------------------------------------

_Noreturn static void refuse_event(lua_State *L, int number, const char *why) {
    vm_error(L,
             "effect: events[%d] %s; accepted are { 2.5, click = {0.4, 0.6} } and { 2.5, key = "
             "\"f\" }, with at = {x, y} where it has a place",
             number, why);
}

// Reads a place: {x, y} in the picture, {x, y, z} in the world, six numbers of a ray.
static void read_place(lua_State *L, int number, int index, effect_event *out) {
    size_t count = value_is_plain_table(L, index) ? (size_t)lua_rawlen(L, index) : 0;
    if (count != 2 && count != 3 && count != 6) refuse_event(L, number, "is at no place");
    out->numbers = (int)count;
    for (size_t i = 0; i < count; i++) {
        if (lua_rawgeti(L, index, (lua_Integer)i + 1) != LUA_TNUMBER)
            refuse_event(L, number, "is at what is no number");
        out->at[i] = (float)lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
}

static void read_event(lua_State *L, int number, effect_event *out) {
    int table = lua_gettop(L);
    static const char *const keys[] = {"click", "key", "at"};
    if (!value_is_plain_table(L, table)) refuse_event(L, number, "is no table");
    value_check_keys(L, table, "effect: an event", keys, COUNT_OF(keys));
    *out = (effect_event){0};
    lua_rawgeti(L, table, 1);
    if (lua_type(L, -1) != LUA_TNUMBER) refuse_event(L, number, "has no time");
    out->time = lua_tonumber(L, -1);
    int click = value_get(L, table, "click"), key = value_get(L, table, "key"); // +2, +3
    if ((click == LUA_TNIL) == (key == LUA_TNIL))
        refuse_event(L, number, "is not one of click and key");
    if (key == LUA_TSTRING && lua_rawlen(L, -1) < sizeof out->key)
        memcpy(out->key, lua_tostring(L, -1), lua_rawlen(L, -1));
    else if (key != LUA_TNIL)
        refuse_event(L, number, "has a key without a name");
    if (click != LUA_TNIL) read_place(L, number, table + 2, out);
    if (key != LUA_TNIL && value_get(L, table, "at") != LUA_TNIL)
        read_place(L, number, table + 4, out);
    if (!events_check(out)) vm_error(L, "effect: events[%d]: %s", number, err_get());
    lua_settop(L, table);
}

void events_assign(lua_State *L) {
    size_t count = value_is_plain_table(L, 3) ? (size_t)lua_rawlen(L, 3) : 0;
    if (!value_is_plain_table(L, 3) || count > EFFECT_MOST_EVENTS)
        vm_error(L, "effect: 'events' takes a list of at most %d, as { { 2.5, key = \"f\" } }",
                 EFFECT_MOST_EVENTS);
    vm_charge_memory(L, 2 * count * sizeof(effect_event));
    effect_event *list = lua_newuserdatauv(L, count * sizeof *list + 1, 0);
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, 3, (lua_Integer)i + 1);
        read_event(L, (int)i + 1, &list[i]);
        lua_pop(L, 1);
    }
    if (!effect_set_events(script_of(L)->effect, list, count)) script_raise(L);
    lua_pop(L, 1);
}

// ---- what a ray meets ---------------------------------------------------------------------------

static void push_hit(lua_State *L, const scene_hit *hit) {
    lua_createtable(L, 0, 6);
    value_put_numbers(L, "position", hit->position, 3);
    value_put_numbers(L, "normal", hit->normal, 3);
    value_put_number(L, "distance", (double)hit->distance);
    if (hit->mesh) {
        lua_pushstring(L, hit->mesh->name);
        lua_setfield(L, -2, "mesh");
    }
    if (hit->instances) {
        instances_push(L, hit->instances);
        lua_setfield(L, -2, "instances");
        lua_pushinteger(L, (lua_Integer)hit->index + 1);
        lua_setfield(L, -2, "index");
    }
}

static void read_vector(lua_State *L, int table, int number, const char *name, float out[3]) {
    float value[4];
    if (value_get(L, table, name) == LUA_TNIL) lua_rawgeti(L, table, number);
    int count = value_numbers(L, -1, value);
    if (count != 3 || !isfinite(value[0] + value[1] + value[2]))
        vm_error(L, "pick: takes a place in the picture, pick(0.5, 0.5), or a ray, pick { {x, y, "
                    "z}, {dx, dy, dz} }");
    memcpy(out, value, 3 * sizeof *out);
}

// pick(x, y), pick { origin, direction }, pick(event.ray): returns what the ray hits, or nil.
int l_pick(lua_State *L) {
    effect *e = script_of(L)->effect;
    float origin[3], direction[3];
    scene_hit hit;
    if (script_of(L)->loading)
        vm_error(L, "pick: nothing stands anywhere while the file loads; on_frame, on_key and "
                    "on_click can pick");
    if (!script_of(L)->acting) // it may be what says where something stands
        vm_error(L, "pick: a function of time cannot pick; on_frame, on_key and on_click can");
    if (lua_type(L, 1) == LUA_TTABLE) {
        read_vector(L, 1, 1, "origin", origin);
        read_vector(L, 1, 2, "direction", direction);
        if (direction[0] == 0 && direction[1] == 0 && direction[2] == 0)
            vm_error(L, "pick: the ray has no direction");
    } else {
        float x = (float)luaL_checknumber(L, 1), y = (float)luaL_checknumber(L, 2);
        if (!isfinite(x + y)) vm_error(L, "pick: the place is no number");
        if (!effect_camera_ray(e, x, y, origin, direction)) script_raise(L);
    }
    vm_charge(L, PICK_COST);
    if (effect_pick(e, origin, direction, &hit))
        push_hit(L, &hit);
    else
        lua_pushnil(L);
    return 1;
}

// ---- running ------------------------------------------------------------------------------------

typedef struct frame_call {
    const script *script;
    double time, dt;
} frame_call;

typedef struct event_call {
    const script *script;
    const effect_happening *what;
} event_call;

// Calls all functions of a kind, in order of declaration, with the `args` values at the top of the
// stack, and pops these.
static void call_all(lua_State *L, const script *s, const char *kind, int args) {
    int first = lua_gettop(L) - args + 1;
    if (s->handlers == LUA_NOREF) return;
    lua_rawgeti(L, LUA_REGISTRYINDEX, s->handlers);
    if (lua_getfield(L, -1, kind) != LUA_TTABLE) return;
    int list = lua_gettop(L);
    for (lua_Integer i = 1; lua_rawgeti(L, list, i) == LUA_TFUNCTION; i++) {
        for (int k = 0; k < args; k++) lua_pushvalue(L, first + k);
        lua_call(L, args, 0);
    }
}

static int run_start(lua_State *L) {
    call_all(L, lua_touserdata(L, 1), "start", 0);
    return 0;
}

static int run_frame(lua_State *L) {
    const frame_call *call = lua_touserdata(L, 1);
    lua_pushnumber(L, call->time);
    lua_pushnumber(L, call->dt);
    call_all(L, call->script, "frame", 2);
    return 0;
}

static void push_event(lua_State *L, const effect_happening *what) {
    lua_createtable(L, 0, 6);
    value_put_number(L, "time", what->event->time);
    if (what->event->key[0]) {
        lua_pushstring(L, what->event->key);
        lua_setfield(L, -2, "key");
    }
    if (!what->placed) return;
    value_put_number(L, "x", (double)what->x);
    value_put_number(L, "y", (double)what->y);
    lua_createtable(L, 0, 2);
    value_put_numbers(L, "origin", what->origin, 3);
    value_put_numbers(L, "direction", what->direction, 3);
    lua_setfield(L, -2, "ray");
    if (!what->met) return;
    push_hit(L, &what->hit);
    lua_setfield(L, -2, "hit");
}

static int run_event(lua_State *L) {
    const event_call *call = lua_touserdata(L, 1);
    const char *key = call->what->event->key;
    const char *kind = key[0] ? lua_pushfstring(L, "%s%s", key_list, key) : "click";
    push_event(L, call->what);
    call_all(L, call->script, kind, 1);
    return 0;
}

static bool events_act(script *s, lua_CFunction run, void *call) {
    s->acting = true;
    bool done = script_protect(s, run, call);
    s->acting = false;
    return done;
}

bool script_start(void *user) {
    script *s = user;
    vm_set_seed(vm_lua(s->vm), s->seed);
    explosions_reset(s);
    return events_act(s, run_start, s);
}

bool script_frame(void *user, double time, double dt) {
    script *s = user;
    frame_call call = {s, time, dt};
    return events_act(s, run_frame, &call);
}

bool script_event(void *user, const effect_happening *what) {
    script *s = user;
    event_call call = {s, what};
    return events_act(s, run_event, &call);
}
