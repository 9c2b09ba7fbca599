// Simulated air: lbm { size = {64, 64, 96}, voxel_size = 0.05 } has fields by name (air.density).
// air:source { } adds smoke, air:collider { } adds an obstacle.
#include "base/memory.h"
#include "pass/air/lbm.h"
#include "script/binding.h"
#include <math.h>
#include <string.h>

enum { BODY_COST = 4 << 10 }; // bytes of host memory charged for a mesh in the air

typedef struct lbm_object {
    pass *pass;
    field_grid *grid;
    double time_step;
} lbm_object;

// ---- reading ----------------------------------------------------------------------------------

static void read_size(lua_State *L, pass_lbm_desc *desc) {
    float size[3];
    if (!value_get_vector(L, 1, "lbm", "size", size))
        vm_error(L, "lbm: 'size' is missing: the cells of its box, as in {64, 64, 96}");
    for (int i = 0; i < 3; i++) {
        if (!(size[i] >= 4 && size[i] <= 1024 && size[i] == floorf(size[i])))
            vm_error(L, "lbm: 'size' has %g; whole numbers from 4 to 1024 are accepted",
                     (double)size[i]);
        desc->size[i] = (uint32_t)size[i];
    }
    if (desc->size[0] % 4 != 0)
        vm_error(L, "lbm: 'size' has x = %d; a multiple of 4 is needed", (int)desc->size[0]);
    if (desc->size[2] % 8 != 0 || desc->size[2] < 16)
        vm_error(L, "lbm: 'size' has z = %d; a multiple of 8 from 16 on is needed",
                 (int)desc->size[2]);
}

static void read_desc(lua_State *L, pass_lbm_desc *desc) {
    float position[3] = {0};
    read_size(L, desc);
    desc->voxel_size = value_get_number(L, 1, "lbm", "voxel_size", (double)NAN);
    if (isnan(desc->voxel_size))
        vm_error(L, "lbm: 'voxel_size' is missing: the edge of a cell in metres");
    value_get_vector(L, 1, "lbm", "position", position);
    desc->position = (float3){position[0], position[1], position[2]};
    desc->speed = value_get_number(L, 1, "lbm", "speed", 4);
    desc->time_step = value_get_number(L, 1, "lbm", "time_step", 0);
    desc->warm_up = value_get_number(L, 1, "lbm", "warm_up", 0);
}

// Sets a face from the word at the top of the stack, which the author gave as `key`.
static void set_face(lua_State *L, pass *p, const char *face, const char *key) {
    static const char *const words[] = {"open", "wall", "slip", "inflow", "periodic"};
    if (lua_type(L, -1) != LUA_TSTRING)
        vm_error(L,
                 "lbm: boundary: '%s' takes a word: \"open\", \"wall\", \"slip\", \"inflow\" or "
                 "\"periodic\"; got %s",
                 key, object_kind(L, -1));
    const char *word = words[value_word(L, -1, "lbm", key, words, COUNT_OF(words))];
    const char *option = lua_pushfstring(L, "boundary_%s", face);
    if (!pass_set_option(p, option, word)) script_raise(L);
    lua_pop(L, 1);
}

// Reads a word, or a table of words, at the top of the stack.
static void set_boundary(lua_State *L, pass *p) {
    static const char *const faces[] = {"left", "right", "front", "back", "bottom", "top", "sides"};
    enum { FACES = 6 };
    if (!value_is_plain_table(L, -1)) {
        for (size_t i = 0; i < FACES; i++) set_face(L, p, faces[i], "boundary");
        return;
    }
    int table = lua_gettop(L);
    value_check_keys(L, table, "lbm: boundary", faces, COUNT_OF(faces));
    if (lua_rawlen(L, table) > 0)
        vm_error(L, "lbm: boundary: a value has no name; name the face, as in { top = \"open\", "
                    "sides = \"open\", bottom = \"wall\" }");
    if (value_get(L, table, "sides") != LUA_TNIL)
        for (size_t i = 0; i < 4; i++) set_face(L, p, faces[i], "sides");
    lua_pop(L, 1);
    for (size_t i = 0; i < FACES; i++) {
        if (value_get(L, table, faces[i]) != LUA_TNIL) set_face(L, p, faces[i], faces[i]);
        lua_pop(L, 1);
    }
}

static int l_lbm(lua_State *L) {
    script_require_loading(L, "lbm");
    if (lua_gettop(L) != 1 || !value_is_plain_table(L, 1))
        vm_error(L, "lbm takes named values, as in lbm { size = {64, 64, 96}, voxel_size = 0.05 }");
    script *s = script_of(L);
    const char *unsound = s->unsound, *variable = value_name_or_variable(L, 1, "lbm");
    lbm_object *object = object_new(L, "lbm", sizeof *object);
    int result = lua_gettop(L);
    pass *p = pass_make(L, "lbm", "lbm", 1, script_object_find("lbm")->keys);
    pass_lbm_desc desc = {{0}, 0, {0, 0, 0}, 0, 0, 0};
    read_desc(L, &desc); // after keys that are not known, which may be those that are missing
    if (value_get(L, 1, "boundary") != LUA_TNIL) set_boundary(L, p);
    object->pass = p;
    object->grid = pass_lbm_open(p, &desc);
    if (!object->grid) script_raise(L);
    object->time_step = pass_lbm_time_step(p);
    effect_add_grid(s->effect, object->grid);
    effect_name_grid(s->effect, object->grid, variable);
    if (!pass_declare(p) || !pass_lbm_check(p)) script_raise(L);
    s->unsound = unsound;
    lua_pushvalue(L, result);
    return 1;
}

// ---- methods ----------------------------------------------------------------------------------

