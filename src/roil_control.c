// Controls as an interface shows them: what they are, their values now, palettes and curves.
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include "effect/events.h"
#include "roil_impl.h"
#include "script/reference.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const field_context *context_of(const roil_effect *e) { // of the last frame, or the first
    return effect_pass_host(e->effect)->context;
}

// ---- what a control is --------------------------------------------------------------------------

static bool named_as_color(const char *name) {
    static const char *const endings[] = {"color", "colour", "albedo", "tint"};
    for (size_t i = 0; i < COUNT_OF(endings); i++)
        if (str_ends_with(name, endings[i])) return true;
    return false;
}

static roil_type type_of_uniform(const shader_uniform *u) {
    switch (u->type) {
    case SHADER_INT:
        return ROIL_INT;
    case SHADER_BOOL:
        return ROIL_BOOL;
    case SHADER_ENUM:
        return ROIL_ENUM;
    case SHADER_VEC3:
        return named_as_color(u->name) ? ROIL_COLOR : ROIL_VECTOR;
    case SHADER_VEC2:
    case SHADER_VEC4:
        return ROIL_VECTOR;
    default:
        return ROIL_FLOAT;
    }
}

static void fill_param(const effect_param *p, roil_control *out) {
    static const roil_type types[] = {
        [EFFECT_FLOAT] = ROIL_FLOAT, [EFFECT_INT] = ROIL_INT,     [EFFECT_BOOL] = ROIL_BOOL,
        [EFFECT_ENUM] = ROIL_ENUM,   [EFFECT_VEC3] = ROIL_VECTOR, [EFFECT_COLOR] = ROIL_COLOR,
    };
    out->parameter = true;
    out->type = types[p->type];
    out->components = p->type == EFFECT_VEC3 || p->type == EFFECT_COLOR ? 3 : 1;
    memcpy(out->value, p->value, sizeof out->value);
    memcpy(out->initial, p->initial, sizeof out->initial);
    out->min = p->min;
    out->max = p->max;
    out->unit = p->unit;
    out->help = p->help;
    out->group = p->group;
    out->words = p->words;
    out->word_count = p->word_count;
    out->log_scale = p->log_scale;
    out->structural = p->structural;
}

static bool is_constant(const field *node) {
    return field_is_constant(node);
}

// Value of a field that does not vary in space; `otherwise` where there is none.
static void evaluate(const roil_effect *e, const field *node, const float otherwise[4],
                     float out[4]) {
    memcpy(out, otherwise, 4 * sizeof *out);
    float value[4];
    if (!node || !field_eval(node, context_of(e), (float3){0, 0, 0}, value)) return;
    for (int i = 0; i < 4; i++) out[i] = value[node->components == 1 ? 0 : i];
}

static void fill_moving(const roil_effect *e, const effect_control *c, const float otherwise[4],
                        roil_control *out) {
    const field *now = effect_control_field(e->effect, c);
    evaluate(e, now, otherwise, out->value);
    out->driven = now && !is_constant(now);
    if (c->moved)
        evaluate(e, effect_control_original(c), otherwise, out->initial);
    else
        memcpy(out->initial, out->value, sizeof out->initial);
}

static void clamp_to_range(roil_control *out) { // as passes do
    for (int i = 0; i < 4; i++) {
        out->value[i] = clampf(out->value[i], out->min, out->max);
        out->initial[i] = clampf(out->initial[i], out->min, out->max);
    }
}

static void fill_uniform(const roil_effect *e, const effect_control *c, const pass *p,
                         roil_control *out) {
    const shader_uniform *u = &pass_interface(p)->uniforms[c->index], *declared;
    const field *inherited = pass_inherited_uniform(p, c->index, &declared);
    float otherwise[4];
    evaluate(e, inherited, declared->value, otherwise);
    out->type = type_of_uniform(u);
    out->components = pass_uniform_components(u->type);
    out->min = u->min;
    out->max = u->max;
    out->unit = u->unit;
    out->help = u->help;
    out->words = u->words;
    out->word_count = u->word_count;
    if (u->type == SHADER_BOOL || u->type == SHADER_ENUM) {
        out->min = 0;
        out->max = u->type == SHADER_BOOL ? 1 : (float)u->word_count - 1;
    }
    fill_moving(e, c, otherwise, out);
    clamp_to_range(out);
}

static void fill_scene(const roil_effect *e, const effect_control *c, roil_control *out) {
    static const char *const groups[] = {"camera", "sun", "sky"};
    const scene_value *v = effect_control_value(c);
    if (c->kind != EFFECT_CONTROL_SCENE) out->group = effect_control_owner(e->effect, c);
    for (size_t i = 0; c->kind == EFFECT_CONTROL_SCENE && i < COUNT_OF(groups); i++)
        if (strncmp(v->name, groups[i], strlen(groups[i])) == 0) out->group = groups[i];
    out->type = v->color ? ROIL_COLOR : v->components == 3 ? ROIL_VECTOR : ROIL_FLOAT;
    out->components = v->components;
    out->min = v->min;
    out->max = v->max;
    out->unit = v->unit;
    out->help = v->help;
    float eye[4] = {0}, target[3]; // where an orbit has the camera stand
    scene_camera camera = effect_scene(e->effect)->camera;
    if (strcmp(v->name, "camera.eye") == 0) {
        camera.eye = effect_control_original(c);
        scene_camera_eye(&camera, context_of(e), eye, target);
        for (int i = 0; i < 3; i++) eye[i] = roundf(eye[i] * 1e6f) / 1e6f + 0.0f; // no -1e-7
    }
    fill_moving(e, c, eye, out);
}

