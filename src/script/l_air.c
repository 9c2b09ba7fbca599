// Simulated air: lbm { size = {64, 64, 96}, voxel_size = 0.05 } and pyro { ... }, which burns, have
// fields by name (air.density). air:source { } adds smoke or fuel, air:collider { } adds an
// obstacle.
#include "base/memory.h"
#include "pass/air/air.h"
#include "script/binding.h"
#include <math.h>
#include <string.h>

static const double SPARK_CELLS = 2.5, SPARK_HEAT = 1500, SPARK_SECONDS = 0.05; // radius; K

enum { BODY_COST = 4 << 10 }; // bytes of host memory charged for a mesh in the air

typedef struct air_type {
    const char *name, *source, *templates; // of the passes
    field_grid *(*open)(pass *p, const pass_air_desc *desc);
    uint32_t least, multiple[3]; // of cells along an axis, and by axis
    double speed;                // default, m/s
    bool burns;
} air_type;

static const air_type air_types[] = {
    {"lbm", "lbm_source", "lbm_templates", pass_lbm_open, 4, {4, 1, 8}, 4, false},
    {"pyro", "pyro_source", "pyro_templates", pass_pyro_open, 16, {8, 8, 8}, 12, true},
};

// Functions of a type have it as their first upvalue.
static const air_type *type_of(lua_State *L) {
    return lua_touserdata(L, lua_upvalueindex(1));
}

typedef struct air_object {
    pass *pass;
    field_grid *grid;
    double time_step, voxel_size;
} air_object;

// ---- reading ----------------------------------------------------------------------------------

static void read_size(lua_State *L, const air_type *type, pass_air_desc *desc) {
    const char *who = type->name;
    float size[3];
    if (!value_get_vector(L, 1, who, "size", size))
        vm_error(L, "%s: 'size' is missing: the cells of its box, as in {64, 64, 96}", who);
    for (int i = 0; i < 3; i++) {
        if (!(size[i] >= (float)type->least && size[i] <= 1024 && size[i] == floorf(size[i])))
            vm_error(L, "%s: 'size' has %g; whole numbers from %d to 1024 are accepted", who,
                     (double)size[i], (int)type->least);
        desc->size[i] = (uint32_t)size[i];
        if (desc->size[i] % type->multiple[i] != 0)
            vm_error(L, "%s: 'size' has %c = %d; a multiple of %d is needed", who, "xyz"[i],
                     (int)desc -> size[i], (int)type -> multiple[i]);
    }
}

static void read_desc(lua_State *L, const air_type *type, const char *name, pass_air_desc *desc) {
    const char *who = type->name;
    read_size(L, type, desc);
    desc->voxel_size = value_get_number(L, 1, who, "voxel_size", (double)NAN);
    if (isnan(desc->voxel_size))
        vm_error(L, "%s: 'voxel_size' is missing: the edge of a cell in metres", who);
    value_get_place(L, 1, who, "position", name, &desc->position);
    desc->speed = value_get_number(L, 1, who, "speed", type->speed);
    desc->time_step = value_get_number(L, 1, who, "time_step", 0);
    desc->warm_up = value_get_number(L, 1, who, "warm_up", 0);
    desc->time_scale = value_get_number(L, 1, who, "time_scale", 1);
}

// Sets a face from the word at the top of the stack, which the author gave as `key`.
static void set_face(lua_State *L, pass *p, const char *face, const char *key) {
    static const char *const words[] = {"open", "wall", "slip", "inflow", "periodic"};
    const char *who = type_of(L)->name;
    if (lua_type(L, -1) != LUA_TSTRING)
        vm_error(L,
                 "%s: boundary: '%s' takes a word: \"open\", \"wall\", \"slip\", \"inflow\" or "
                 "\"periodic\"; got %s",
                 who, key, object_kind(L, -1));
    const char *word = words[value_word(L, -1, who, key, words, COUNT_OF(words))];
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
    const char *who = lua_pushfstring(L, "%s: boundary", type_of(L)->name);
    value_check_keys(L, table, who, faces, COUNT_OF(faces));
    if (lua_rawlen(L, table) > 0)
        vm_error(L,
                 "%s: a value has no name; name the face, as in { top = \"open\", "
                 "sides = \"open\", bottom = \"wall\" }",
                 who);
    lua_pop(L, 1);
    if (value_get(L, table, "sides") != LUA_TNIL)
        for (size_t i = 0; i < 4; i++) set_face(L, p, faces[i], "sides");
    lua_pop(L, 1);
    for (size_t i = 0; i < FACES; i++) {
        if (value_get(L, table, faces[i]) != LUA_TNIL) set_face(L, p, faces[i], faces[i]);
        lua_pop(L, 1);
    }
}

