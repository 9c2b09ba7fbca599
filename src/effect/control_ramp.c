// Controls of palettes and curves, which settings change in place.
#include "base/error.h"
#include "effect/effect_impl.h"
#include <string.h>

static const char *unique_name(effect *e, const char *stem) {
    const char *name = arena_string(&e->memory, stem);
    for (int i = 2; effect_control_of(e, name); i++)
        name = arena_format(&e->memory, "%s_%d", stem, i);
    return name;
}

static const char *add(effect *e, control own, const char *name) {
    if (e->ramp_count == EFFECT_MAX_RAMPS) return "";
    e->ramp_count++;
    own.face.name = unique_name(e, name);
    own.face.group = "";
    control *c = effect_add_control(e, &own);
    return effect_apply_to(e, c) ? c->face.name : NULL;
}

static const value_desc shown_palette = {
    .type = VALUE_OTHER, .components = 4, .unit = "", .help = "a number to colour and alpha"};

// Of a curve over time, or over a particle's life.
static const value_desc *describe(effect *e, const curve *c, bool over_age) {
    value_desc desc = {.type = VALUE_OTHER,
                       .components = c->components,
                       .unit = "",
                       .help = over_age ? "a number over a particle's life (0..1)"
                                        : "a value over time"};
    return arena_copy(&e->memory, &desc, sizeof desc);
}

const char *effect_add_palette(effect *e, palette *p, const char *name) {
    control own = {.face = {.kind = EFFECT_CONTROL_PALETTE, .desc = &shown_palette},
                   .palette = p,
                   .palette_original = *palette_get_desc(p)};
    return add(e, own, name);
}

const char *effect_add_curve(effect *e, curve *c, const char *name) {
    control own = {.face = {.kind = EFFECT_CONTROL_CURVE, .desc = describe(e, c, false)},
                   .curve = c,
                   .curve_original = *c};
    return add(e, own, name);
}

const char *effect_add_age_curve(effect *e, curve *c, palette *shown, const char *name) {
    control own = {.face = {.kind = EFFECT_CONTROL_CURVE, .desc = describe(e, c, true)},
                   .curve = c,
                   .curve_original = *c,
                   .palette = shown,
                   .palette_original = *palette_get_desc(shown)};
    return add(e, own, name);
}

bool ramp_rename(effect *e, control *c) {
    effect_reset_control(e, c);
    c->face.name = unique_name(e, c->face.name);
    return effect_apply_to(e, c);
}

// ---- setting ----------------------------------------------------------------------------------

// A palette that changes over time, or a blackbody palette, becomes one of plain stops over the
// same range.
static bool set_palette(control *c, const char *text) {
    palette_stop stops[PALETTE_MAX_STOPS];
    palette_key key = {.stops = stops};
    if (!palette_parse(text, stops, &key.count)) return false;
    return palette_replace(c->palette, &(palette_desc){.space = c->palette_original.space,
                                                       .min = c->palette_original.min,
                                                       .max = c->palette_original.max,
                                                       .keys = &key,
                                                       .key_count = 1});
}

static bool show_over_age(const control *c) {
    palette_stop stops[PALETTE_MAX_STOPS];
    palette_key key = {.stops = stops, .count = c->curve->count};
    if (c->curve->shape != CURVE_LINEAR) return err_set("it is linear between its ages");
    for (size_t i = 0; i < key.count; i++) {
        float value = c->curve->keys[i].value[0];
        stops[i] = (palette_stop){c->curve->keys[i].time, {value, value, value, 1}};
    }
    return palette_replace(c->palette, &(palette_desc){.keys = &key, .key_count = 1});
}

static bool replace_over_age(control *c, const curve *desc) {
    curve_key keys[CURVE_MAX_KEYS];
    curve before = *c->curve;
    memcpy(keys, before.keys, before.count * sizeof *keys);
    before.keys = keys;
    if (!curve_replace(c->curve, desc)) return false;
    return show_over_age(c) || (curve_replace(c->curve, &before), false);
}

static bool set_curve(control *c, const char *text) {
    curve_key keys[CURVE_MAX_KEYS];
    curve desc;
    if (!curve_parse(text, keys, &desc)) return false;
    desc.period = c->curve_original.period;
    return c->palette ? replace_over_age(c, &desc) : curve_replace(c->curve, &desc);
}

bool ramp_set(effect *e, control *c, const char *text) {
    (void)e;
    bool done = c->curve ? set_curve(c, text) : set_palette(c, text);
    return done || err_prefix("%s: ", c->face.name);
}

void ramp_reset(effect *e, control *c) {
    (void)e;
    if (!c->face.moved) return;
    if (c->palette) palette_replace(c->palette, &c->palette_original);
    if (c->curve) curve_replace(c->curve, &c->curve_original);
}

// ---- saying -----------------------------------------------------------------------------------

static void print_palette(const palette_desc *desc, strbuf *out) {
    if (desc->blackbody) {
        strbuf_add(out, "blackbody ");
        strbuf_add_float(out, desc->min);
        strbuf_add(out, " ");
        strbuf_add_float(out, desc->max);
        if (!desc->physical) return;
        strbuf_add(out, " physical ");
        strbuf_add_float(out, desc->reference);
        return;
    }
    for (size_t i = 0; i < desc->key_count; i++) {
        const palette_key *key = &desc->keys[i];
        if (desc->key_count > 1) {
            strbuf_add(out, i > 0 ? " | " : "");
            strbuf_add_float(out, key->time);
            strbuf_add(out, ": ");
        }
        palette_print(key->stops, key->count, out);
    }
}

void ramp_print(const effect *e, const control *c, strbuf *out) {
    (void)e;
    if (c->curve)
        curve_print(c->curve, out);
    else
        print_palette(palette_get_desc(c->palette), out);
}