static void fill_option(const effect_control *c, const pass *p, roil_control *out) {
    const shader_option *o = &pass_interface(p)->options[c->index];
    out->type = ROIL_ENUM;
    out->value[0] = (float)pass_get_option(p, c->index);
    for (size_t i = 0; i < o->word_count; i++)
        if (strcmp(o->words[i], c->initial) == 0) out->initial[0] = (float)i;
    out->max = (float)o->word_count - 1;
    out->help = o->help;
    out->words = o->words;
    out->word_count = o->word_count;
    out->structural = true;
}

static void fill_scale(const effect_control *c, const pass *p, roil_control *out) {
    out->value[0] = pass_get_scale(p);
    out->initial[0] = str_float(c->initial, NULL);
    out->min = 0.01f;
    out->max = 1;
    out->help = script_key_find(script_object_find("shader")->keys, "resolution")->help;
    out->structural = true;
}

static const char *const ramp_help[] = {"a number to colour and alpha", "a value over time",
                                        "a number over a particle's life (0..1)"};

void roil_get_control(roil_effect *e, size_t index, roil_control *out) {
    const effect_control *c = effect_get_control(e->effect, index);
    const char *dot = strrchr(c->name, '.');
    *out = (roil_control){.name = c->name,
                          .label = dot ? dot + 1 : c->name,
                          .group = "",
                          .unit = "",
                          .help = "",
                          .components = 1,
                          .moved = c->moved != NULL};
    bool of_pass = c->kind == EFFECT_CONTROL_UNIFORM || c->kind == EFFECT_CONTROL_OPTION ||
                   c->kind == EFFECT_CONTROL_SCALE;
    pass *p = of_pass ? effect_get_pass(e->effect, c->pass) : NULL;
    if (p) out->group = pass_label(p);
    switch (c->kind) {
    case EFFECT_CONTROL_PARAM:
        fill_param(effect_get_param(e->effect, c->index), out);
        break;
    case EFFECT_CONTROL_PALETTE:
        out->type = ROIL_PALETTE;
        out->components = 4;
        out->help = ramp_help[0];
        break;
    case EFFECT_CONTROL_CURVE:
        out->type = ROIL_CURVE;
        out->components = effect_control_curve(c)->components;
        out->help = ramp_help[effect_control_is_over_age(c) ? 2 : 1];
        break;
    case EFFECT_CONTROL_SCENE:
    case EFFECT_CONTROL_LIGHT:
    case EFFECT_CONTROL_MATERIAL:
        fill_scene(e, c, out);
        break;
    case EFFECT_CONTROL_EVENTS:
        out->type = ROIL_EVENTS;
        out->components = 0;
        out->group = "effect";
        out->help = "what happens to it: seconds, click or key and its name, where";
        break;
    case EFFECT_CONTROL_UNIFORM:
        fill_uniform(e, c, p, out);
        break;
    case EFFECT_CONTROL_OPTION:
        fill_option(c, p, out);
        break;
    case EFFECT_CONTROL_SCALE:
        fill_scale(c, p, out);
        break;
    }
}

size_t roil_control_count(const roil_effect *e) {
    return effect_control_count(e->effect);
}

bool roil_find_control(roil_effect *e, const char *name, size_t *index) {
    const effect_control *found = effect_find_control(e->effect, name);
    if (!found) return false;
    for (*index = 0; effect_get_control(e->effect, *index) != found;) ++*index;
    return true;
}

bool roil_set(roil_effect *e, const char *name, const char *value) {
    return effect_set(e->effect, name, value);
}

bool roil_reset(roil_effect *e, const char *name) {
    return effect_reset(e->effect, name);
}

static char *finish(strbuf *text) {
    strbuf_append(text, "", 0); // an empty text is one too
    return text->text;
}

char *roil_control_text(roil_effect *e, const char *name) {
    const effect_control *c = effect_find_control(e->effect, name);
    if (!c) return NULL;
    strbuf text = {0};
    effect_print_control(e->effect, c, &text);
    return finish(&text);
}

// ---- palettes and curves ------------------------------------------------------------------------

static const effect_control *find_kind(roil_effect *e, const char *name, effect_control_kind kind) {
    const effect_control *c = effect_find_control(e->effect, name);
    if (!c || c->kind == kind) return c;
    err_set("'%s' is no %s", name, kind == EFFECT_CONTROL_PALETTE ? "palette" : "curve");
    return NULL;
}

