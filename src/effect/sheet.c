// Sheets: passes that see the medium of a march as engines want it. One pass `maps` takes all that
// the march says; the six lights are two passes `lighting` with a rig.
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include "field/kinds.h"
#include "field/palette.h"
#include <string.h>

static const field *field_of(const pass *p, const char *name) {
    size_t index;
    return pass_find_key(p, name, &index) == PASS_FIELD ? pass_get_field(p, index) : NULL;
}

bool effect_is_medium(const pass *p) {
    return pass_is(p, "march") && field_of(p, "density");
}

pass *effect_find_march(effect *e, const char *label) {
    strbuf all = {0};
    for (size_t i = 0; i < e->pass_count; i++) {
        pass *p = e->passes[i];
        if (!effect_is_medium(p)) continue;
        if (!label || strcmp(pass_label(p), label) == 0) {
            strbuf_free(&all);
            return p;
        }
        strbuf_add(&all, "%s%s", all.length ? ", " : "", pass_label(p));
    }
    if (all.length)
        err_set("%s: no pass march is called '%s'; there are: %s", e->facts.file, label,
                strbuf_text(&all));
    else
        err_set("%s: no pass march in it, whose medium could be shown", e->facts.file);
    strbuf_free(&all);
    return NULL;
}

// ---- what the medium does not say by itself ---------------------------------------------------

// What a palette of a black body in an emission is asked for is a temperature.
static const field *find_temperature(const field *node) {
    if (kind_of(node) == KIND_PALETTE && palette_get_desc(node->object)->blackbody)
        return node->args[0];
    for (size_t i = 0; i < kind_arg_count(node); i++) {
        const field *found = node->uniform ? NULL : find_temperature(node->args[i]);
        if (found) return found;
    }
    return NULL;
}

static bool give_temperature(effect *e, const pass *march, pass *maps) {
    const field *emission = field_of(march, "emission");
    if (field_of(march, "temperature")) return true;
    const field *found = emission ? find_temperature(emission) : NULL;
    return found
               ? pass_set_field(maps, "temperature", found)
               : err_set("%s: no temperature is known: neither does pass '%s' say one, nor has its "
                         "emission a palette of a physical black body",
                         e->facts.file, pass_label(march));
}

const field *effect_find_velocity(effect *e, const pass *march) {
    return field_velocity(&e->memory, field_of(march, "density"));
}

static bool give_velocity(effect *e, const pass *march, pass *maps, bool *moves) {
    const field *found = effect_find_velocity(e, march);
    *moves = found;
    return !found || pass_set_field(maps, "velocity", found);
}

// ---- passes -----------------------------------------------------------------------------------

// A pass lighting with lights of its own, for the inputs of `maps` that end so.
static bool add_rig(effect *e, pass *march, pass *maps, const char *rig, const char *end) {
    static const char *const outputs[] = {"lights", "shadow", "glow"};
    pass *p = effect_add_pass(e, "lighting", NULL, NULL);
    pass *lighting = pass_writer(&e->host, pass_input(march, "lights"));
    if (!p) return false;
    pass_add_source(p, march);
    if (lighting && pass_is(lighting, "lighting")) pass_add_source(p, lighting); // how fine it is
    if (!pass_set_option(p, "rig", rig) || !pass_declare(p)) return false;
    for (size_t i = 0; i < COUNT_OF(outputs); i++) {
        char input[16];
        size_t index;
        snprintf(input, sizeof input, "%s_%s", outputs[i], end);
        if (pass_find_key(maps, input, &index) == PASS_IMAGE &&
            !pass_set_image(maps, input, pass_output(p, outputs[i])))
            return false;
    }
    return true;
}

// The march's look, without what stands before it. Its light is that of the scene.
bool effect_take_light(const pass *march, pass *maps) {
    static const char *const inputs[] = {"lights", "shadow", "glow"};
    for (size_t i = 0; i < COUNT_OF(inputs); i++) {
        graph_image image = pass_input(march, inputs[i]);
        if (image.id && !pass_set_image(maps, inputs[i], image)) return false;
    }
    return true;
}

