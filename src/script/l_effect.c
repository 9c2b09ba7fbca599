// effect { name = "explosion", fps = 24, frames = 100 } gives the effect's object. Assigned to it:
// output, linear, depth (images), antialias, camera, sun, sky, lights, update, a function(t, dt),
// and events.
#include "script/binding.h"
#include <ctype.h>
#include <string.h>

static const char who[] = "effect";

// Takes a line of text, which others print as it is.
static const char *get_line(lua_State *L, const char *key) {
    enum { LINE_MOST = 200 };
    const char *text = value_get_string(L, 1, who, key);
    if (!text) return NULL;
    bool plain = text[0] && strlen(text) <= LINE_MOST;
    for (const char *c = text; *c; c++) plain &= !iscntrl((unsigned char)*c);
    if (!plain)
        vm_error(L, "effect: '%s' takes one line of up to %d bytes, as \"MIT\"", key, LINE_MOST);
    return text;
}

static int l_effect(lua_State *L) {
    script *s = script_of(L);
    script_require_loading(L, who);
    value_check_object(L, 1, who);
    if (s->declared) vm_error(L, "effect { } is called twice; a file holds one effect");
    const char *name = value_get_string(L, 1, who, "name");
    double fps = value_get_number(L, 1, who, "fps", effect_get_facts(s->effect)->fps);
    uint32_t frames = value_get_count(L, 1, who, "frames", effect_get_facts(s->effect)->frames);
    uint32_t first = value_get_count(L, 1, who, "first", effect_get_facts(s->effect)->first);
    uint32_t seed = value_get_count(L, 1, who, "seed", 0);
    if (name) effect_set_name(s->effect, name);
    effect_set_author(s->effect, get_line(L, "author"), get_line(L, "licence"));
    if (!effect_set_timeline(s->effect, fps, frames, first)) script_raise(L);
    effect_set_seed(s->effect, seed);
    vm_set_seed(L, s->seed = seed);
    s->declared = true;
    object_new(L, who, sizeof(char));
    lua_newtable(L); // what can be read: this, and what was assigned
    lua_pushstring(L, effect_get_facts(s->effect)->name);
    lua_setfield(L, -2, "name");
    lua_pushnumber(L, fps);
    lua_setfield(L, -2, "fps");
    lua_pushinteger(L, frames);
    lua_setfield(L, -2, "frames");
    lua_pushinteger(L, first);
    lua_setfield(L, -2, "first");
    lua_pushinteger(L, seed);
    lua_setfield(L, -2, "seed");
    lua_setiuservalue(L, -2, 1);
    return 1;
}

// ---- assignments ------------------------------------------------------------------------------

static void set_picture(lua_State *L, const char *key, effect_picture which) {
    graph_image image;
    if (!value_image(L, 3, &image))
        vm_error(L, "effect: '%s' takes an image, such as the result of a pass; got %s", key,
                 object_kind(L, 3));
    if (!effect_set_picture(script_of(L)->effect, which, image)) script_raise(L);
}

// Copies the fields that are set; the others keep their default. Both arrays have `count` pointers.
static void merge_fields(const field **to, const field *const *from, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (from[i]) to[i] = from[i];
}

static void set_scene(lua_State *L, const char *key) {
    scene *s = effect_scene(script_of(L)->effect);
    void *value = object_test(L, 3, key);
    if (!value)
        vm_error(L, "effect: '%s' takes %s; got %s", key,
                 strcmp(key, "camera") == 0 ? "orbit { } or camera { }"
                                            : lua_pushfstring(L, "%s { }", key),
                 object_kind(L, 3));
    if (strcmp(key, "camera") == 0) {
        s->camera.eye = NULL; // an orbit has none
        merge_fields((const field **)&s->camera, (const field *const *)value,
                     sizeof s->camera / sizeof(field *));
    } else if (strcmp(key, "sun") == 0) {
        merge_fields((const field **)&s->sun, (const field *const *)value,
                     sizeof s->sun / sizeof(field *));
    } else {
        merge_fields((const field **)&s->sky, (const field *const *)value,
                     offsetof(scene_sky, image) / sizeof(field *));
        s->sky.image = ((const sky_object *)value)->sky.image;
    }
}

static void set_lights(lua_State *L) {
    scene *s = effect_scene(script_of(L)->effect);
    s->light_count = value_lights(L, 3, who, &s->lights);
}

static void set_antialias(lua_State *L) {
    if (lua_type(L, 3) != LUA_TBOOLEAN)
        vm_error(L, "effect: 'antialias' takes true or false; got %s", object_kind(L, 3));
    if (!effect_set_antialias(script_of(L)->effect, lua_toboolean(L, 3))) script_raise(L);
}

static void set_update(lua_State *L) {
    script *s = script_of(L);
    if (lua_type(L, 3) != LUA_TFUNCTION)
        vm_error(L, "effect: 'update' takes a function(t, dt); got %s", object_kind(L, 3));
    luaL_unref(L, LUA_REGISTRYINDEX, s->update);
    lua_pushvalue(L, 3);
    s->update = luaL_ref(L, LUA_REGISTRYINDEX);
}

// `keys`: the name is a key of the call, which can only be read.
_Noreturn static void refuse_member(lua_State *L, const char *name, bool keys) {
    const script_object *row = script_object_find(who);
    const char *known[32];
    size_t count = 0;
    for (const value_desc *k = row->members; k->name; k++) known[count++] = k->name;
    for (const value_desc *k = row->keys; keys && k->name; k++) known[count++] = k->name;
    value_unknown(L, who, "field", name, known, count);
}

static int l_newindex(lua_State *L) {
    luaL_checkudata(L, 1, who);
    const char *key = luaL_checkstring(L, 2);
    script_require_loading(L, "assigning to the effect");
    if (strcmp(key, "output") == 0)
        set_picture(L, key, EFFECT_OUTPUT);
    else if (strcmp(key, "linear") == 0)
        set_picture(L, key, EFFECT_LINEAR);
    else if (strcmp(key, "depth") == 0)
        set_picture(L, key, EFFECT_DEPTH);
    else if (strcmp(key, "camera") == 0 || strcmp(key, "sun") == 0 || strcmp(key, "sky") == 0)
        set_scene(L, key);
    else if (strcmp(key, "lights") == 0)
        set_lights(L);
    else if (strcmp(key, "antialias") == 0)
        set_antialias(L);
    else if (strcmp(key, "update") == 0)
        set_update(L);
    else if (strcmp(key, "events") == 0)
        events_assign(L);
    else if (events_push_method(L, key))
        vm_error(L, "effect: '%s' is a method, which is called: fx:%s(...)", key, key);
    else
        refuse_member(L, key, false);
    lua_settop(L, 3);
    lua_getiuservalue(L, 1, 1);
    lua_insert(L, 2);
    lua_rawset(L, 2);
    return 0;
}

static int l_index(lua_State *L) {
    luaL_checkudata(L, 1, who);
    const char *key = luaL_checkstring(L, 2);
    if (events_push_method(L, key)) return 1;
    lua_getiuservalue(L, 1, 1);
    if (value_get(L, -1, key) == LUA_TNIL &&
        !script_key_find(script_object_find(who)->members, key))
        refuse_member(L, key, true);
    return 1;
}

void l_effect_open(lua_State *L) {
    static const luaL_Reg methods[] = {
        {"__index", l_index}, {"__newindex", l_newindex}, {NULL, NULL}};
    object_type(L, who, methods);
    lua_register(L, who, l_effect);
}
