// Declared parameters.
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include <math.h>
#include <string.h>

size_t effect_param_count(const effect *e) {
    return e->param_count;
}
const effect_param *effect_get_param(const effect *e, size_t index) {
    return &e->params[index];
}

static int components(effect_param_type type) {
    return type == EFFECT_VEC3 || type == EFFECT_COLOR ? 3 : 1;
}

static bool check_value(const effect_param *param, const float value[4]) {
    for (int i = 0; i < components(param->type); i++) {
        if (isfinite(value[i]) && value[i] >= param->min && value[i] <= param->max) continue;
        return err_set("parameter '%s' is %g; accepted: %g to %g%s%s", param->name,
                       (double)value[i], (double)param->min, (double)param->max,
                       param->unit[0] ? " " : "", param->unit);
    }
    return true;
}

bool effect_set_value(effect *e, size_t param, const float value[4]) {
    effect_param *p = &e->params[param];
    if (!check_value(p, value)) return false;
    memcpy(p->value, value, sizeof p->value);
    memcpy(e->values[param], value, sizeof p->value);
    return true;
}

bool param_set(effect *e, control *c, const char *text) {
    const effect_param *p = &e->params[c->face.index];
    float value[4] = {0};
    int count = text_numbers(text, value);
    switch (p->type) {
    case EFFECT_BOOL:
        if (!text_bool(text, &value[0])) return text_wrong(p->name, text, "true, false");
        break;
    case EFFECT_ENUM: {
        int word = text_word(p->words, p->word_count, text);
        if (word < 0) return text_wrong_word(p->name, text, p->words, p->word_count);
        value[0] = (float)word;
        break;
    }
    case EFFECT_INT:
        if (count != 1 || value[0] != rintf(value[0]))
            return text_wrong(p->name, text, "a whole number");
        break;
    case EFFECT_FLOAT:
        if (count != 1) return text_wrong(p->name, text, "a number");
        break;
    case EFFECT_COLOR:
        if (text[0] == '#') {
            if (!palette_parse_color(text, value)) return err_prefix("%s: ", p->name);
            break;
        }
        if (count != 3) return text_wrong(p->name, text, "#rrggbb or three numbers, as 1,0.5,0.1");
        break;
    case EFFECT_VEC3:
        if (count != 3) return text_wrong(p->name, text, "three numbers, as 1,0,2.5");
        break;
    }
    return effect_set_value(e, c->face.index, value);
}

void param_print(const effect *e, const control *c, strbuf *out) {
    const effect_param *p = &e->params[c->face.index];
    if (p->type == EFFECT_ENUM)
        strbuf_add(out, "%s", p->words[(size_t)p->value[0]]);
    else if (p->type == EFFECT_BOOL)
        strbuf_add(out, "%s", p->value[0] != 0 ? "true" : "false");
    else if (p->type == EFFECT_COLOR)
        text_add_color(out, p->value);
    else
        text_add_numbers(out, p->value, components(p->type));
}

int effect_add_param(effect *e, const effect_param *param) {
    if (!str_is_identifier(param->name)) {
        err_set("parameter name '%s' is not a name (letters, digits and _)", param->name);
        return -1;
    }
    for (size_t i = 0; i < e->param_count; i++) {
        if (strcmp(e->params[i].name, param->name) != 0) continue;
        err_set("parameter '%s' is declared twice", param->name);
        return -1;
    }
    if (!(param->min <= param->max)) {
        err_set("parameter '%s': min %g is above max %g", param->name, (double)param->min,
                (double)param->max);
        return -1;
    }
    if (!check_value(param, param->initial)) return -1;
    MEM_RESERVE(e->params, e->param_count + 1, e->param_capacity);
    MEM_RESERVE(e->values, e->param_count + 1, e->value_capacity);
    effect_param *own = &e->params[e->param_count];
    *own = *param;
    memcpy(own->value, param->initial, sizeof own->value);
    memcpy(e->values[e->param_count], own->value, sizeof own->value);
    e->param_count++;
    e->context.params = (const float(*)[4])e->values;
    e->context.param_count = e->param_count;
    control *shadowed = effect_control_of(e, own->name);
    control *c = effect_add_control(e, &(control){.face = {.kind = EFFECT_CONTROL_PARAM,
                                                           .name = own->name,
                                                           .index = e->param_count - 1}});
    bool done = (!shadowed || ramp_rename(e, shadowed)) && effect_apply_to(e, c);
    return done ? (int)e->param_count - 1 : -1;
}

void effect_mark_structural(effect *e, size_t param) {
    e->params[param].structural = true;
}
