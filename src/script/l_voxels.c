// Meshes as fields: voxels { mesh { "data/ball.obj" }, resolution = 64 } has body.inside,
// body.distance and body.velocity.
#include "pass/grids/voxels.h"
#include "script/binding.h"
#include <math.h>
#include <string.h>

enum { BODY_COST = 4 << 10, RESOLUTION = 64 }; // bytes of host memory charged for a mesh

typedef struct voxels_object {
    pass *pass;
    field_grid *grid;
} voxels_object;

static void read_desc(lua_State *L, pass_voxels_desc *desc) {
    float size[3];
    value_get_box(L, 1, "voxels", &desc->box);
    desc->resolution = value_get_count(L, 1, "voxels", "resolution", RESOLUTION);
    if (desc->resolution < 8 || desc->resolution > 1024)
        vm_error(L, "voxels: 'resolution' is %d; 8 to 1024 cells are accepted",
                 (int)desc->resolution);
    if (!value_get_vector(L, 1, "voxels", "size", size)) return;
    for (int i = 0; i < 3; i++) {
        if (!(size[i] >= 1 && size[i] <= 1024 && size[i] == floorf(size[i])))
            vm_error(L, "voxels: 'size' has %g; whole numbers from 1 to 1024 are accepted",
                     (double)size[i]);
        desc->size[i] = (uint32_t)size[i];
    }
    if (desc->size[0] % 4 != 0)
        vm_error(L, "voxels: 'size' has x = %d; a multiple of 4 is needed", (int)desc->size[0]);
}

static int l_voxels(lua_State *L) {
    script_require_loading(L, "voxels");
    if (lua_gettop(L) != 1 || !value_is_plain_table(L, 1))
        vm_error(L, "voxels takes meshes, as in voxels { mesh { \"data/ball.obj\" } }");
    pass_voxels_desc desc = {.box = {{0, 0, 0}, {0, 0, 0}}};
    read_desc(L, &desc);
    const char *variable = value_name_or_variable(L, 1, "voxels");
    field_context context = script_context(L);
    static const value_desc own[] = {
        {.name = "resolution"}, {.name = "size"}, {.name = "box"}, {.name = NULL}};
    voxels_object *object = object_new(L, "voxels", sizeof *object);
    int result = lua_gettop(L);
    vm_charge_memory(L, lua_rawlen(L, 1) * BODY_COST);
    object->pass = pass_make(L, "voxels", "voxels", 1, own);
    object->grid = pass_voxels_open(object->pass, &desc, &context);
    grid_add(L, object->grid, variable);
    script_made(L, pass_declare(object->pass));
    lua_pushvalue(L, result);
    return 1;
}

// body.box; every other name is a field.
static int l_index(lua_State *L) {
    const voxels_object *body = luaL_checkudata(L, 1, "voxels");
    const char *name = luaL_checkstring(L, 2);
    if (strcmp(name, "box") == 0) {
        value_push_box(L, body->grid->box);
        return 1;
    }
    script_require_loading(L, "a field of voxels");
    field_push(L, pass_voxels_field(body->pass, name));
    return 1;
}

void l_voxels_open(lua_State *L) {
    static const luaL_Reg methods[] = {{"__index", l_index}, {NULL, NULL}};
    object_type(L, "voxels", methods);
    lua_register(L, "voxels", l_voxels);
}
