// A few planes of simulated flow around an axis: slices { count = 2, size = {128, 128}, height = 4
// } has fields by name (flow.density). flow:inflow { }, flow:obstacle { } and flow:force { } act in
// the planes; flow:slice(1) is one of them.
#include "pass/slices/slices.h"
#include "script/binding.h"
#include <math.h>
#include <string.h>

enum { PAINTED_MAX = 4096 }; // pixels a side

typedef struct slice_object { // flow:slice(1)
    pass *pass;
    const field_grid *grid;
} slice_object;

// ---- reading ----------------------------------------------------------------------------------

static void read_size(lua_State *L, pass_slices_desc *desc) {
    float size[4] = {128, 128};
    if (value_get(L, 1, "size") != LUA_TNIL) {
        int count = value_numbers(L, -1, size);
        if (count == 1) size[1] = size[0];
        if (count != 1 && count != 2)
            vm_error(L, "slices: 'size' must be the cells of a slice, as in {128, 128}; got %s",
                     object_kind(L, -1));
    }
    lua_pop(L, 1);
    for (int i = 0; i < 2; i++) {
        if (!(size[i] >= PASS_SLICES_LEAST_CELLS && size[i] <= PASS_SLICES_MOST_CELLS &&
              size[i] == floorf(size[i])))
            vm_error(L, "slices: 'size' has %g; whole numbers from %d to %d are accepted",
                     (double)size[i], (int)PASS_SLICES_LEAST_CELLS, (int)PASS_SLICES_MOST_CELLS);
        desc->size[i] = (uint32_t)size[i];
    }
}

static void read_desc(lua_State *L, const char *name, pass_slices_desc *desc) {
    float axis[3] = {0, 0, 1};
    read_size(L, desc);
    desc->count = value_get_count(L, 1, "slices", "count", 2);
    if (desc->count < 1 || desc->count > PASS_SLICES_MOST)
        vm_error(L, "slices: 'count' is %d; 1 to %d are accepted", (int)desc->count,
                 (int)PASS_SLICES_MOST);
    desc->height = value_get_number(L, 1, "slices", "height", 1);
    value_get_place(L, 1, "slices", "position", name, &desc->position);
    value_get_vector(L, 1, "slices", "axis", axis);
    desc->axis = (float3){axis[0], axis[1], axis[2]};
    desc->time_step = value_get_number(L, 1, "slices", "time_step", 1.0 / 60);
    desc->warm_up = value_get_number(L, 1, "slices", "warm_up", 0);
    desc->max_iterations = value_get_count(L, 1, "slices", "max_iterations", 0);
}

static const field *read_offset(lua_State *L) {
    const field *offset = NULL;
    if (value_get(L, 1, "offset") != LUA_TNIL) offset = value_field(L, -1, "slices", "offset", 3);
    lua_pop(L, 1);
    return offset;
}

static int l_slices(lua_State *L) {
    script_require_loading(L, "slices");
    if (lua_gettop(L) != 1 || !value_is_plain_table(L, 1))
        vm_error(L, "slices takes named values, as in slices { size = {128, 128}, height = 4 }");
    const char *variable = value_name_or_variable(L, 1, "slices");
    slices_object *object = object_new(L, "slices", sizeof *object);
    int result = lua_gettop(L);
    pass *p = pass_make(L, "slices", "slices", 1, script_object_find("slices")->keys);
    pass_slices_desc desc = {0};
    read_desc(L, variable,
              &desc); // after keys that are not known, which may be those that are missing
    object->pass = p;
    object->offset = read_offset(L);
    object->count = desc.count;
    object->time_step = desc.time_step;
    object->grid = pass_slices_open(p, &desc);
    grid_add(L, object->grid, variable);
    script_made(L, pass_declare(p));
    lua_pushvalue(L, result);
    return 1;
}

// ---- methods ----------------------------------------------------------------------------------

const slices_object *slices_self(lua_State *L, const char *method, const char *example) {
    const slices_object *object = object_test(L, 1, "slices");
    if (!object || lua_gettop(L) != 2 || !value_is_plain_table(L, 2))
        vm_error(L, "%s takes a table, as in flow:%s { %s }: mind the ':'", method, method,
                 example);
    script_require_loading(L, method);
    return object;
}

static int add_part(lua_State *L, const char *type, const char *method, const char *example) {
    const slices_object *flow = slices_self(L, method, example);
    pass *part = pass_make(L, type, method, 2, NULL);
    script_made(L, pass_declare(part) && pass_slices_add(flow->pass, part, NULL));
    return 0;
}

