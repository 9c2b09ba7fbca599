// Controls of camera, sun and sky. A camera is turned by what it was made of: one that circles its
// target by distance, yaw and pitch, and any by "camera.eye", which makes it stand somewhere.
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include <string.h>

static const scene_value *value_of(const control *c) {
    size_t count;
    return &scene_values(&count)[c->face.index];
}

static const field **slot_of(effect *e, const control *c) {
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
    return true;
}

bool scene_control_set(effect *e, control *c, const char *text) {
    const scene_value *v = value_of(c);
    float value[4] = {0};
    int count = text_numbers(text, value);
    if (text[0] == '#') {
        if (!palette_parse_color(text, value)) return err_prefix("%s: ", v->name);
        count = 3;
    }
    if (count != v->components)
        return text_wrong(v->name, text,
                          v->components == 1 ? "a number"
                          : v->color         ? "#rrggbb or three numbers, as 1,0.5,0.1"
                                             : "three numbers, as 1,0,2.5");
    for (int i = 0; i < count; i++)
        if (!(value[i] >= v->min && value[i] <= v->max))
            return err_set("%s is %g; accepted: %g to %g%s%s", v->name, (double)value[i],
                           (double)v->min, (double)v->max, v->unit[0] ? " " : "", v->unit);
    *slot_of(e, c) = control_node(e, c, count, value);
    c->turn = !c->turn;
    return true;
}

void scene_control_reset(effect *e, control *c) {
    *slot_of(e, c) = c->original;
}

static void print_field(const field *node, bool color, strbuf *out) {
    if (strcmp(node->kind->name, "constant") != 0)
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
