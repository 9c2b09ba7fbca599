// Controls for user interfaces: their descriptions, their values now, palettes and curves.
#include "base/error.h"
#include "base/memory.h"
#include "effect/events.h"
#include "roil/roil_impl.h"
#include <math.h>
#include <string.h>

static const field_context *context_of(const roil_effect *e) { // of the last frame, or the first
    return effect_pass_host(e->effect)->context;
}

// ---- what a control is --------------------------------------------------------------------------

static roil_type type_of(const effect_control *c) {
    static const roil_type types[] = {
        [VALUE_NUMBER] = ROIL_FLOAT, [VALUE_WHOLE] = ROIL_INT,   [VALUE_BOOL] = ROIL_BOOL,
        [VALUE_WORD] = ROIL_ENUM,    [VALUE_COLOR] = ROIL_COLOR,
    };
    if (c->kind == EFFECT_CONTROL_PALETTE) return ROIL_PALETTE;
    if (c->kind == EFFECT_CONTROL_CURVE) return ROIL_CURVE;
    if (c->kind == EFFECT_CONTROL_EVENTS) return ROIL_EVENTS;
    bool vector = c->desc->type == VALUE_NUMBER && c->desc->components > 1;
    return vector ? ROIL_VECTOR : types[c->desc->type];
}

// Value of a field that does not vary in space; `otherwise` where there is none.
static void evaluate(const roil_effect *e, const field *node, const float otherwise[4],
                     float out[4]) {
    memcpy(out, otherwise, 4 * sizeof *out);
    float value[4];
    if (!node || !field_eval(node, context_of(e), (float3){0, 0, 0}, value)) return;
    for (int i = 0; i < 4; i++) out[i] = value[node->components == 1 ? 0 : i];
}

static void fill_field(const roil_effect *e, const effect_control *c, roil_control *out) {
    const scene_camera *camera = &effect_scene(e->effect)->camera;
    const field *now = effect_control_field(e->effect, c);
    float otherwise[4], target[3];
    memcpy(otherwise, effect_control_default(e->effect, c), sizeof otherwise);
    if (strcmp(c->name, "camera.eye") == 0) { // where an orbit has the camera stand
        scene_camera script = *camera;
        script.eye = effect_control_original(c);
        scene_camera_eye(&script, context_of(e), otherwise, target);
        for (int i = 0; i < 3; i++)
            otherwise[i] = roundf(otherwise[i] * 1e6f) / 1e6f + 0.0f; // no -1e-7
    }
    evaluate(e, now, otherwise, out->value);
    evaluate(e, c->moved ? effect_control_original(c) : now, otherwise, out->initial);
    out->driven = now && !field_is_constant(now);
    for (int i = 0; c->kind == EFFECT_CONTROL_UNIFORM && i < 4; i++) { // as passes do
        out->value[i] = clampf(out->value[i], out->min, out->max);
        out->initial[i] = clampf(out->initial[i], out->min, out->max);
    }
}

static void fill_param(const effect_param *p, roil_control *out) {
    out->parameter = true;
    memcpy(out->value, p->value, sizeof out->value);
    memcpy(out->initial, p->desc.value, sizeof out->initial);
    out->log_scale = p->log_scale;
    out->structural = p->structural;
}

static void fill_structure(const roil_effect *e, const effect_control *c, roil_control *out) {
    const pass *p = effect_get_pass(e->effect, c->pass);
    bool scale = c->kind == EFFECT_CONTROL_SCALE;
    out->value[0] = scale ? pass_get_scale(p) : (float)pass_get_option(p, c->index);
    value_parse(c->desc, c->name, c->initial, out->initial);
    out->structural = true;
}

// Returns whether only the first bit of a linear bar would be of use.
static bool is_wide(const value_desc *desc) {
    static const float DECADES = 1e3f, OFTEN = 50;
    bool number = desc->type == VALUE_NUMBER || desc->type == VALUE_WHOLE;
    if (!number || desc->min < 0 || !(desc->max > desc->min) || !isfinite(desc->max)) return false;
    return desc->min > 0 ? desc->max >= DECADES * desc->min
                         : desc->value[0] > 0 && desc->max >= OFTEN * desc->value[0];
}

