// Declared parameters.
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include <string.h>

size_t effect_param_count(const effect *e) {
    return e->param_count;
}
const effect_param *effect_get_param(const effect *e, size_t index) {
    return e->params[index];
}

static bool check_value(const effect_param *param, const float value[4]) {
    int wrong = value_find_wrong(&param->desc, value, param->desc.components);
    return wrong < 0 ||
           value_refuse(&param->desc, value[wrong], "parameter '%s'", param->desc.name);
}

bool effect_set_value(effect *e, size_t param, const float value[4]) {
    effect_param *p = e->params[param];
    if (!check_value(p, value)) return false;
    memcpy(p->value, value, sizeof p->value);
    memcpy(e->values[param], value, sizeof p->value);
    return true;
}

bool param_set(effect *e, control *c, const char *text) {
    float value[4];
    return value_parse(c->face.desc, c->face.name, text, value) &&
           effect_set_value(e, c->face.index, value);
}

void param_print(const effect *e, const control *c, strbuf *out) {
    value_print(c->face.desc, e->params[c->face.index]->value, out);
}

int effect_add_param(effect *e, const effect_param *param) {
    const value_desc *desc = &param->desc;
    if (!str_is_identifier(desc->name)) {
        err_set("parameter name '%s' is not a name (letters, digits and _)", desc->name);
        return -1;
    }
    for (size_t i = 0; i < e->param_count; i++) {
        if (strcmp(e->params[i]->desc.name, desc->name) != 0) continue;
        err_set("parameter '%s' is declared twice", desc->name);
        return -1;
    }
    if (!(desc->min <= desc->max)) {
        err_set("parameter '%s': min %g is above max %g", desc->name, (double)desc->min,
                (double)desc->max);
        return -1;
    }
    if (!check_value(param, desc->value)) return -1;
    MEM_RESERVE(e->params, e->param_count + 1, e->param_capacity);
    MEM_RESERVE(e->values, e->param_count + 1, e->value_capacity);
    const size_t index = e->param_count++;
    effect_param *own = e->params[index] = arena_copy(&e->memory, param, sizeof *param);
    memcpy(own->value, desc->value, sizeof own->value);
    memcpy(e->values[index], own->value, sizeof own->value);
    e->context.params = (const float(*)[4])e->values;
    e->context.param_count = e->param_count;
    control *shadowed = effect_control_of(e, desc->name);
    control *c = effect_add_control(e, &(control){.face = {.kind = EFFECT_CONTROL_PARAM,
                                                           .name = own->desc.name,
                                                           .group = own->group,
                                                           .desc = &own->desc,
                                                           .index = index}});
    bool done = (!shadowed || ramp_rename(e, shadowed)) && effect_apply_to(e, c);
    return done ? (int)index : -1;
}

void effect_mark_structural(effect *e, size_t param) {
    e->params[param]->structural = true;
}
