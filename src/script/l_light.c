// Lights besides the sun: point_light { }, spot_light { }, sphere_light { }, and the list of them
// that is assigned to fx.lights. Every number may change over time.
#include "script/binding.h"
#include <string.h>

static int make_light(lua_State *L, const char *who, scene_light_kind kind) {
    value_refuse_array(L, who);
    light_object *object = object_new(L, "light", sizeof *object);
    scene_light *light = &object->light;
    value_read_slots(L, who, light);
    if (!light->position)
        vm_error(L, "%s: 'position' is missing: where it stands, {x, y, z} in metres", who);
    light->kind = kind;
    light->name = value_name_or_variable(L, 1, who);
    light->linear = value_get_choice(L, 1, script_object_find(who), "falloff") == 1;
    if (light->linear && !light->range)
        vm_error(L, "%s: falloff = \"linear\" ends at a 'range', which is missing", who);
    if (!light->radius && strcmp(who, "sphere_light") == 0)
        vm_error(L, "sphere_light: 'radius' is missing: of the sphere that glows, in metres; "
                    "point_light { } has none");
    vm_charge_memory(L, 7 * sizeof(field));
    unsigned needs = SCENE_SPHERE | (kind == SCENE_SPOT ? SCENE_CONE : 0);
    scene_set_defaults(scene_light_values, needs, light, script_memory(L));
    return 1;
}

int l_point_light(lua_State *L) {
    return make_light(L, "point_light", SCENE_POINT);
}

int l_sphere_light(lua_State *L) {
    return make_light(L, "sphere_light", SCENE_POINT);
}

int l_spot_light(lua_State *L) {
    return make_light(L, "spot_light", SCENE_SPOT);
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
