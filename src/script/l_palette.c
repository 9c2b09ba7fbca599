// palette { {0, "#000000"}, {0.5, {1, 0.4, 0}}, {1, "#fff3b0", 0.5}, space = "oklab" }
// palette { blackbody = {500, 3000}, physical = true }
// palette { keys = { {0, { {0, "#000"}, {1, "#fff"} }}, {2, { ... }} } }
// over_age { {0, 0.01}, {1, 0.1} } is one over particle_age (prelude.lua); a number of it is edited
// as a curve. A palette is called with a field, and gives a field of four components.
#include "script/binding.h"
#include <math.h>
#include <string.h>

enum { TEXT_COST = 64 }; // bytes of a stop that is told as text

static const char who[] = "palette";

typedef struct palette_object {
    const palette *palette;
} palette_object;

// Reads {position, colour [, alpha]} at the top of the stack.
static palette_stop read_stop(lua_State *L, int i) {
    palette_stop stop = {.color = {0, 0, 0, 1}};
    lua_Unsigned length = lua_type(L, -1) == LUA_TTABLE ? lua_rawlen(L, -1) : 0;
    if (length < 2 || length > 3)
        vm_error(L, "palette: stop %d must be {position, colour} or {position, colour, alpha}", i);
    if (lua_rawgeti(L, -1, 1) != LUA_TNUMBER)
        vm_error(L, "palette: the position of stop %d must be a number", i);
    stop.at = (float)lua_tonumber(L, -1);
    lua_pop(L, 1);
    lua_rawgeti(L, -1, 2);
    float color[4];
    int count = value_numbers(L, -1, color);
    if (count < 3)
        vm_error(L,
                 "palette: the colour of stop %d must be \"#rrggbb\" (sRGB) or {r, g, b} (linear)",
                 i);
    memcpy(stop.color, color, (size_t)count * sizeof *color);
    lua_pop(L, 1);
    if (length == 3) {
        if (lua_rawgeti(L, -1, 3) != LUA_TNUMBER)
            vm_error(L, "palette: the alpha of stop %d must be a number", i);
        stop.color[3] = (float)lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
    return stop;
}

// Reads the list of stops at `index`.
static void read_stops(lua_State *L, int index, palette_key *key) {
    index = lua_absindex(L, index);
    lua_Unsigned count = lua_rawlen(L, index);
    if (count > PALETTE_MAX_STOPS)
        vm_error(L, "palette: at most %d stops are accepted", PALETTE_MAX_STOPS);
    palette_stop *stops = lua_newuserdatauv(L, (size_t)(count + 1) * sizeof *stops, 0);
    for (int i = 1; i <= (int)count; i++) {
        lua_rawgeti(L, index, i);
        stops[i - 1] = read_stop(L, i);
        lua_pop(L, 1);
    }
    vm_charge_memory(L, (size_t)count * (sizeof *stops + TEXT_COST));
    key->stops = arena_copy(script_memory(L), stops, (size_t)count * sizeof *stops);
    key->count = (size_t)count;
    lua_pop(L, 1);
}

// Reads `keys = { {time, {stops}}, ... }` at the top of the stack.
static void read_keys(lua_State *L, palette_key keys[PALETTE_MAX_KEYS], size_t *key_count) {
    lua_Unsigned count = lua_type(L, -1) == LUA_TTABLE ? lua_rawlen(L, -1) : 0;
    if (count < 1 || count > PALETTE_MAX_KEYS)
        vm_error(L, "palette: 'keys' must be a list of 1 to %d {time, {stops}}", PALETTE_MAX_KEYS);
    for (int i = 1; i <= (int)count; i++) {
        if (lua_rawgeti(L, -1, i) != LUA_TTABLE || lua_rawgeti(L, -1, 1) != LUA_TNUMBER ||
            lua_rawgeti(L, -2, 2) != LUA_TTABLE)
            vm_error(L, "palette: key %d must be {time, {stops}}", i);
        keys[i - 1].time = (float)lua_tonumber(L, -2);
        read_stops(L, -1, &keys[i - 1]);
        lua_pop(L, 3);
    }
    *key_count = (size_t)count;
}

static bool read_blackbody(lua_State *L, palette_desc *desc) {
    if (value_get(L, 1, "blackbody") == LUA_TNIL) {
        lua_pop(L, 1);
        return false;
    }
    float range[4];
    if (value_numbers(L, -1, range) != 2)
        vm_error(L, "palette: 'blackbody' must be a range in kelvin, as in {500, 3000}");
    desc->blackbody = true;
    desc->min = range[0];
    desc->max = range[1];
    lua_pop(L, 1);
    return true;
}

static void push_palette(lua_State *L, palette *p) {
    palette_object *object = object_new(L, who, sizeof *object);
    object->palette = p;
}

static int l_palette(lua_State *L) {
    script_require_loading(L, who);
    const script_object *row = value_check_object(L, 1, who);
    palette_key keys[PALETTE_MAX_KEYS] = {0};
    palette_desc desc = {
        .space = (palette_space)value_get_choice(L, 1, row, "space"),
        .min = (float)value_get_number(L, 1, who, "min", 0),
        .max = (float)value_get_number(L, 1, who, "max", 0),
        .keys = keys,
        .physical = value_get_bool(L, 1, who, "physical", false),
        .reference = (float)value_get_number(L, 1, who, "reference", 0),
    };
    bool blackbody = read_blackbody(L, &desc);
    bool keyed = value_get(L, 1, "keys") != LUA_TNIL;
    if (keyed) read_keys(L, keys, &desc.key_count);
    lua_pop(L, 1);
    if ((blackbody || keyed) && (lua_rawlen(L, 1) > 0 || (blackbody && keyed)))
        vm_error(L, "palette: stops, 'keys' and 'blackbody' exclude each other");
    if (!blackbody && !keyed) {
        read_stops(L, 1, &keys[0]);
        desc.key_count = 1;
    }
    vm_charge_memory(L, EFFECT_CONTROL_COST + sizeof desc + sizeof keys);
    palette *p = palette_create(script_memory(L), &desc);
    const char *name = p ? value_name_or_purpose(L, 1, who) : NULL;
    if (!name || !effect_add_palette(script_of(L)->effect, p, name)) script_raise(L);
    script_note_place(L, p, who);
    push_palette(L, p);
    return 1;
}

static int l_apply(lua_State *L) {
    const palette_object *object = luaL_checkudata(L, 1, who);
    const field *at = value_field(L, 2, who, "position", 1);
    if (at->components != 1)
        vm_error(L, "palette: it maps one number; this has %d components", at->components);
    script_require_loading(L, who);
    field_push(L, field_palette(script_memory(L), object->palette, at));
    return 1;
}

// Converts stops to a curve. Two stops at one age become two keys, the second a little later.
static curve *curve_of(lua_State *L, const palette_key *stops) {
    curve_key keys[PALETTE_MAX_STOPS];
    for (size_t i = 0; i < stops->count; i++) {
        keys[i] = (curve_key){stops->stops[i].at, {stops->stops[i].color[0]}};
        if (i > 0 && keys[i].time <= keys[i - 1].time)
            keys[i].time = nextafterf(keys[i - 1].time, INFINITY);
    }
    return curve_create(
        script_memory(L),
        &(curve){.shape = CURVE_LINEAR, .components = 1, .keys = keys, .count = stops->count});
}

// The prelude's over_age calls it with stops, and whether they are numbers.
static int l_over_age(lua_State *L) {
    static const char name_of[] = "over_age";
    script_require_loading(L, name_of);
    palette_key key = {0};
    read_stops(L, 1, &key);
    vm_charge_memory(L, EFFECT_CONTROL_COST + sizeof(palette_desc) + sizeof key +
                            key.count * sizeof(curve_key));
    palette *p = palette_create(script_memory(L), &(palette_desc){.keys = &key, .key_count = 1});
    if (!p) script_raise(L);
    effect *e = script_of(L)->effect;
    const char *name = value_name_or_purpose(L, 1, name_of);
    if (lua_toboolean(L, 2)) {
        curve *c = curve_of(L, &key);
        name = c ? effect_add_age_curve(e, c, p, name) : NULL;
    } else {
        name = effect_add_palette(e, p, name);
    }
    if (!name) script_raise(L);
    script_note_place(L, p, name_of);
    push_palette(L, p);
    return 1;
}

void l_palette_open(lua_State *L) {
    static const luaL_Reg methods[] = {{"__call", l_apply}, {NULL, NULL}};
    object_type(L, who, methods);
    lua_register(L, who, l_palette);
    lua_register(L, "over_age", l_over_age);
}
