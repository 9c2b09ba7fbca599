// Particles as a field: dust = deposit { chaff, box = { min, max } } gives dust.density and
// dust.velocity.
#include "pass/particles/deposit.h"
#include "script/binding.h"
#include <string.h>

enum { RESOLUTION = 32 };

typedef struct deposit_object {
    field_grid *grid;
} deposit_object;

static int l_deposit(lua_State *L) {
    script_require_loading(L, "deposit");
    if (lua_gettop(L) != 1 || !value_is_plain_table(L, 1))
        vm_error(L,
                 "deposit takes particles and named values, as in deposit { chaff, box = { min = "
                 "{-1, -1, 0}, max = {1, 1, 2} } }");
    const char *variable = value_name_or_variable(L, 1, "deposit");
    deposit_object *object = object_new(L, "deposit", sizeof *object);
    int result = lua_gettop(L);
    pass *p = pass_make(L, "deposit", "deposit", 1, script_object_find("deposit")->keys);
    pass_deposit_desc desc = {.resolution =
                                  value_get_count(L, 1, "deposit", "resolution", RESOLUTION)};
    value_get_box(L, 1, "deposit", &desc.box);
    object->grid = pass_deposit_open(p, &desc);
    grid_add(L, object->grid, variable);
    script_made(L, pass_declare(p));
    lua_pushvalue(L, result);
    return 1;
}

// .density, .velocity, .box
static int l_index(lua_State *L) {
    const deposit_object *object = luaL_checkudata(L, 1, "deposit");
    const char *name = luaL_checkstring(L, 2);
    if (strcmp(name, "box") == 0) {
        value_push_box(L, object->grid->box);
        return 1;
    }
    script_require_loading(L, "a field of particles");
    grid_push_field(L, object->grid, name);
    return 1;
}

void l_deposit_open(lua_State *L) {
    static const luaL_Reg methods[] = {{"__index", l_index}, {NULL, NULL}};
    object_type(L, "deposit", methods);
    lua_register(L, "deposit", l_deposit);
}
