// Which controls the scene has: those of camera, sun and sky, of lights, materials, meshes and
// nodes. A camera is turned by what it was made of: one that circles its target by distance, yaw
// and pitch, and any by "camera.eye", which makes it stand somewhere.
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include "scene/material.h"
#include <string.h>

static const struct {
    const char *name;
    const scene_value *values;
    size_t offset; // in the scene
} groups[] = {
    {"camera", scene_camera_values, offsetof(scene, camera)},
    {"sun", scene_sun_values, offsetof(scene, sun)},
    {"sky", scene_sky_values, offsetof(scene, sky)},
};

static bool is_named(const char *name, const char *group, const char *member) {
    size_t length = strlen(group);
    return strncmp(name, group, length) == 0 && name[length] == '.' &&
           (!member || strcmp(name + length + 1, member) == 0);
}

bool scene_control_unknown(const effect *e, const char *name) {
    static const char *const reasons[] = {
        [SCENE_ORBIT] = "this camera stands at an eye; only an orbit has it",
        [SCENE_GRADIENT] = "this sky is an image; only one of two colours has it",
        [SCENE_IMAGE] = "this sky has no image",
        [SCENE_NIGHT] = "this sky has no night; sky { night = 0 } gives it one",
    };
    for (size_t i = 0; i < COUNT_OF(groups); i++)
        for (const scene_value *v = groups[i].values; v->desc.name; v++)
            if (!scene_has(&e->scene, v->need) && is_named(name, groups[i].name, v->desc.name)) {
                err_set("%s: %s", name, reasons[v->need]);
                return true;
            }
    return false;
}

// Of `s`, the scene as the script has it: setting an eye ends an orbit. NULL: of what has a field,
// since the rest is as a mesh has it, or of another kind of light.
static bool add_values(effect *e, effect_control_kind kind, const char *group,
                       const scene_value *values, void *structure, const scene *s) {
    for (const scene_value *v = values; v->desc.name; v++) {
        const field **slot = scene_slot(structure, v);
        if (s ? !scene_has(s, v->need) : !*slot) continue;
        control own = {.face.kind = kind, .slot = slot, .original = *slot, .owner = structure};
        if (!effect_apply_to(e, effect_add_member(e, group, &v->desc, own))) return false;
    }
    return true;
}

static bool is_taken(const effect *e, const char *group) {
    for (size_t i = 0; i < e->control_count; i++)
        if (is_named(e->controls[i]->face.name, group, NULL)) return true;
    return false;
}

// Numbers the name until nothing else has it. One that has none is not to be set.
static bool add_named(effect *e, effect_control_kind kind, const char **name,
                      const scene_value *values, void *structure) {
    const char *stem = *name;
    if (!stem) return true;
    for (int i = 2; is_taken(e, *name); i++) *name = arena_format(&e->memory, "%s_%d", stem, i);
    return add_values(e, kind, *name, values, structure, NULL);
}

// Of meshes and nodes, which may be many, the first ones.
static bool add_places(effect *e) {
    size_t added = 0;
    for (size_t i = 0; i < e->node_count && added < EFFECT_MAX_PLACES; i++, added++)
        if (!add_named(e, EFFECT_CONTROL_PLACE, &e->nodes[i]->name, scene_node_values, e->nodes[i]))
            return false;
    for (size_t i = 0; i < e->mesh_count && added < EFFECT_MAX_PLACES; i++) {
        scene_mesh *mesh = e->meshes[i];
        if (mesh->repeated) continue;
        added++;
        if (!add_named(e, EFFECT_CONTROL_PLACE, &mesh->called, scene_mesh_values, mesh))
            return false;
    }
    return true;
}

bool scene_control_add_all(effect *e) {
    if (effect_control_of(e, "camera.eye")) return true;
    const scene s = e->scene;
    for (size_t i = 0; i < COUNT_OF(groups); i++)
        if (!add_values(e, EFFECT_CONTROL_SCENE, groups[i].name, groups[i].values,
                        (char *)&e->scene + groups[i].offset, &s))
            return false;
    for (size_t i = 0; i < s.light_count; i++)
        if (!add_named(e, EFFECT_CONTROL_LIGHT, &e->scene.lights[i].name, scene_light_values,
                       &e->scene.lights[i]))
            return false;
    for (size_t i = 0; i < e->material_count; i++)
        if (!add_named(e, EFFECT_CONTROL_MATERIAL, &e->materials[i]->name, scene_material_values,
                       e->materials[i]))
            return false;
    return add_places(e);
}