void roil_get_control(roil_effect *e, size_t index, roil_control *out) {
    const effect_control *c = effect_get_control(e->effect, index);
    const value_desc *desc = c->desc;
    const char *dot = strrchr(c->name, '.');
    bool limited = desc->min != 0 || desc->max != 0 || desc->type == VALUE_WORD;
    *out = (roil_control){
        .name = c->name,
        .label = dot ? dot + 1 : c->name,
        .group = c->group,
        .type = type_of(c),
        .components = desc->components,
        .min = limited ? desc->min : -INFINITY,
        .max = limited ? desc->max : INFINITY,
        .unit = desc->unit,
        .help = desc->help,
        .words = desc->words,
        .word_count = desc->word_count,
        .field = c->kind == EFFECT_CONTROL_FIELD,
        .layer = c->layer,
        .object = c->kind == EFFECT_CONTROL_LIGHT || c->kind == EFFECT_CONTROL_MATERIAL ||
                  c->kind == EFFECT_CONTROL_PLACE || c->kind == EFFECT_CONTROL_LOADED,
        .moved = c->moved};
    if (c->kind == EFFECT_CONTROL_PARAM)
        fill_param(effect_get_param(e->effect, c->index), out);
    else if (c->kind == EFFECT_CONTROL_OPTION || c->kind == EFFECT_CONTROL_SCALE)
        fill_structure(e, c, out);
    else if (desc->type != VALUE_OTHER)
        fill_field(e, c, out);
    if (!out->parameter) out->log_scale = is_wide(desc);
    if (out->field) out->structural = effect_has_tiles(e->effect);
    if (c->kind == EFFECT_CONTROL_LOADED) out->structural = true;
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
    return MEM_CALL(effect_set(e->effect, name, value));
}

bool roil_set_floats(roil_effect *e, size_t control, const float *values, int count) {
    if (control >= effect_control_count(e->effect))
        return err_set("there is no control %zu", control);
    return MEM_CALL(effect_set_numbers(e->effect, control, values, count));
}

bool roil_reset(roil_effect *e, const char *name) {
    return MEM_CALL(effect_reset(e->effect, name));
}

static char *finish(strbuf *text) {
    strbuf_append(text, "", 0); // an empty text is one too
    return text->text;
}

char *roil_control_text(roil_effect *e, const char *name) {
    mem_enter();
    const effect_control *c = effect_find_control(e->effect, name);
    if (!c) return roil_leave_text(NULL);
    strbuf text = {0};
    effect_print_control(e->effect, c, &text);
    return roil_leave_text(finish(&text));
}

// ---- palettes and curves ------------------------------------------------------------------------

static const effect_control *find_kind(roil_effect *e, const char *name, effect_control_kind kind) {
    const effect_control *c = effect_find_control(e->effect, name);
    if (!c || c->kind == kind) return c;
    return ERR_NULL("'%s' is no %s", name, kind == EFFECT_CONTROL_PALETTE ? "palette" : "curve");
}

bool roil_get_palette(roil_effect *e, const char *name, roil_palette *out) {
    mem_enter();
    const effect_control *c = find_kind(e, name, EFFECT_CONTROL_PALETTE);
    if (!c) return mem_leave(false);
    const palette *p = effect_control_palette(c);
    const palette_desc *desc = palette_get_desc(p);
    *out = (roil_palette){.keyed = desc->key_count > 1};
    palette_range(p, &out->min, &out->max);
    if (!desc->key_count) return mem_leave(true);
    out->count = desc->keys[0].count;
    for (size_t i = 0; i < out->count; i++) {
        out->stops[i].at = desc->keys[0].stops[i].at;
        memcpy(out->stops[i].color, desc->keys[0].stops[i].color, sizeof out->stops[i].color);
    }
    return mem_leave(true);
}

