// Particles that are born, move and die: particles { count = 4096, rate = 2000, shape = sphere { }
// }. Passes that draw them name the result by `from`.
#include "base/memory.h"
#include "pass/particles/particles.h"
#include "script/binding.h"

enum { BODY_COST = 4 << 10, COUNT = 65536 }; // bytes of host memory charged for a mesh

static void read_desc(lua_State *L, pass_particles_desc *desc) {
    desc->count = value_get_count(L, 1, "particles", "count", COUNT);
    desc->time_step = value_get_number(L, 1, "particles", "time_step", 1.0 / 60);
    desc->warm_up = value_get_number(L, 1, "particles", "warm_up", 0);
    desc->at = NULL;
    desc->share = NULL;
    bool given = value_get(L, 1, "at") != LUA_TNIL;
    if (given && !(desc->at = value_instances(L, -1)))
        vm_error(L, "particles: 'at' takes instances { }; got %s", object_kind(L, -1));
    if (given) vm_charge_memory(L, 2 * sizeof(float) * scene_instances_count(desc->at));
    if (value_get(L, 1, "share") != LUA_TNIL) {
        if (!given) vm_error(L, "particles: 'share' is of instances; 'at' says which");
        desc->share = value_field(L, -1, "particles", "share", 1);
    }
    lua_pop(L, 2);
}

static void set_uniform(lua_State *L, pass *p, int value, const char *key, const char *uniform) {
    const field *node = value_uniform(L, value, "particles", key, 1);
    if (!pass_set_uniform(p, uniform, node)) script_raise(L);
}

static bool is_pair(lua_State *L, int index) {
    return value_is_plain_table(L, index) && lua_rawlen(L, index) == 2;
}

// lifetime = 2, or {0.5, 2}: the shortest and the longest.
static void set_lifetime(lua_State *L, pass *p) {
    int value = lua_gettop(L);
    bool pair = is_pair(L, value);
    if (pair) {
        lua_rawgeti(L, value, 1);
        lua_rawgeti(L, value, 2);
    } else {
        lua_pushvalue(L, value);
        lua_pushvalue(L, value);
    }
    set_uniform(L, p, value + 1, "lifetime", "lifetime_min");
    set_uniform(L, p, value + 2, "lifetime", "lifetime_max");
    lua_pop(L, 2);
}

static void set_field(lua_State *L, pass *p, int value, const char *key) {
    const field *node = value_field(L, value, "particles", key, 1);
    if (!pass_set_field(p, "shape", node)) script_raise(L);
}

// shape = a field, or a mesh.
static void set_shape(lua_State *L, pass *p) {
    int value = lua_gettop(L);
    const mesh_object *mesh = object_test(L, value, "mesh");
    if (!mesh) {
        set_field(L, p, value, "shape");
        return;
    }
    vm_charge_memory(L, BODY_COST);
    if (!pass_add_mesh(p, mesh->mesh)) script_raise(L);
}

// above = {field, threshold}.
static void set_above(lua_State *L, pass *p) {
    int value = lua_gettop(L);
    if (!is_pair(L, value))
        vm_error(L, "particles: 'above' takes a field and a number, as in above = {flow.density, "
                    "0.3}");
    if (value_get(L, 1, "shape") != LUA_TNIL)
        vm_error(L, "particles: 'above' is given beside 'shape'; one of them says where they are "
                    "born");
    lua_rawgeti(L, value, 1);
    set_field(L, p, value + 2, "above");
    lua_rawgeti(L, value, 2);
    set_uniform(L, p, value + 3, "above", "threshold");
    lua_pop(L, 3);
}

static void read_keys(lua_State *L, pass *p) {
    static const struct {
        const char *key;
        void (*set)(lua_State *L, pass *p); // its value is at the top
    } own[] = {{"lifetime", set_lifetime}, {"shape", set_shape}, {"above", set_above}};
    for (size_t i = 0; i < COUNT_OF(own); i++) {
        if (value_get(L, 1, own[i].key) != LUA_TNIL) own[i].set(L, p);
        lua_pop(L, 1);
    }
}

int l_particles(lua_State *L) {
    script_require_loading(L, "particles");
    if (lua_gettop(L) != 1 || !value_is_plain_table(L, 1))
        vm_error(L, "particles takes named values, as in particles { count = 4096, rate = 2000 }");
    pass_particles_desc desc;
    vm_charge_memory(L, lua_rawlen(L, 1) * BODY_COST);
    pass *p = pass_make(L, "particles", "particles", 1, script_object_find("particles")->keys);
    read_desc(L, &desc);
    read_keys(L, p);
    script_made(L, pass_particles_open(p, &desc) && pass_declare(p));
    pass_push(L, p);
    return 1;
}
