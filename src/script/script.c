// Loading an effect file, and calling back into it frame by frame.
#include "script/script.h"
#include "base/file.h"
#include "base/memory.h"
#include "script/binding.h"
#include <math.h>
#include <stdio.h>

enum {
    MEMORY_LIMIT = 256 << 20,
    LOAD_LIMIT = 200000000,
    FRAME_LIMIT = 20000000,
};

script *script_of(lua_State *L) {
    return vm_user(L);
}

arena *script_memory(lua_State *L) {
    return effect_memory(script_of(L)->effect);
}

void script_note_place(lua_State *L, const void *made, const char *call) {
    int line;
    const char *file = vm_caller_file(L, &line);
    if (file) effect_note_place(script_of(L)->effect, made, file, line, call);
}

void script_require_loading(lua_State *L, const char *what) {
    if (!script_of(L)->loading)
        vm_error(L,
                 "%s: can be made only while the file loads; functions of time compute with "
                 "numbers, and p:get() gives a parameter's",
                 what);
}

void script_raise(lua_State *L) {
    vm_error(L, "%s", err_get());
}

void script_make(lua_State *L, const char *who) {
    script *s = script_of(L);
    if (s->making) s->unsound = s->making; // an error came before it was made
    s->making = who;
}

void script_made(lua_State *L, bool done) {
    if (!done) script_raise(L);
    script_of(L)->making = NULL;
}

// ---- time -------------------------------------------------------------------------------------

static void script_renew(void *user) {
    script *s = user;
    s->frame = (time_limit){.what = "frame",
                            .limit = effect_get_facts(s->effect)->seconds / TIME_LIMIT_FRAMES};
}

static bool script_enter(script *s, int args, int results) {
    time_limit *before = time_limit_enter(&s->frame);
    bool done = vm_call(s->vm, args, results, s->limits.frame);
    time_limit_leave(before);
    return done;
}

bool script_protect(script *s, lua_CFunction run, void *argument) {
    time_limit *before = time_limit_enter(&s->frame);
    bool done = vm_protect(s->vm, run, argument, s->limits.frame);
    time_limit_leave(before);
    return done;
}

// ---- calls from the effect --------------------------------------------------------------------

static bool read_result(lua_State *L, double time, float out[4]) {
    int count = value_numbers(L, -1, out);
    const char *type = luaL_typename(L, -1);
    lua_pop(L, 1);
    if (count == 0)
        return err_set("a function of time returned a %s at %g s; a number, {x, y, z} or a colour "
                       "is accepted",
                       type, time);
    for (int i = 0; i < count; i++)
        if (!isfinite(out[i]))
            return err_set("a function of time returned %g at %g s", (double)out[i], time);
    if (count == 1) out[1] = out[2] = out[3] = out[0];
    return true;
}

static bool script_call(void *user, int function, double time, float out[4]) {
    script *s = user;
    lua_State *L = vm_lua(s->vm);
    if (!lua_checkstack(L, 8)) return err_set("the script's stack is full");
    lua_rawgeti(L, LUA_REGISTRYINDEX, function);
    lua_pushnumber(L, time);
    bool loading = s->loading, acting = s->acting;
    s->loading = s->acting = false;
    bool done = script_enter(s, 1, 1);
    s->loading = loading;
    s->acting = acting;
    return done && read_result(L, time, out);
}

static bool script_update(void *user, double time, double dt) {
    script *s = user;
    lua_State *L = vm_lua(s->vm);
    lua_rawgeti(L, LUA_REGISTRYINDEX, s->update);
    lua_pushnumber(L, time);
    lua_pushnumber(L, dt);
    s->acting = true;
    bool done = script_enter(s, 2, 0);
    s->acting = false;
    return done;
}

static void script_destroy(void *user) {
    script *s = user;
    vm_destroy(s->vm);
    mem_free(s);
}

static void script_locate(void *user, char *out, size_t size) {
    const script *s = user;
    vm_locate(vm_lua(s->vm), out, size);
}

static void set_hooks(script *s) {
    effect_set_hooks(s->effect, &(effect_hooks){
                                    .call = script_call,
                                    .update = s->update == LUA_NOREF ? NULL : script_update,
                                    .start = script_start,
                                    .locate = script_locate,
                                    .renew = script_renew,
                                    .frame = script_frame,
                                    .event = script_event,
                                    .destroy = script_destroy,
                                    .user = s,
                                });
}

field_context script_context(lua_State *L) {
    script *s = script_of(L);
    return *effect_pass_host(s->effect)->context;
}

// ---- loading ----------------------------------------------------------------------------------

static void add_file(void *user, const char *path) {
    script *s = user;
    effect_add_file(s->effect, path);
}

