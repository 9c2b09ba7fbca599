// Prints controls as Lua, for "Copy as Lua" and for presets.
#include "base/memory.h"
#include "base/value.h"
#include "base/words.h"
#include "roil/roil_impl.h"
#include <ctype.h>
#include <math.h>
#include <string.h>

static void add_quoted(strbuf *out, const char *text) {
    strbuf_append(out, "\"", 1);
    for (; *text; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\')
            strbuf_add(out, "\\%c", c);
        else if (iscntrl(c))
            strbuf_add(out, "\\%03d", c);
        else
            strbuf_append(out, text, 1);
    }
    strbuf_append(out, "\"", 1);
}

static void add_value(strbuf *out, const float *value, int components, bool color) {
    char hex[8];
    if (components == 1) {
        strbuf_add_float(out, value[0]);
        return;
    }
    if (color && value_color_hex(value, hex)) {
        strbuf_add(out, "\"%s\"", hex);
        return;
    }
    for (int i = 0; i < components; i++) {
        strbuf_add(out, i > 0 ? ", " : "{");
        strbuf_add_float(out, value[i]);
    }
    strbuf_append(out, "}", 1);
}

// ---- palettes and curves ------------------------------------------------------------------------

static void add_number_key(strbuf *out, const char *key, float value) {
    strbuf_add(out, ", %s = ", key);
    strbuf_add_float(out, value);
}

static void add_stops(strbuf *out, const palette_key *key) {
    for (size_t i = 0; i < key->count; i++) {
        const palette_stop *stop = &key->stops[i];
        strbuf_add(out, i > 0 ? ", {" : "{");
        strbuf_add_float(out, stop->at);
        strbuf_add(out, ", ");
        add_value(out, stop->color, 3, true);
        if (stop->color[3] != 1) {
            strbuf_add(out, ", ");
            strbuf_add_float(out, stop->color[3]);
        }
        strbuf_append(out, "}", 1);
    }
}

static void add_palette(strbuf *out, const palette_desc *desc, bool whole) {
    strbuf_add(out, "{ ");
    if (desc->blackbody) {
        strbuf_add(out, "blackbody = ");
        add_value(out, (float[2]){desc->min, desc->max}, 2, false);
        if (desc->physical) strbuf_add(out, ", physical = true");
        if (desc->reference > 0) add_number_key(out, "reference", desc->reference);
        strbuf_add(out, " }");
        return;
    }
    if (desc->key_count > 1) strbuf_add(out, "keys = { ");
    for (size_t i = 0; i < desc->key_count; i++) {
        if (desc->key_count > 1) {
            strbuf_add(out, i > 0 ? ", {" : "{");
            strbuf_add_float(out, desc->keys[i].time);
            strbuf_add(out, ", { ");
        }
        add_stops(out, &desc->keys[i]);
        if (desc->key_count > 1) strbuf_add(out, " }}");
    }
    if (desc->key_count > 1) strbuf_add(out, " }");
    if (whole && desc->space == PALETTE_OKLAB) strbuf_add(out, ", space = \"oklab\"");
    if (whole && (desc->min != 0 || desc->max != 0)) {
        add_number_key(out, "min", desc->min);
        add_number_key(out, "max", desc->max);
    }
    strbuf_add(out, " }");
}

static void add_curve(strbuf *out, const curve *c, bool whole, bool over_age) {
    strbuf_add(out, "{ ");
    for (size_t i = 0; i < c->count; i++) {
        strbuf_add(out, i > 0 ? ", {" : "{");
        strbuf_add_float(out, c->keys[i].time);
        strbuf_add(out, ", ");
        add_value(out, c->keys[i].value, c->components, false);
        strbuf_append(out, "}", 1);
    }
    if (!(whole && over_age)) strbuf_add(out, ", shape = \"%s\"", curve_shape_name(c->shape));
    if (whole && c->period > 0) add_number_key(out, "period", c->period);
    strbuf_add(out, " }");
}

void roil_add_lua_key(const char *name, strbuf *out) {
    static const char *const words[] = {
        "and",      "break",  "do",   "else", "elseif", "end",   "false", "for",
        "function", "goto",   "if",   "in",   "local",  "nil",   "not",   "or",
        "repeat",   "return", "then", "true", "until",  "while",
    };
    bool plain = str_is_identifier(name) && words_find(words, COUNT_OF(words), name) < 0;
    strbuf_add(out, plain ? "%s = " : "[\"%s\"] = ", name);
}