static int l_air(lua_State *L) {
    const air_type *type = type_of(L);
    const char *who = type->name;
    script_require_loading(L, who);
    if (lua_gettop(L) != 1 || !value_is_plain_table(L, 1))
        vm_error(L, "%s takes named values, as in %s { size = {64, 64, 96}, voxel_size = 0.05 }",
                 who, who);
    const char *variable = value_name_or_variable(L, 1, who);
    air_object *object = object_new(L, who, sizeof *object);
    int result = lua_gettop(L);
    pass *p = pass_make(L, who, who, 1, script_object_find(who)->keys);
    pass_air_desc desc = {.voxel_size = 0};
    read_desc(L, type, variable,
              &desc); // after keys that are not known, which may be those that are missing
    if (value_get(L, 1, "boundary") != LUA_TNIL) set_boundary(L, p);
    object->pass = p;
    object->grid = type->open(p, &desc);
    grid_add(L, object->grid, variable);
    object->time_step = pass_air_time_step(p);
    object->voxel_size = desc.voxel_size;
    script_made(L, pass_declare(p) && pass_air_check(p));
    lua_pushvalue(L, result);
    return 1;
}

// ---- methods ----------------------------------------------------------------------------------

static const air_object *self(lua_State *L, const char *method, const char *example) {
    const air_object *object = object_test(L, 1, type_of(L)->name);
    if (!object || lua_gettop(L) != 2 || !value_is_plain_table(L, 2))
        vm_error(L, "%s takes a table, as in air:%s { %s }: mind the ':'", method, method, example);
    script_require_loading(L, method);
    return object;
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

// motion = curve { ... }: the movement of all meshes of the table at 2.
static void move_meshes(lua_State *L, const char *who) {
    const field *motion = value_get_uniform(L, 2, who, "motion", 3, NULL);
    lua_Integer count = motion ? (lua_Integer)lua_rawlen(L, 2) : 0;
    if (motion && count == 0) set_motion(L, who, NULL, motion);
    for (lua_Integer i = 1; i <= count; i++) {
        lua_rawgeti(L, 2, i);
        set_motion(L, who, object_test(L, -1, "mesh"), motion);
        lua_pop(L, 1);
    }
}

static int l_source(lua_State *L) {
    const air_object *air = self(L, "source", "mesh { \"data/ball.obj\" }");
    static const value_desc own[] = {{.name = "motion"}, {.name = NULL}};
    pass *source = pass_make(L, type_of(L)->source, "source", 2, own);
    move_meshes(L, "source");
    vm_charge_memory(L, lua_rawlen(L, 2) * BODY_COST);
    script_made(L, pass_declare(source) && pass_air_add_source(air->pass, source));
    return 0;
}

static int l_templates(lua_State *L) {
    static const value_desc own[] = {
        {.name = "count"}, {.name = "size"}, {.name = "lifetime"}, {.name = NULL}};
    const air_object *air = self(L, "templates", templates_example);
    const struct picture *image;
    uint32_t count;
    pass *group = templates_make(L, type_of(L)->templates, own, &image, &count);
    script_made(L, pass_declare(group) && pass_air_add_templates(air->pass, group, image, count));
    return 0;
}

// fire:spark { at = {0, 0, 0.2}, time = 0.1 } is a source of hot gas, in a ball and for a moment.
static int l_spark(lua_State *L) {
    const air_object *air = self(L, "spark", "at = {0, 0, 0.2}, time = 0.1");
    static const char *const keys[] = {"at", "time", "radius", "temperature", "duration"};
    float at[3] = {0};
    value_check_keys(L, 2, "spark", keys, COUNT_OF(keys));
    if (!value_get_vector(L, 2, "spark", "at", at))
        vm_error(L, "spark: 'at' is missing: where it is, {x, y, z} in metres");
    const double time = value_get_number(L, 2, "spark", "time", 0);
    const float radius =
        (float)value_get_number(L, 2, "spark", "radius", SPARK_CELLS * air->voxel_size);
    arena *memory = script_memory(L);
    vm_charge_memory(L, 3 * sizeof(field));
    const field *args[FIELD_MAX_ARGS] = {field_constant(memory, 3, (float[4]){at[0], at[1], at[2]}),
                                         field_constant(memory, 1, (float[4]){radius})};
    lua_createtable(L, 0, 3);
    field_push(L, field_make(memory, "sphere", args, NULL));
    lua_setfield(L, -2, "shape");
    value_put_number(L, "temperature", value_get_number(L, 2, "spark", "temperature", SPARK_HEAT));
    value_put_numbers(
        L, "during",
        (float[2]){(float)time,
                   (float)(time + value_get_number(L, 2, "spark", "duration", SPARK_SECONDS))},
        2);
    lua_replace(L, 2);
    return l_source(L);
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
        if (one) pass_air_add_collider(air, one, rule);
    }
}