// As the effect's own last pass shows its picture, but for the bloom, which is of the picture.
static bool add_final(effect *e, graph_image source, graph_image *out) {
    pass *last = NULL;
    for (size_t i = 0; i < e->pass_count; i++)
        if (pass_is(e->passes[i], "final")) last = e->passes[i];
    pass *p = effect_add_pass(e, "final", NULL, NULL);
    if (!p) return false;
    if (last) {
        graph_image exposure = pass_input(last, "exposure");
        pass_add_source(p, last);
        if (exposure.id && !pass_set_image(p, "exposure", exposure)) return false;
    }
    if (!pass_set_image(p, "source", source) || !pass_declare(p)) return false;
    *out = pass_output(p, "color");
    return true;
}

// Of the moments of a frame the mean is shown.
static bool average_maps(effect *e, graph_image images[EFFECT_MAPS]) {
    for (int i = 0; e->samples && i < EFFECT_MAPS; i++) {
        const bool weighted =
            i == EFFECT_MAP_MOTION || i == EFFECT_MAP_NORMAL || i == EFFECT_MAP_HEAT;
        if (images[i].id && !effect_add_mean(e, &images[i], weighted)) return false;
    }
    return true;
}

bool effect_add_sheet(effect *e, const effect_sheet_desc *desc, effect_sheet *out) {
    static const char *const names[EFFECT_MAPS] = {
        [EFFECT_MAP_COLOR] = "color",
        [EFFECT_MAP_MOTION] = "motion",
        [EFFECT_MAP_RIGHT_TOP_BACK] = "right_top_back",
        [EFFECT_MAP_LEFT_BOTTOM_FRONT] = "left_bottom_front",
        [EFFECT_MAP_EMISSION] = "emission_seen",
        [EFFECT_MAP_NORMAL] = "normal",
        [EFFECT_MAP_HEAT] = "heat",
    };
    const bool *wanted = desc->wanted;
    *out = (effect_sheet){0};
    pass *march = effect_find_march(e, desc->source), *maps = NULL;
    if (!march) return false;
    out->source = pass_label(march);
    if (!effect_medium_box(e, field_of(march, "density"), desc->first, desc->last, &out->box))
        return false;
    maps = effect_add_pass(e, "maps", NULL, NULL);
    if (!maps) return false;
    pass_add_source(maps, march);
    if (!effect_take_light(march, maps) ||
        (wanted[EFFECT_MAP_MOTION] && !give_velocity(e, march, maps, &out->moves)) ||
        (desc->temperature && !give_temperature(e, march, maps)) ||
        (wanted[EFFECT_MAP_NORMAL] && !pass_set_option(maps, "normals", "on")) ||
        (wanted[EFFECT_MAP_RIGHT_TOP_BACK] && !add_rig(e, march, maps, "right_top_back", "a")) ||
        (wanted[EFFECT_MAP_LEFT_BOTTOM_FRONT] &&
         !add_rig(e, march, maps, "left_bottom_front", "b")) ||
        (wanted[EFFECT_MAP_EMISSION] && !add_rig(e, march, maps, "own", "own")) ||
        !pass_declare(maps))
        return false;
    for (int i = 0; i < EFFECT_MAPS; i++)
        if (wanted[i] && names[i] && (i != EFFECT_MAP_MOTION || out->moves))
            out->images[i] = pass_output(maps, names[i]);
    graph_image *color = &out->images[EFFECT_MAP_COLOR];
    if (wanted[EFFECT_MAP_SHOWN]) *color = pass_output(maps, "color");
    return average_maps(e, out->images) &&
           (!wanted[EFFECT_MAP_SHOWN] || add_final(e, *color, &out->images[EFFECT_MAP_SHOWN]));
}

bool effect_repeats(effect *e, const char *source, double seconds, strbuf *why) {
    const pass *p = effect_find_march(e, source);
    const shader_interface *face = p ? pass_interface(p) : NULL;
    const value_desc *declared;
    for (size_t i = 0; face && i < face->field_count; i++) {
        const field *node = pass_get_field(p, i);
        if (node && !field_repeats(node, &e->context, seconds, why)) return false;
    }
    for (size_t i = 0; face && i < face->uniform_count; i++) {
        const field *node = pass_get_uniform(p, i);
        if (!node) node = pass_inherited_uniform(p, i, &declared);
        if (node && !field_repeats(node, &e->context, seconds, why)) return false;
    }
    return face;
}
