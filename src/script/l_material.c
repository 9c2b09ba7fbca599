// The surface of a mesh: material { color = "#8a4a20", specular = 0.5, roughness = 0.4 }, for mesh
// { "data/barrel.obj", material = rust }. Every number may change over time.
#include "scene/material.h"
#include "script/binding.h"
#include <string.h>

static const char type_name[] = "material";
enum { CONTROLS = 5 };

int l_material(lua_State *L) {
    value_refuse_array(L, "material");
    material_object *object = object_new(L, type_name, sizeof *object);
    vm_charge_memory(L, sizeof(scene_material) + sizeof(field) + CONTROLS * EFFECT_CONTROL_COST);
    scene_material *made = arena_alloc(script_memory(L), sizeof *made);
    value_read_slots(L, "material", made);
    made->name = value_name_or_variable(L, 1, type_name);
    if (strcmp(made->name, type_name) == 0) made->name = NULL; // made in passing
    made->no_toon = !value_get_bool(L, 1, "material", "toon", true);
    const char *texture = value_get_string(L, 1, "material", "texture");
    if (texture) {
        made->texture = effect_add_texture(script_of(L)->effect, texture);
        if (!made->texture) script_raise(L);
        vm_charge_memory(L, 4 * (size_t)made->texture->width * made->texture->height);
    }
    if (!made->specular && (made->roughness || made->metallic)) // it is to be seen
        made->specular = field_constant(script_memory(L), 1, (float[4]){0.5f});
    effect_add_material(script_of(L)->effect, made);
    object->material = made;
    return 1;
}

void value_read_material(lua_State *L, const char *who, scene_mesh *mesh) {
    if (value_get(L, 1, "material") != LUA_TNIL) {
        const material_object *object = object_test(L, -1, type_name);
        if (!object)
            vm_error(L, "%s: 'material' takes material { }; got %s", who, object_kind(L, -1));
        vm_charge_memory(L, mesh->data.part_count * sizeof *mesh->data.parts);
        scene_mesh_set_material(mesh, object->material, script_memory(L));
    }
    lua_pop(L, 1);
}