bool roil_get_palette(roil_effect *e, const char *name, roil_palette *out) {
    const effect_control *c = find_kind(e, name, EFFECT_CONTROL_PALETTE);
    if (!c) return false;
    const palette *p = effect_control_palette(c);
    const palette_desc *desc = palette_get_desc(p);
    *out = (roil_palette){.keyed = desc->key_count > 1};
    palette_range(p, &out->min, &out->max);
    if (!desc->key_count) return true;
    out->count = desc->keys[0].count;
    for (size_t i = 0; i < out->count; i++) {
        out->stops[i].at = desc->keys[0].stops[i].at;
        memcpy(out->stops[i].color, desc->keys[0].stops[i].color, sizeof out->stops[i].color);
    }
    return true;
}

bool roil_get_curve(roil_effect *e, const char *name, roil_curve *out) {
    const effect_control *control = find_kind(e, name, EFFECT_CONTROL_CURVE);
    if (!control) return false;
    const curve *c = effect_control_curve(control);
    if (c->count > ROIL_MAX_STOPS)
        return err_set("%s has %zu keys; at most %d can be edited", name, c->count, ROIL_MAX_STOPS);
    *out = (roil_curve){.count = c->count,
                        .components = c->components,
                        .shape = curve_shape_name(c->shape),
                        .period = c->period,
                        .over_age = effect_control_is_over_age(control)};
    for (size_t i = 0; i < c->count; i++) {
        out->keys[i].time = c->keys[i].time;
        memcpy(out->keys[i].value, c->keys[i].value, sizeof out->keys[i].value);
    }
    return true;
}

bool roil_sample_palette(roil_effect *e, const char *name, double time, float (*out)[4],
                         size_t count) {
    const effect_control *c = find_kind(e, name, EFFECT_CONTROL_PALETTE);
    if (!c) return false;
    const palette *p = effect_control_palette(c);
    float min, max;
    palette_range(p, &min, &max);
    for (size_t i = 0; i < count; i++) {
        float share = count > 1 ? (float)i / (float)(count - 1) : 0;
        palette_eval(p, time, mixf(min, max, share), out[i]);
    }
    return true;
}

bool roil_sample_curve(roil_effect *e, const char *name, const double *times, float (*out)[4],
                       size_t count) {
    const effect_control *c = find_kind(e, name, EFFECT_CONTROL_CURVE);
    if (!c) return false;
    for (size_t i = 0; i < count; i++) curve_eval(effect_control_curve(c), times[i], out[i]);
    return true;
}

char *roil_palette_text(const roil_palette *p) {
    palette_stop stops[ROIL_MAX_STOPS];
    for (size_t i = 0; i < p->count; i++) {
        stops[i].at = p->stops[i].at;
        memcpy(stops[i].color, p->stops[i].color, sizeof stops[i].color);
    }
    strbuf text = {0};
    palette_print(stops, p->count, &text);
    return finish(&text);
}

char *roil_curve_text(const roil_curve *c) {
    curve_key keys[ROIL_MAX_STOPS];
    curve printed = {.components = c->components, .keys = keys, .count = c->count};
    for (int i = 0; i < CURVE_SHAPE_COUNT; i++)
        if (strcmp(curve_shape_name((curve_shape)i), c->shape) == 0) printed.shape = (curve_shape)i;
    for (size_t i = 0; i < c->count; i++) {
        keys[i].time = c->keys[i].time;
        memcpy(keys[i].value, c->keys[i].value, sizeof keys[i].value);
    }
    strbuf text = {0};
    curve_print(&printed, &text);
    return finish(&text);
}

// ---- camera and bounds --------------------------------------------------------------------------

bool roil_get_camera(roil_effect *e, roil_camera *out) {
    const scene_camera *camera = &effect_scene(e->effect)->camera;
    vec3 eye, target;
    float fov[4];
    if (!scene_camera_eye(camera, context_of(e), eye, target) ||
        !field_eval(camera->fov, context_of(e), (float3){0, 0, 0}, fov))
        return false;
    memcpy(out->eye, eye, sizeof out->eye);
    memcpy(out->target, target, sizeof out->target);
    out->fov = clampf(fov[0], 1, 170);
    return true;
}

bool roil_get_bounds(roil_effect *e, float low[3], float high[3]) {
    box3 all = box3_empty();
    for (size_t i = 0; i < effect_pass_count(e->effect); i++) {
        const pass *p = effect_get_pass(e->effect, i);
        size_t index; // of the field that marches are cut to
        box3 box;
        if (pass_find_key(p, "density", &index) != PASS_FIELD) continue;
        const field *node = pass_get_field(p, index);
        if (node && field_bounds(node, context_of(e), &box) && box3_is_finite(box))
            all = box3_union(all, box);
    }
    if (box3_is_empty(all)) return err_set("no volume of this effect has bounds just now");
    memcpy(low, &all.min, sizeof all.min);
    memcpy(high, &all.max, sizeof all.max);
    return true;
}

bool roil_is_under_ground(roil_effect *e, const float at[3], float *height) {
    return effect_is_under_ground(e->effect, at, height);
}