static int open_bindings(lua_State *L) {
    static script_opener *const openers[] = {
        l_field_open, l_effect_open, l_palette_open, l_grid_open,   l_instances_open, l_pass_open,
        l_air_open,   l_slices_open, l_shell_open,   l_voxels_open, l_deposit_open};
    static const char *const types[] = {"camera", "sun",      "sky",    "mesh", "node",
                                        "light",  "material", "picture"}; // without methods
    static const luaL_Reg words[] = {{"curve", l_curve},
                                     {"pick", l_pick},
                                     {"layers", l_layers},
                                     {"param", l_param},
                                     {"particles", l_particles},
                                     {"point_lights", l_point_lights},
                                     {"scatter", l_scatter},
                                     {"image", l_image},
                                     {"material", l_material},
                                     {"point_light", l_point_light},
                                     {"spot_light", l_spot_light},
                                     {"sphere_light", l_sphere_light},
                                     {"orbit", l_orbit},
                                     {"camera", l_camera},
                                     {"sun", l_sun},
                                     {"sky", l_sky},
                                     {"mesh", l_mesh},
                                     {"node", l_node}};
    for (size_t i = 0; i < COUNT_OF(openers); i++) openers[i](L);
    for (size_t i = 0; i < COUNT_OF(types); i++) object_type(L, types[i], NULL);
    for (size_t i = 0; i < COUNT_OF(words); i++) lua_register(L, words[i].name, words[i].func);
    return 0;
}

// Folder of the effect as its user wrote it, with a '/' at the end; "" for the current one. Of a
// bundle its name.
static void shown_folder(const effect *e, char out[PATH_CAP]) {
    const char *file = effect_get_facts(e)->file, *bundle = effect_get_facts(e)->bundle;
    size_t length = (size_t)(path_name(file) - file);
    if (bundle)
        snprintf(out, PATH_CAP, "%s/", bundle);
    else
        snprintf(out, PATH_CAP, "%.*s", (int)length, file);
}

static bool script_run_file(script *s, const char *prelude_folder) {
    char prelude[PATH_CAP], name[PATH_CAP];
    const char *file = effect_get_facts(s->effect)->file,
               *bundle = effect_get_facts(s->effect)->bundle, *shown = file;
    if (bundle) shown = path_join(name, bundle, path_name(file)) ? name : bundle;
    return vm_protect(s->vm, open_bindings, NULL, s->limits.load) &&
           path_join(prelude, prelude_folder, "prelude.lua") &&
           vm_run_file(s->vm, prelude, "prelude.lua", s->limits.load, true) &&
           vm_run_file_inside(s->vm, effect_get_facts(s->effect)->inside, file, shown,
                              s->limits.load);
}

static bool is_complete(script *s) {
    const char *file = effect_get_facts(s->effect)->file;
    if (!s->declared)
        return err_set("%s: no effect is declared; begin with local fx = effect { name = ... }",
                       file);
    if (s->making) s->unsound = s->making;
    if (s->unsound)
        return err_set("%s: %s failed, and the file went on; an effect needs all its passes", file,
                       s->unsound);
    if (!effect_get_picture(s->effect, EFFECT_OUTPUT).id)
        return err_set("%s: the effect has no picture; assign an image to its field 'output'",
                       file);
    return true;
}

bool script_load_limited(effect *e, const char *prelude_folder, const script_limits *limits) {
    char shown[PATH_CAP], library[PATH_CAP];
    shown_folder(e, shown);
    if (!path_join(library, prelude_folder, "lib")) return false;
    script *s = mem_alloc(sizeof *s);
    *s = (script){.effect = e, .loading = true, .update = LUA_NOREF, .handlers = LUA_NOREF};
    if (limits) s->limits = *limits;
    if (!s->limits.memory) s->limits.memory = MEMORY_LIMIT;
    if (!s->limits.load) s->limits.load = LOAD_LIMIT;
    if (!s->limits.frame) s->limits.frame = FRAME_LIMIT;
    const char *const *roots;
    size_t root_count = effect_roots(e, &roots);
    s->vm = vm_create(&(vm_desc){
        .root = roots[0],
        .assets = roots + 1,
        .asset_count = root_count - 1,
        .library = library,
        .shown = shown,
        .memory = s->limits.memory,
        .objects = effect_memory(s->effect),
        .on_file = add_file,
        .user = s,
    });
    if (!s->vm) {
        script_destroy(s);
        return false;
    }
    script_renew(s);
    set_hooks(s); // before the file runs: declaring a pass may ask for values
    bool done = script_run_file(s, prelude_folder) && is_complete(s);
    s->loading = false;
    if (done) set_hooks(s);
    return done;
}

bool script_load(effect *e, const char *prelude_folder) {
    return script_load_limited(e, prelude_folder, NULL);
}
