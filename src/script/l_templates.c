// flow:templates { image "templates/source.exr", kind = "pressure", count = 40, ... }: pictures
// that are put into the flow of slices, or into simulated air, for a while, again and again.
#include "pass/slices/slices_templates.h"
#include "script/binding.h"

const char templates_example[] = "image \"templates/source.exr\", count = 40";

// Reads {a, b}, each a number that may change over time, for two uniforms; or one number for both,
// if `single`.
static void set_pair(lua_State *L, pass *p, const char *key, const char *first, const char *second,
                     bool single) {
    const char *names[2] = {first, second};
    if (value_get(L, 2, key) == LUA_TNIL) {
        lua_pop(L, 1);
        return;
    }
    int value = lua_gettop(L);
    bool pair = value_is_plain_table(L, value);
    if (pair ? lua_rawlen(L, value) != 2 || value_has_names(L, value) : !single)
        vm_error(L, "templates: '%s' takes two numbers%s, as in %s = {0.1, 0.2}", key,
                 single ? " {least, most}, or one" : " {x, y}", key);
    for (int i = 0; i < 2; i++) {
        if (pair) lua_rawgeti(L, value, i + 1);
        const field *node = value_uniform(L, pair ? -1 : value, "templates", key, 1);
        if (!pass_set_uniform(p, names[i], node)) script_raise(L);
        lua_settop(L, value);
    }
    lua_pop(L, 1);
}

// Takes the picture, the first value without a name, out of the table; other values without a name
// are errors.
static const picture *take_image(lua_State *L) {
    lua_rawgeti(L, 2, 1);
    const picture_object *image = value_picture(L, -1);
    if (!image)
        vm_error(L, "templates: its picture comes first, as in flow:templates { %s }; got %s",
                 templates_example, object_kind(L, -1));
    const picture *result = image->picture; // of the effect, not of the script
    lua_pop(L, 1);
    lua_createtable(L, 0, 8);
    lua_pushnil(L);
    while (lua_next(L, 2)) {
        if (lua_isinteger(L, -2) && lua_tointeger(L, -2) == 1) {
            lua_pop(L, 1);
            continue;
        }
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, -4);
    }
    lua_replace(L, 2);
    return result;
}

pass *templates_make(lua_State *L, const char *type, const value_desc *own, const picture **image,
                     uint32_t *count) {
    *image = take_image(L);
    *count = value_get_count(L, 2, "templates", "count", 20);
    pass *group = pass_make(L, type, "templates", 2, own);
    set_pair(L, group, "size", "size_min", "size_max", true);
    set_pair(L, group, "lifetime", "lifetime_min", "lifetime_max", true);
    return group;
}

int l_slices_templates(lua_State *L) {
    static const value_desc own[] = {{.name = "count"},
                                     {.name = "size"},
                                     {.name = "lifetime"},
                                     {.name = "center"},
                                     {.name = NULL}};
    const slices_object *flow = slices_self(L, "templates", templates_example);
    const picture *image;
    uint32_t count;
    pass *group = templates_make(L, "slices_templates", own, &image, &count);
    set_pair(L, group, "center", "center_x", "center_y", false);
    script_made(L, pass_declare(group) && slices_add_templates(flow->pass, group, image, count));
    return 0;
}