bool roil_get_curve(roil_effect *e, const char *name, roil_curve *out) {
    mem_enter();
    const effect_control *control = find_kind(e, name, EFFECT_CONTROL_CURVE);
    if (!control) return mem_leave(false);
    const curve *c = effect_control_curve(control);
    if (c->count > ROIL_MAX_STOPS)
        return mem_leave(
            err_set("%s has %zu keys; at most %d can be edited", name, c->count, ROIL_MAX_STOPS));
    *out = (roil_curve){.count = c->count,
                        .components = c->components,
                        .shape = curve_shape_name(c->shape),
                        .period = c->period,
                        .over_age = effect_control_is_over_age(control)};
    for (size_t i = 0; i < c->count; i++) {
        out->keys[i].time = c->keys[i].time;
        memcpy(out->keys[i].value, c->keys[i].value, sizeof out->keys[i].value);
    }
    return mem_leave(true);
}

bool roil_sample_palette(roil_effect *e, const char *name, double time, float (*out)[4],
                         size_t count) {
    mem_enter();
    const effect_control *c = find_kind(e, name, EFFECT_CONTROL_PALETTE);
    if (!c) return mem_leave(false);
    const palette *p = effect_control_palette(c);
    float min, max;
    palette_range(p, &min, &max);
    for (size_t i = 0; i < count; i++) {
        float share = count > 1 ? (float)i / (float)(count - 1) : 0;
        palette_eval(p, time, mixf(min, max, share), out[i]);
    }
    return mem_leave(true);
}

bool roil_sample_curve(roil_effect *e, const char *name, const double *times, float (*out)[4],
                       size_t count) {
    mem_enter();
    const effect_control *c = find_kind(e, name, EFFECT_CONTROL_CURVE);
    if (!c) return mem_leave(false);
    for (size_t i = 0; i < count; i++) curve_eval(effect_control_curve(c), times[i], out[i]);
    return mem_leave(true);
}

char *roil_palette_text(const roil_palette *p) {
    mem_enter();
    palette_stop stops[ROIL_MAX_STOPS];
    for (size_t i = 0; i < p->count; i++) {
        stops[i].at = p->stops[i].at;
        memcpy(stops[i].color, p->stops[i].color, sizeof stops[i].color);
    }
    strbuf text = {0};
    palette_print(stops, p->count, &text);
    return roil_leave_text(finish(&text));
}

char *roil_curve_text(const roil_curve *c) {
    mem_enter();
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
    return roil_leave_text(finish(&text));
}

// ---- camera and bounds --------------------------------------------------------------------------

static bool get_camera(roil_effect *e, roil_camera *out) {
    const scene_camera *camera = &effect_scene(e->effect)->camera;
    vec3 eye, target;
    float fov[4], height[4];
    if (!scene_camera_eye(camera, context_of(e), eye, target) ||
        !field_eval(camera->fov, context_of(e), (float3){0, 0, 0}, fov) ||
        !field_eval(camera->orthographic, context_of(e), (float3){0, 0, 0}, height))
        return false;
    memcpy(out->eye, eye, sizeof out->eye);
    memcpy(out->target, target, sizeof out->target);
    out->fov = clampf(fov[0], 1, 170);
    out->orthographic = fmaxf(height[0], 0);
    orbit_angles(eye, target, &out->distance, &out->yaw, &out->pitch);
    return true;
}

bool roil_get_camera(roil_effect *e, roil_camera *out) {
    return MEM_CALL(get_camera(e, out));
}

static bool get_bounds(roil_effect *e, float low[3], float high[3]) {
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

bool roil_get_bounds(roil_effect *e, float low[3], float high[3]) {
    return MEM_CALL(get_bounds(e, low, high));
}

bool roil_is_under_ground(roil_effect *e, const float at[3], float *height) {
    return effect_is_under_ground(e->effect, at, height);
}
