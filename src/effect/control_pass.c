// Controls of passes: uniforms ("march.steps"), options ("march.mode"), "march.resolution".
#include "base/error.h"
#include "effect/effect_impl.h"
#include <string.h>

static pass *pass_of(const effect *e, const control *c) {
    return e->passes[c->face.pass];
}

static void add(effect *e, effect_control_kind kind, size_t index, size_t i, const char *name) {
    const char *label = pass_label(e->passes[index]);
    effect_add_control(e,
                       &(control){.face = {.kind = kind,
                                           .name = arena_format(&e->memory, "%s.%s", label, name),
                                           .pass = index,
                                           .index = i}});
}

void pass_control_add_all(effect *e, size_t index) {
    const shader_interface *face = pass_interface(e->passes[index]);
    for (size_t i = 0; i < face->option_count; i++)
        add(e, EFFECT_CONTROL_OPTION, index, i, face->options[i].name);
    for (size_t i = 0; i < face->uniform_count; i++)
        add(e, EFFECT_CONTROL_UNIFORM, index, i, face->uniforms[i].name);
    if (pass_is_scaled(e->passes[index])) add(e, EFFECT_CONTROL_SCALE, index, 0, "resolution");
}

void pass_control_declare(effect *e, control *c) {
    if (c->face.kind == EFFECT_CONTROL_UNIFORM && !c->face.moved)
        c->original = pass_get_uniform(pass_of(e, c), c->face.index);
}

void pass_control_reset(effect *e, control *c) {
    if (c->face.kind == EFFECT_CONTROL_UNIFORM)
        pass_restore_uniform(pass_of(e, c), c->face.index, c->original);
}

// ---- setting ----------------------------------------------------------------------------------

static bool set_uniform(effect *e, control *c, const char *text) {
    const shader_uniform *uniform = &pass_interface(pass_of(e, c))->uniforms[c->face.index];
    float value[4] = {0};
    int count = text_numbers(text, value);
    if (uniform->type == SHADER_ENUM) {
        int word = text_word(uniform->words, uniform->word_count, text);
        if (word < 0)
            return text_wrong_word(uniform->name, text, uniform->words, uniform->word_count);
        value[0] = (float)word;
        count = 1;
    } else if (uniform->type == SHADER_BOOL) {
        if (!text_bool(text, &value[0])) return text_wrong(uniform->name, text, "true, false");
        count = 1;
    } else if (text[0] == '#') {
        if (!palette_parse_color(text, value)) return err_prefix("%s: ", uniform->name);
        count = 3;
    }
    if (!count) return text_wrong(uniform->name, text, "a number, or numbers as 1,2,3");
    int width = count == 2 ? 3 : count; // a field has 1, 3 or 4 components
    if (!pass_set_uniform(pass_of(e, c), uniform->name, control_node(e, c, width, value)))
        return false;
    c->turn = !c->turn;
    return true;
}

bool pass_control_set(effect *e, control *c, const char *text) {
    pass *p = pass_of(e, c);
    float value[4];
    switch (c->face.kind) {
    case EFFECT_CONTROL_UNIFORM:
        return set_uniform(e, c, text);
    case EFFECT_CONTROL_OPTION:
        return pass_set_option(p, pass_interface(p)->options[c->face.index].name, text);
    default:
        if (text_numbers(text, value) != 1)
            return text_wrong("resolution", text, "a number, as 0.25");
        return pass_set_scale(p, value[0]);
    }
}

// ---- saying -----------------------------------------------------------------------------------

static void print_uniform(const pass *p, size_t index, strbuf *out) {
    const shader_uniform *uniform = &pass_interface(p)->uniforms[index];
    const shader_uniform *declared = uniform;
    const field *node = pass_get_uniform(p, index);
    if (!node) node = pass_inherited_uniform(p, index, &declared);
    float value[4];
    memcpy(value, declared->value, sizeof value);
    if (node && !field_is_constant(node)) {
        field_print(node, out);
        return;
    }
    for (int i = 0; node && i < 4; i++) value[i] = node->value[node->components == 1 ? 0 : i];
    if (uniform->type == SHADER_ENUM)
        strbuf_add(out, "%s", uniform->words[(size_t)value[0]]);
    else if (uniform->type == SHADER_BOOL)
        strbuf_add(out, "%s", value[0] != 0 ? "true" : "false");
    else
        text_add_numbers(out, value, pass_uniform_components(uniform->type));
}

void pass_control_print(const effect *e, const control *c, strbuf *out) {
    const pass *p = pass_of(e, c);
    const shader_interface *face = pass_interface(p);
    if (c->face.kind == EFFECT_CONTROL_UNIFORM)
        print_uniform(p, c->face.index, out);
    else if (c->face.kind == EFFECT_CONTROL_OPTION)
        strbuf_add(out, "%s",
                   face->options[c->face.index].words[pass_get_option(p, c->face.index)]);
    else
        strbuf_add_float(out, pass_get_scale(p));
}
