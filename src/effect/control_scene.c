// Controls of camera, sun, sky and lights. A camera is turned by what it was made of: one that
// circles its target by distance, yaw and pitch, and any by "camera.eye", which makes it stand
// somewhere.
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include "scene/material.h"
#include <string.h>

const scene_value *effect_control_value(const effect_control *c) {
    size_t count;
    const scene_value *values = c->kind == EFFECT_CONTROL_LIGHT
                                    ? scene_light_values(SCENE_SPOT, &count)
                                : c->kind == EFFECT_CONTROL_MATERIAL ? scene_material_values(&count)
                                                                     : scene_values(&count);
    return &values[c->index];
}

static const scene_value *value_of(const control *c) {
    return effect_control_value(&c->face);
}

static const field **light_slot(scene_light *light, const scene_value *value) {
    return (const field **)(void *)((char *)light + value->offset);
}

static const field **material_slot(scene_material *material, const scene_value *value) {
    return (const field **)(void *)((char *)material + value->offset);
}

const char *effect_control_owner(const effect *e, const effect_control *c) {
    return c->kind == EFFECT_CONTROL_MATERIAL ? e->materials[c->pass]->name
                                              : e->scene.lights[c->pass].name;
}

static const field **slot_of(effect *e, const control *c) {
    if (c->face.kind == EFFECT_CONTROL_MATERIAL)
        return material_slot(e->materials[c->face.pass], value_of(c));
    if (c->face.kind == EFFECT_CONTROL_LIGHT)
        return light_slot(&e->scene.lights[c->face.pass], value_of(c));
    return scene_slot(&e->scene, value_of(c));
}

const field *effect_control_field(const effect *e, const effect_control *c) {
    if (c->kind == EFFECT_CONTROL_UNIFORM) {
        const shader_uniform *declared;
        const field *own = pass_get_uniform(e->passes[c->pass], c->index);
        return own ? own : pass_inherited_uniform(e->passes[c->pass], c->index, &declared);
    }
    return *slot_of((effect *)(uintptr_t)e, (const control *)c);
}

bool scene_control_unknown(const effect *e, const char *name) {
    static const char *const reasons[] = {
        [SCENE_ORBIT] = "this camera stands at an eye; only an orbit has it",
        [SCENE_GRADIENT] = "this sky is an image; only one of two colours has it",
        [SCENE_IMAGE] = "this sky has no image",
        [SCENE_NIGHT] = "this sky has no night; sky { night = 0 } gives it one",
    };
    size_t count;
    const scene_value *values = scene_values(&count);
    for (size_t i = 0; i < count; i++) {
        if (scene_has(&e->scene, values[i].need) || strcmp(values[i].name, name) != 0) continue;
        err_set("%s: %s", name, reasons[values[i].need]);
        return true;
    }
    return false;
}

// Whether "NAME.something" is said already.
static bool is_taken(const effect *e, const char *name) {
    size_t length = strlen(name);
    for (size_t i = 0; i < e->control_count; i++) {
        const char *other = e->controls[i]->face.name;
        if (strncmp(other, name, length) == 0 && other[length] == '.') return true;
    }
    return false;
}

static bool add_light(effect *e, size_t index) {
    scene_light *light = &e->scene.lights[index];
    const char *stem = light->name;
    if (!stem) return true;
    for (int i = 2; is_taken(e, light->name); i++)
        light->name = arena_format(&e->memory, "%s_%d", stem, i);
    size_t count;
    const scene_value *values = scene_light_values(light->kind, &count);
    for (size_t i = 0; i < count; i++) {
        control own = {
            .face = {.kind = EFFECT_CONTROL_LIGHT,
                     .name = arena_format(&e->memory, "%s.%s", light->name, values[i].name),
                     .pass = index,
                     .index = i},
            .original = *light_slot(light, &values[i]),
        };
        if (!effect_apply_to(e, effect_add_control(e, &own))) return false;
    }
    return true;
}

// Of what the script says of it; the rest is as its mesh has it.
static bool add_material(effect *e, size_t index) {
    scene_material *material = e->materials[index];
    const char *stem = material->name;
    if (!stem) return true;
    for (int i = 2; is_taken(e, material->name); i++)
        material->name = arena_format(&e->memory, "%s_%d", stem, i);
    size_t count;
    const scene_value *values = scene_material_values(&count);
    for (size_t i = 0; i < count; i++) {
        control own = {
            .face = {.kind = EFFECT_CONTROL_MATERIAL,
                     .name = arena_format(&e->memory, "%s.%s", material->name, values[i].name),
                     .pass = index,
                     .index = i},
            .original = *material_slot(material, &values[i]),
        };
        if (own.original && !effect_apply_to(e, effect_add_control(e, &own))) return false;
    }
    return true;
}

bool scene_control_add_all(effect *e) {
    size_t count;
    const scene_value *values = scene_values(&count);
    if (effect_control_of(e, values[0].name)) return true;
    scene s = e->scene; // as the script has it: setting an eye ends an orbit
    for (size_t i = 0; i < count; i++) {
        if (!scene_has(&s, values[i].need)) continue;
        control *c = effect_add_control(
            e,
            &(control){.face = {.kind = EFFECT_CONTROL_SCENE, .name = values[i].name, .index = i},
                       .original = *scene_slot(&e->scene, &values[i])});
        if (!effect_apply_to(e, c)) return false;
    }
    for (size_t i = 0; i < e->scene.light_count; i++)
        if (!add_light(e, i)) return false;
    for (size_t i = 0; i < e->material_count; i++)
        if (!add_material(e, i)) return false;
    return true;
}

bool scene_control_set(effect *e, control *c, const char *text) {
    const scene_value *v = value_of(c);
    float value[4] = {0};
    int count = text_numbers(text, value);
    if (text[0] == '#') {
        if (!palette_parse_color(text, value)) return err_prefix("%s: ", c->face.name);
        count = 3;
    }
    if (count != v->components)
        return text_wrong(c->face.name, text,
                          v->components == 1 ? "a number"
                          : v->color         ? "#rrggbb or three numbers, as 1,0.5,0.1"
                                             : "three numbers, as 1,0,2.5");
    for (int i = 0; i < count; i++)
        if (!(value[i] >= v->min && value[i] <= v->max))
            return err_set("%s is %g; accepted: %g to %g%s%s", c->face.name, (double)value[i],
                           (double)v->min, (double)v->max, v->unit[0] ? " " : "", v->unit);
    *slot_of(e, c) = control_node(e, c, count, value);
    c->turn = !c->turn;
    return true;
}

void scene_control_reset(effect *e, control *c) {
    *slot_of(e, c) = c->original;
}

static void print_field(const field *node, bool color, strbuf *out) {
    if (!field_is_constant(node))
        field_print(node, out);
    else if (color && node->components == 3)
        text_add_color(out, node->value);
    else
        text_add_numbers(out, node->value, node->components);
}

void scene_control_print(const effect *e, const control *c, strbuf *out) {
    const scene_camera *camera = &e->scene.camera;
    const field *node = effect_control_field(e, &c->face);
    if (node) {
        print_field(node, value_of(c)->color, out);
        return;
    }
    const field *const parts[] = {camera->distance, camera->yaw, camera->pitch};
    strbuf_add(out, "orbit"); // where it stands follows from these
    for (size_t i = 0; i < COUNT_OF(parts); i++) {
        strbuf_add(out, " ");
        print_field(parts[i], false, out);
    }
}