static int l_collider(lua_State *L) {
    const air_object *air = self(L, "collider", "mesh { \"data/ball.obj\" }");
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

// What is said in another place than one may look for it.
static const char *place_of(const char *name) {
    static const char *const places[][2] = {
        {"spark",
         "in lbm nothing burns; of pyro it is fire:spark { at = {0, 0, 0.2}, time = 0.1 }"},
        {"force", "it is a key, of a field: { force = curl { ... }, ... }"},
        {"wind",
         "it is a key, of m/s: { wind = {2, 0, 0}, boundary = { left = \"inflow\" }, ... }"},
        {"smoke", "it is 'density' in lbm"},
        {"emitter", "air:source { ... } gives the air what it holds"},
    };
    for (size_t i = 0; i < COUNT_OF(places); i++)
        if (strcmp(places[i][0], name) == 0) return places[i][1];
    return NULL;
}

// Suggests a field with a similar name.
static void refuse_name(lua_State *L, const pass *air, const char *name) {
    if (place_of(name))
        vm_error(L, "%s: no method or field '%s'; %s", type_of(L)->name, name, place_of(name));
    static const char *const own[] = {"source",    "spark", "collider",
                                      "templates", "box",   "time_step"};
    const char *near = str_nearest(name, own, COUNT_OF(own));
    size_t count;
    const pass_fluid_field *fields = pass_air_fields(air, &count);
    if (near && !pass_fluid_nearest(fields, count, name))
        vm_error(L, "%s: no method or field '%s'; did you mean '%s'?", type_of(L)->name, name,
                 near);
    script_raise(L);
}

static void push_method(lua_State *L, lua_CFunction method) {
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_pushcclosure(L, method, 1);
}

// air.box, air.time_step, air:source, air:collider, air:templates; every other name is a field.
static int l_index(lua_State *L) {
    const air_object *air = luaL_checkudata(L, 1, type_of(L)->name);
    const char *name = luaL_checkstring(L, 2);
    if (strcmp(name, "source") == 0) {
        push_method(L, l_source);
    } else if (strcmp(name, "spark") == 0 && type_of(L)->burns) {
        push_method(L, l_spark);
    } else if (strcmp(name, "collider") == 0) {
        push_method(L, l_collider);
    } else if (strcmp(name, "templates") == 0) {
        push_method(L, l_templates);
    } else if (strcmp(name, "time_step") == 0) {
        lua_pushnumber(L, air->time_step);
    } else if (strcmp(name, "box") == 0) {
        value_push_box(L, air->grid->box);
    } else {
        script_require_loading(L, "a field of simulated air");
        int components;
        if (pass_air_use(air->pass, name, &components) < 0) refuse_name(L, air->pass, name);
        grid_push_field(L, air->grid, name);
    }
    return 1;
}

// The content of air follows from its keys and its sources, so it cannot be assigned.
static int l_newindex(lua_State *L) {
    vm_error(L,
             "air.%s cannot be set; say it in %s { } or --set, or give it to the air with "
             "air:source { }",
             luaL_tolstring(L, 2, NULL), type_of(L)->name);
}

static void open_type(lua_State *L, const air_type *type) {
    static const luaL_Reg methods[] = {
        {"__index", l_index}, {"__newindex", l_newindex}, {NULL, NULL}};
    void *upvalue = (void *)(uintptr_t)type;
    luaL_newmetatable(L, type->name);
    lua_pushlightuserdata(L, upvalue);
    luaL_setfuncs(L, methods, 1);
    lua_pushboolean(L, false);
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 1);
    lua_pushlightuserdata(L, upvalue);
    lua_pushcclosure(L, l_air, 1);
    lua_setglobal(L, type->name);
}

void l_air_open(lua_State *L) {
    for (size_t i = 0; i < COUNT_OF(air_types); i++) open_type(L, &air_types[i]);
}
