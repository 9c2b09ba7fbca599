// Hundreds of point lights: point_lights { count = 200, position = vec(...) }. Passes that they
// light name the result by `from`. Fields that the device evaluates describe them; lights that the
// script moves one by one are point_light { }.
#include "pass/light/point_lights.h"
#include "script/binding.h"

// at = forest: one light for each instance; else `count` is the number.
static scene_instances *read_at(lua_State *L) {
    bool counted = value_get(L, 1, "count") != LUA_TNIL, given = value_get(L, 1, "at") != LUA_TNIL;
    scene_instances *at = given ? value_instances(L, -1) : NULL;
    if (given && !at)
        vm_error(L, "point_lights: 'at' takes instances { }; got %s", object_kind(L, -1));
    if (counted == given)
        vm_error(L,
                 "point_lights: one of 'count' (1 to %d) and 'at' (instances) is to be given: how "
                 "many there are",
                 (int)PASS_POINT_LIGHTS_MOST);
    lua_pop(L, 2);
    return at;
}

int l_point_lights(lua_State *L) {
    script_require_loading(L, "point_lights");
    if (lua_gettop(L) != 1 || !value_is_plain_table(L, 1))
        vm_error(L, "point_lights takes named values, as in point_lights { count = 200, position = "
                    "vec(3 * sin(time + light_index), 0, 2) }");
    pass *p =
        pass_make(L, "point_lights", "point_lights", 1, script_object_find("point_lights")->keys);
    scene_instances *at = read_at(L);
    uint32_t count = value_get_count(L, 1, "point_lights", "count", 0);
    script_made(L, pass_point_lights_open(p, count, at) && pass_declare(p));
    pass_push(L, p);
    return 1;
}