// ---- controls -----------------------------------------------------------------------------------

static void add_control_value(strbuf *out, const roil_control *c, const float value[4]) {
    if (c->type == ROIL_ENUM)
        add_quoted(out, c->words[(size_t)value[0]]);
    else if (c->type == ROIL_BOOL)
        strbuf_add(out, value[0] != 0 ? "true" : "false");
    else
        add_value(out, value, c->components, c->type == ROIL_COLOR);
}

static void find_and_get(const roil_effect *e, const char *name, roil_control *out) {
    size_t index = 0;
    roil_find_control((roil_effect *)(uintptr_t)e, name, &index);
    roil_get_control((roil_effect *)(uintptr_t)e, index, out);
}

void roil_add_lua(const roil_effect *e, const effect_control *c, bool whole, strbuf *out) {
    roil_control control;
    if (c->kind == EFFECT_CONTROL_PALETTE) {
        add_palette(out, palette_get_desc(effect_control_palette(c)), whole);
    } else if (c->kind == EFFECT_CONTROL_CURVE) {
        add_curve(out, effect_control_curve(c), whole, effect_control_is_over_age(c));
    } else if (c->kind == EFFECT_CONTROL_EVENTS) {
        strbuf text = {0};
        effect_print_control(e->effect, c, &text);
        add_quoted(out, strbuf_text(&text));
        strbuf_free(&text);
    } else {
        find_and_get(e, c->name, &control);
        add_control_value(out, &control, control.value);
    }
}

static void add_text_key(strbuf *out, const char *key, const char *text) {
    if (!text[0]) return;
    strbuf_add(out, ", %s = ", key);
    add_quoted(out, text);
}

static void add_words(strbuf *out, const roil_control *c) {
    strbuf_add(out, ", words = {");
    for (size_t i = 0; i < c->word_count; i++) {
        if (i > 0) strbuf_add(out, ", ");
        add_quoted(out, c->words[i]);
    }
    strbuf_append(out, "}", 1);
}

static void add_param(strbuf *out, const roil_control *c, const char *name) {
    bool ranged = c->type != ROIL_ENUM && c->type != ROIL_BOOL;
    char hex[8];
    strbuf_add(out, "param { \"%s\", ", name);
    add_control_value(out, c, c->value);
    if (ranged && isfinite(c->min)) add_number_key(out, "min", c->min);
    if (ranged && isfinite(c->max)) add_number_key(out, "max", c->max);
    if (c->type == ROIL_INT) strbuf_add(out, ", integer = true");
    if (c->type == ROIL_COLOR && !value_color_hex(c->value, hex)) strbuf_add(out, ", color = true");
    if (c->log_scale && c->min > 0) strbuf_add(out, ", log = true");
    if (c->type == ROIL_ENUM) add_words(out, c);
    add_text_key(out, "unit", c->unit);
    if (c->parameter) add_text_key(out, "group", c->group);
    add_text_key(out, "help", c->help);
    strbuf_add(out, " }");
}

void roil_add_param_lua(const roil_effect *e, const effect_control *c, const char *name,
                        strbuf *out) {
    roil_control control;
    find_and_get(e, c->name, &control);
    add_param(out, &control, name);
}

char *roil_control_lua(roil_effect *e, const char *name) {
    mem_enter();
    const effect_control *c = effect_find_control(e->effect, name);
    if (!c) return roil_leave_text(NULL);
    roil_control control;
    find_and_get(e, name, &control);
    strbuf out = {0};
    if (c->kind == EFFECT_CONTROL_PARAM) {
        add_param(&out, &control, control.name);
        return roil_leave_text(out.text);
    }
    if (c->kind == EFFECT_CONTROL_PALETTE)
        strbuf_add(&out, "palette ");
    else if (c->kind == EFFECT_CONTROL_CURVE)
        strbuf_add(&out, effect_control_is_over_age(c) ? "over_age " : "curve ");
    else
        roil_add_lua_key(control.label, &out);
    roil_add_lua(e, c, true, &out);
    return roil_leave_text(out.text);
}
