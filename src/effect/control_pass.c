// Controls of passes: uniforms ("march.steps"), options ("march.mode"), "march.resolution".
#include "effect/effect_impl.h"

static void add(effect *e, effect_control_kind kind, size_t index, size_t i,
                const value_desc *desc) {
    control own = {.face = {.kind = kind, .pass = index, .index = i}};
    if (kind == EFFECT_CONTROL_UNIFORM) own.slot = pass_uniform_slot(e->passes[index], i);
    effect_add_member(e, pass_label(e->passes[index]), desc, own);
}

void pass_control_add_all(effect *e, size_t index) {
    const shader_interface *face = pass_interface(e->passes[index]);
    for (size_t i = 0; i < face->option_count; i++)
        add(e, EFFECT_CONTROL_OPTION, index, i, &face->options[i]);
    for (size_t i = 0; i < face->uniform_count; i++)
        add(e, EFFECT_CONTROL_UNIFORM, index, i, &face->uniforms[i]);
    if (pass_is_scaled(e->passes[index])) add(e, EFFECT_CONTROL_SCALE, index, 0, &pass_scale_desc);
}

bool pass_control_set(effect *e, control *c, const char *text) {
    pass *p = e->passes[c->face.pass];
    float value[4];
    if (!value_parse(c->face.desc, c->face.name, text, value)) return false;
    if (c->face.kind == EFFECT_CONTROL_SCALE) return pass_set_scale(p, value[0]);
    return pass_set_option(p, c->face.desc->name, text);
}

void pass_control_print(const effect *e, const control *c, strbuf *out) {
    const pass *p = e->passes[c->face.pass];
    bool scale = c->face.kind == EFFECT_CONTROL_SCALE;
    float value[4] = {scale ? pass_get_scale(p) : (float)pass_get_option(p, c->face.index)};
    value_print(c->face.desc, value, out);
}
