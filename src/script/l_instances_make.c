// instances { mesh { ... }, mesh { ... }, at = scatter { ... }, kind = {0.3, 0.7}, scale = {0.5,
// 1.3} }: sets the initial state of instances. A value can be given once for all, as a range for
// random numbers, as a list, or by a function(i, place).
#include "scene/scatter.h"
#include "script/instances.h"
#include <math.h>
#include <string.h>

static const char who[] = "instances";

typedef struct maker {
    lua_State *L;
    struct instance_entry *entries; // on the stack of Lua
    uint32_t count;
    size_t kinds;
    uint32_t seed;
} maker;

enum { CHANCE_RANDOM = 100, CHANCE_LEAN, CHANCE_LEAN_WAY }; // others are by instance_key

static float chance(const maker *m, uint32_t i, uint32_t what) {
    return scatter_chance(m->seed, i, what);
}

// ---- places -----------------------------------------------------------------------------------

static void read_places(maker *m) {
    lua_State *L = m->L;
    if (value_get(L, 1, "at") == LUA_TNIL)
        vm_error(L, "instances: 'at' is missing: where they stand, as in at = scatter { count = "
                    "500, size = {120, 120}, distance = 2 } or at = { {0, 0, 0}, {2, 0, 0} }");
    if (!value_is_plain_table(L, -1) || value_has_names(L, -1))
        vm_error(L, "instances: 'at' takes a list of places {x, y, z}; got %s", object_kind(L, -1));
    lua_Unsigned count = lua_rawlen(L, -1);
    if (count < 1 || count > SCENE_INSTANCES_MAX)
        vm_error(L, "instances: 'at' has %d places; 1 to %d are accepted", (int)count,
                 SCENE_INSTANCES_MAX);
    vm_charge_memory(L, count * SCENE_INSTANCES_COST);
    int list = lua_gettop(L);
    m->count = (uint32_t)count;
    m->entries = lua_newuserdatauv(L, count * sizeof *m->entries, 0);
    for (uint32_t i = 0; i < count; i++) {
        struct instance_entry *e = &m->entries[i];
        float random = chance(m, i, CHANCE_RANDOM);
        *e = (struct instance_entry){.turn = {{0, 0, 0, 1}}, .color = {{1, 1, 1, 1}}};
        memcpy(&e->kind.v[2], &random, sizeof random);
        lua_rawgeti(L, list, (lua_Integer)i + 1);
        instance_read(L, -1, who, INSTANCE_POSITION, m->kinds, e);
        e->place.v[3] = 1;
        lua_pop(L, 1);
    }
    lua_replace(L, list);
}

// ---- by key, whose value is at the top of the stack -------------------------------------------

static void read_by_function(const maker *m, instance_key key) {
    lua_State *L = m->L;
    for (uint32_t i = 0; i < m->count; i++) {
        lua_pushvalue(L, -1);
        lua_pushinteger(L, (lua_Integer)i + 1);
        lua_createtable(L, 3, 0);
        for (int a = 0; a < 3; a++) {
            lua_pushnumber(L, (lua_Number)m->entries[i].place.v[a]);
            lua_rawseti(L, -2, a + 1);
        }
        lua_call(L, 2, 1);
        instance_read(L, -1, who, key, m->kinds, &m->entries[i]);
        lua_pop(L, 1);
    }
}

static void read_list(const maker *m, instance_key key) {
    for (uint32_t i = 0; i < m->count; i++) {
        lua_rawgeti(m->L, -1, (lua_Integer)i + 1);
        instance_read(m->L, -1, who, key, m->kinds, &m->entries[i]);
        lua_pop(m->L, 1);
    }
}

// Chooses values between the two numbers of a list.
static void read_range(const maker *m, instance_key key) {
    lua_State *L = m->L;
    struct instance_entry ends[2] = {{.turn = {{0, 0, 0, 1}}}, {.turn = {{0, 0, 0, 1}}}};
    float angles[2] = {0};
    for (int k = 0; k < 2; k++) {
        lua_rawgeti(L, -1, k + 1);
        instance_read(L, -1, who, key, m->kinds, &ends[k]);
        angles[k] = (float)lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
    for (uint32_t i = 0; i < m->count; i++) {
        struct instance_entry *e = &m->entries[i];
        float t = chance(m, i, key);
        if (key == INSTANCE_YAW) instance_set_yaw(e, mixf(angles[0], angles[1], t));
        if (key == INSTANCE_SCALE) e->place.v[3] = mixf(ends[0].place.v[3], ends[1].place.v[3], t);
        if (key == INSTANCE_GLOW) e->color.v[3] = mixf(ends[0].color.v[3], ends[1].color.v[3], t);
        for (int c = 0; c < 3 && key == INSTANCE_COLOR; c++)
            e->color.v[c] = mixf(ends[0].color.v[c], ends[1].color.v[c], t);
    }
}

// Reads how many instances of each kind there are, as relative numbers.
static void read_shares(const maker *m) {
    lua_State *L = m->L;
    double upto[SCENE_INSTANCES_MAX_KINDS] = {0}, sum = 0;
    for (size_t k = 0; k < m->kinds; k++) {
        lua_rawgeti(L, -1, (lua_Integer)k + 1);
        double share = lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) : -1;
        if (!(share >= 0 && share <= 1e6))
            vm_error(L, "instances: a share of 'kind' is %s; numbers from 0 on are accepted",
                     luaL_tolstring(L, -1, NULL));
        upto[k] = sum += share;
        lua_pop(L, 1);
    }
    if (sum == 0) vm_error(L, "instances: all shares of 'kind' are 0");
    for (uint32_t i = 0; i < m->count; i++) {
        double at = sum * (double)chance(m, i, INSTANCE_KIND);
        uint32_t k = 0;
        while (k + 1 < m->kinds && at >= upto[k]) k++;
        m->entries[i].kind.v[0] = k;
    }
}

