// Lights besides the sun: point_light { }, spot_light { }, sphere_light { }, and the list of them
// that is assigned to fx.lights. Every number may move.
#include "base/memory.h"
#include "script/binding.h"
#include <string.h>

static const field *constant(lua_State *L, int components, float x, float y, float z) {
    vm_charge_memory(L, sizeof(field));
    return field_constant(script_memory(L), components, (float[4]){x, y, z});
}

static void set_default(const field **slot, const field *otherwise) {
    if (!*slot) *slot = otherwise;
}

static scene_light *make_light(lua_State *L, const char *who, scene_light_kind kind) {
    value_refuse_array(L, who);
    light_object *object = object_new(L, "light", sizeof *object);
    scene_light *light = &object->light;
    value_read_slots(L, who, light);
    if (!light->position)
        vm_error(L, "%s: 'position' is missing: where it stands, {x, y, z} in metres", who);
    light->kind = kind;
    light->name = value_name_or_variable(L, 1, who);
    set_default(&light->color, constant(L, 3, 1, 1, 1));
    set_default(&light->power, constant(L, 1, 100, 0, 0));
    bool ends = light->range;
    set_default(&light->range, constant(L, 1, 0, 0, 0));
    light->linear = value_get_choice(L, 1, script_object_find(who), "falloff") == 1;
    if (light->linear && !ends)
        vm_error(L, "%s: falloff = \"linear\" ends at a 'range', which is missing", who);
    return light;
}

static int l_point_light(lua_State *L) {
    scene_light *light = make_light(L, "point_light", SCENE_POINT);
    light->radius = constant(L, 1, 0, 0, 0);
    return 1;
}

static int l_sphere_light(lua_State *L) {
    if (!make_light(L, "sphere_light", SCENE_POINT)->radius)
        vm_error(L, "sphere_light: 'radius' is missing: of the sphere that glows, in metres; "
                    "point_light { } has none");
    return 1;
}

static int l_spot_light(lua_State *L) {
    scene_light *light = make_light(L, "spot_light", SCENE_SPOT);
    set_default(&light->radius, constant(L, 1, 0, 0, 0));
    set_default(&light->target, constant(L, 3, 0, 0, 0));
    set_default(&light->angle, constant(L, 1, 45, 0, 0));
    set_default(&light->softness, constant(L, 1, 0.15f, 0, 0));
    return 1;
}

size_t value_lights(lua_State *L, int index, const char *who, scene_light **out) {
    enum { MOST = LIGHT_MAX - 1, CONTROLS = 8 };
    if (!value_is_plain_table(L, index) || value_has_names(L, index))
        vm_error(
            L, "%s: 'lights' takes a list, as in { point_light { position = {0, 0, 3} } }; got %s",
            who, value_is_plain_table(L, index) ? "a table with names" : object_kind(L, index));
    size_t count = lua_rawlen(L, index);
    if (count > MOST)
        vm_error(L, "%s: %d lights; at most %d are possible", who, (int)count, (int)MOST);
    vm_charge_memory(L, count * (sizeof **out + CONTROLS * EFFECT_CONTROL_COST));
    scene_light *lights = arena_alloc(script_memory(L), count * sizeof *lights);
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        const light_object *object = object_test(L, -1, "light");
        if (!object)
            vm_error(L,
                     "%s: entry %d of 'lights' is %s; point_light { }, spot_light { } and "
                     "sphere_light { } are accepted",
                     who, (int)i + 1, object_kind(L, -1));
        lights[i] = object->light;
        lua_pop(L, 1);
    }
    *out = lights;
    return count;
}

void l_light_open(lua_State *L) {
    static const luaL_Reg none[] = {{NULL, NULL}};
    object_type(L, "light", none);
    lua_register(L, "point_light", l_point_light);
    lua_register(L, "spot_light", l_spot_light);
    lua_register(L, "sphere_light", l_sphere_light);
}