static const lbm_object *self(lua_State *L, const char *method) {
    const lbm_object *object = object_test(L, 1, "lbm");
    if (!object || lua_gettop(L) != 2 || !value_is_plain_table(L, 2))
        vm_error(L, "%s takes a table, as in air:%s { mesh { \"data/ball.obj\" } }: mind the ':'",
                 method, method);
    script_require_loading(L, method);
    return object;
}

// motion = curve { ... }: the movement of all meshes of the table at 2.
static const field *read_motion(lua_State *L, const char *who) {
    return value_get_uniform(L, 2, who, "motion", 3, NULL);
}

static void set_motion(lua_State *L, const char *who, mesh_object *mesh, const field *motion) {
    if (!mesh)
        vm_error(L,
                 "%s: 'motion' moves meshes, and there is something else; instances and shapes "
                 "move by their own keys",
                 who);
    if (mesh->at)
        vm_error(L,
                 "%s: 'motion' is given, and the mesh's own 'position', too; one of both says "
                 "where it is",
                 who);
    mesh->mesh->position = motion;
    mesh->at = mesh->placed = true;
}

static void move_meshes(lua_State *L, const char *who) {
    const field *motion = read_motion(L, who);
    lua_Integer count = motion ? (lua_Integer)lua_rawlen(L, 2) : 0;
    if (motion && count == 0) set_motion(L, who, NULL, motion);
    for (lua_Integer i = 1; i <= count; i++) {
        lua_rawgeti(L, 2, i);
        set_motion(L, who, object_test(L, -1, "mesh"), motion);
        lua_pop(L, 1);
    }
}

static int l_source(lua_State *L) {
    const lbm_object *air = self(L, "source");
    static const value_desc own[] = {{.name = "motion"}, {.name = NULL}};
    script *s = script_of(L);
    const char *unsound = s->unsound;
    pass *source = pass_make(L, "lbm_source", "source", 2, own);
    move_meshes(L, "source");
    vm_charge_memory(L, lua_rawlen(L, 2) * BODY_COST);
    if (!pass_declare(source) || !pass_lbm_add_source(air->pass, source)) script_raise(L);
    s->unsound = unsound;
    return 0;
}

// Adds the mesh at the top of the stack.
static void add_collider(lua_State *L, pass *air, voxels_rule rule) {
    const mesh_object *mesh = object_test(L, -1, "mesh");
    const scene_instances *instances = value_instances(L, -1);
    if (!mesh && !instances)
        vm_error(L, "collider takes meshes and instances; got %s", object_kind(L, -1));
    uint32_t count = mesh ? 1 : scene_instances_count(instances);
    for (uint32_t i = 0; i < count; i++) {
        vm_charge_memory(L, BODY_COST);
        scene_mesh *one = mesh ? mesh->mesh : scene_instances_mesh(instances, i, script_memory(L));
        if (one) pass_lbm_add_collider(air, one, rule);
    }
}

static int l_collider(lua_State *L) {
    const lbm_object *air = self(L, "collider");
    static const char *const keys[] = {"rule", "motion"};
    static const char *const rules[] = {"auto", "solid", "shell"};
    value_check_keys(L, 2, "collider", keys, COUNT_OF(keys));
    voxels_rule rule = VOXELS_AUTO;
    if (value_get(L, 2, "rule") != LUA_TNIL)
        rule = (voxels_rule)value_word(L, -1, "collider", "rule", rules, COUNT_OF(rules));
    lua_pop(L, 1);
    lua_Integer count = (lua_Integer)lua_rawlen(L, 2);
    if (count == 0)
        vm_error(L, "collider takes meshes, as in air:collider { mesh { \"data/ball.obj\" } }");
    move_meshes(L, "collider");
    for (lua_Integer i = 1; i <= count; i++) {
        lua_rawgeti(L, 2, i);
        add_collider(L, air->pass, rule);
        lua_pop(L, 1);
    }
    return 0;
}

// Suggests a field with a similar name.
static void refuse_name(lua_State *L, const char *name) {
    static const char *const own[] = {"source", "collider", "box", "time_step"};
    const char *near = str_nearest(name, own, COUNT_OF(own));
    if (near && !str_nearest(name, pass_fluid_names, PASS_FLUID_NAMES))
        vm_error(L, "lbm: no method or field '%s'; did you mean '%s'?", name, near);
    script_raise(L);
}

// air.box, air.time_step, air:source, air:collider; every other name is a field.
static int l_index(lua_State *L) {
    const lbm_object *air = luaL_checkudata(L, 1, "lbm");
    const char *name = luaL_checkstring(L, 2);
    if (strcmp(name, "source") == 0) {
        lua_pushcfunction(L, l_source);
    } else if (strcmp(name, "collider") == 0) {
        lua_pushcfunction(L, l_collider);
    } else if (strcmp(name, "time_step") == 0) {
        lua_pushnumber(L, air->time_step);
    } else if (strcmp(name, "box") == 0) {
        value_push_box(L, air->grid->box);
    } else {
        script_require_loading(L, "a field of simulated air");
        int components, channel = pass_lbm_use(air->pass, name, &components);
        if (channel < 0) refuse_name(L, name);
        field_push(L, field_grid_channel(script_memory(L), air->grid, channel, components));
    }
    return 1;
}

// The content of air follows from its keys and its sources, so it cannot be assigned.
static int l_newindex(lua_State *L) {
    vm_error(L,
             "air.%s cannot be set; say it in lbm { } or --set, or give it to the air with "
             "air:source { }",
             luaL_tolstring(L, 2, NULL));
}

void l_lbm_open(lua_State *L) {
    static const luaL_Reg methods[] = {
        {"__index", l_index}, {"__newindex", l_newindex}, {NULL, NULL}};
    object_type(L, "lbm", methods);
    lua_register(L, "lbm", l_lbm);
}