static int l_inflow(lua_State *L) {
    return add_part(L, "slices_inflow", "inflow",
                    "shape = disc { 0.5, 0.05, radius = 0.06 }, density = 1");
}

static int l_force(lua_State *L) {
    return add_part(L, "slices_force", "force", "force = {1, 0}");
}

static const struct picture *read_painted(lua_State *L) {
    const struct picture *painted = NULL;
    if (value_get(L, 2, "image") != LUA_TNIL) {
        const picture_object *object = value_picture(L, -1);
        if (!object)
            vm_error(L,
                     "obstacle: 'image' takes a picture, as in image = image \"rock.png\"; got "
                     "%s",
                     object_kind(L, -1));
        painted = object->picture;
    }
    lua_pop(L, 1);
    return painted;
}

static int l_obstacle(lua_State *L) {
    static const value_desc own[] = {{.name = "image"}, {.name = NULL}};
    const slices_object *flow =
        slices_self(L, "obstacle", "shape = disc { 0.5, 0.5, radius = 0.1 }");
    pass *part = pass_make(L, "slices_obstacle", "obstacle", 2, own);
    const struct picture *painted = read_painted(L);
    script_made(L, pass_declare(part) && pass_slices_add(flow->pass, part, painted));
    return 0;
}

static int l_slice(lua_State *L) {
    const slices_object *flow = object_test(L, 1, "slices");
    script_require_loading(L, "slice");
    if (!flow || lua_gettop(L) != 2 || !lua_isinteger(L, 2))
        vm_error(L, "slice takes a number, as in flow:slice(1): mind the ':'");
    lua_Integer index = lua_tointeger(L, 2);
    if (index < 1 || index > (lua_Integer)flow->count)
        vm_error(L, "slice: there is no slice %d; 1 to %d are accepted", (int)index,
                 (int)flow->count);
    slice_object *object = object_new(L, "slice", sizeof *object);
    *object = (slice_object){flow->pass, pass_slices_only(flow->pass, (uint32_t)index - 1)};
    return 1;
}

// ---- fields -----------------------------------------------------------------------------------

static const field *find_field(lua_State *L, pass *p, const field_grid *grid, const char *name) {
    int components;
    script_require_loading(L, "a field of slices");
    int channel = pass_slices_use(p, name, &components);
    if (channel < 0) script_raise(L);
    vm_charge_memory(L, sizeof(field));
    return field_grid_channel(script_memory(L), grid, channel, components);
}

// Samples at offset places, so that the result of rotating the slices is not the same all around.
static const field *perturbed(lua_State *L, const field *node, const field *offset) {
    const field *args[FIELD_MAX_ARGS] = {node, offset};
    if (!offset) return node;
    vm_charge_memory(L, sizeof(field));
    return field_make(script_memory(L), "warp", args, NULL);
}

// flow.box, flow.time_step, the methods; every other name is a field.
static int l_index(lua_State *L) {
    static const luaL_Reg methods[] = {{"inflow", l_inflow}, {"obstacle", l_obstacle},
                                       {"force", l_force},   {"templates", l_slices_templates},
                                       {"slice", l_slice},   {NULL, NULL}};
    const slices_object *flow = luaL_checkudata(L, 1, "slices");
    const char *name = luaL_checkstring(L, 2);
    for (const luaL_Reg *m = methods; m->name; m++)
        if (strcmp(m->name, name) == 0) {
            lua_pushcfunction(L, m->func);
            return 1;
        }
    if (strcmp(name, "time_step") == 0)
        lua_pushnumber(L, flow->time_step);
    else if (strcmp(name, "box") == 0)
        value_push_box(L, flow->grid->box);
    else {
        const field *node = perturbed(L, find_field(L, flow->pass, flow->grid, name), flow->offset);
        effect_note_reading(script_of(L)->effect, flow->grid, name, node);
        field_push(L, node);
    }
    return 1;
}

static int l_slice_index(lua_State *L) {
    const slice_object *slice = luaL_checkudata(L, 1, "slice");
    field_push(L, find_field(L, slice->pass, slice->grid, luaL_checkstring(L, 2)));
    return 1;
}

void l_slices_open(lua_State *L) {
    static const luaL_Reg methods[] = {{"__index", l_index}, {NULL, NULL}};
    static const luaL_Reg slice[] = {{"__index", l_slice_index}, {NULL, NULL}};
    object_type(L, "slices", methods);
    object_type(L, "slice", slice);
    lua_register(L, "slices", l_slices);
}