static bool is_range(const maker *m, instance_key key, lua_Unsigned length) {
    return length == 2 && m->count != 2 &&
           (key == INSTANCE_YAW || key == INSTANCE_SCALE || key == INSTANCE_GLOW ||
            key == INSTANCE_COLOR);
}

static void read_key(const maker *m, instance_key key) {
    lua_State *L = m->L;
    const char *name = instance_key_names[key];
    int type = value_get(L, 1, name);
    lua_Unsigned length = type == LUA_TTABLE ? lua_rawlen(L, -1) : 0;
    if (type == LUA_TFUNCTION) {
        read_by_function(m, key);
    } else if (type == LUA_TTABLE && instance_is_list(L, -1, key)) {
        if (is_range(m, key, length))
            read_range(m, key);
        else if (length == m->count)
            read_list(m, key);
        else if (key == INSTANCE_KIND && length == m->kinds)
            read_shares(m);
        else
            vm_error(L,
                     "instances: '%s' is a list of %d; one value, %s, a list of %d or a "
                     "function(i, place) is accepted",
                     name, (int)length,
                     key == INSTANCE_KIND ? "a share for each mesh" : "{low, high}", (int)m->count);
    } else if (type != LUA_TNIL) {
        struct instance_entry one = {.turn = {{0, 0, 0, 1}}};
        instance_read(L, -1, who, key, m->kinds, &one); // says what is wrong
        for (uint32_t i = 0; i < m->count; i++)
            instance_read(L, -1, who, key, m->kinds, &m->entries[i]);
    }
    lua_pop(L, 1);
}

// Tilts each instance in a random direction.
static void read_lean(const maker *m) {
    double most = value_get_number(m->L, 1, who, "lean", 0);
    if (!(most >= 0 && most <= 180))
        vm_error(m->L, "instances: 'lean' is %g; 0 to 180 degrees are accepted", most);
    for (uint32_t i = 0; i < m->count && most > 0; i++) {
        float *turn = m->entries[i].turn.v;
        float way = 6.2831853f * chance(m, i, CHANCE_LEAN_WAY);
        versor lean, own, both;
        glm_quatv(lean, glm_rad((float)most) * chance(m, i, CHANCE_LEAN),
                  (vec3){cosf(way), sinf(way), 0});
        memcpy(own, turn, sizeof own);
        glm_quat_mul(lean, own, both);
        memcpy(turn, both, sizeof both);
    }
}

// ---- the object -------------------------------------------------------------------------------

static size_t read_kinds(lua_State *L, scene_mesh *kinds[SCENE_INSTANCES_MAX_KINDS]) {
    lua_Unsigned count = lua_rawlen(L, 1);
    if (count < 1 || count > SCENE_INSTANCES_MAX_KINDS)
        vm_error(L,
                 "instances: %d meshes are given; 1 to %d come first, as in instances { mesh { "
                 "\"data/pine.obj\" }, at = ... }",
                 (int)count, SCENE_INSTANCES_MAX_KINDS);
    for (lua_Unsigned i = 0; i < count; i++) {
        lua_rawgeti(L, 1, (lua_Integer)i + 1);
        const mesh_object *object = object_test(L, -1, "mesh");
        if (!object)
            vm_error(L, "instances: value %d is %s; those without a name are meshes", (int)i + 1,
                     object_kind(L, -1));
        if (object->placed)
            vm_error(L,
                     "instances: mesh '%s' has a place or colour of its own; say it of the "
                     "instances",
                     object->mesh->name);
        kinds[i] = object->mesh;
        kinds[i]->repeated = true;
        lua_pop(L, 1);
    }
    return count;
}

static void read_whole(lua_State *L, scene_instances_desc *desc) {
    static const float nothing[4] = {0}, one[4] = {1, 1, 1, 1};
    vm_charge_memory(L, 4 * sizeof(field));
    arena *memory = script_memory(L);
    desc->name = value_name_or_variable(L, 1, who);
    desc->position =
        value_get_uniform(L, 1, who, "position", 3, field_constant(memory, 3, nothing));
    desc->rotation =
        value_get_uniform(L, 1, who, "rotation", 3, field_constant(memory, 3, nothing));
    desc->scale = field_constant(memory, 1, one);
    desc->color = value_get_uniform(L, 1, who, "tint", 3, field_constant(memory, 3, one));
    desc->parent = value_get_node(L, 1, who, "parent");
}

int l_instances(lua_State *L) {
    scene_mesh *kinds[SCENE_INSTANCES_MAX_KINDS];
    maker m = {.L = L};
    script_require_loading(L, who);
    value_check_object(L, 1, who);
    m.kinds = read_kinds(L, kinds);
    m.seed = value_get_count(L, 1, who, "seed", 1);
    read_places(&m);
    for (int k = INSTANCE_YAW; k < INSTANCE_KEYS; k++) read_key(&m, (instance_key)k);
    read_lean(&m);
    scene_instances_desc desc = {
        .kinds = kinds, .kind_count = m.kinds, .entries = m.entries, .count = m.count};
    read_whole(L, &desc);
    instances_object *object = object_new(L, who, sizeof *object);
    object->instances = effect_add_instances(script_of(L)->effect, &desc);
    if (!object->instances) script_raise(L);
    lua_pushvalue(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, object->instances);
    return 1;
}
