// An effect as a layer of a host's picture: its medium alone, seen by the host's camera, behind the
// host's walls and in the host's light. The host composes it.
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include <string.h>

// ---- what the host says -----------------------------------------------------------------------

bool effect_set_view(effect *e, const scene_view *view) {
    scene_lens lens;
    if (view && !scene_view_lens(view, &lens)) return false;
    e->given.has_view = view != NULL;
    if (view) e->given.view = *view;
    return true;
}

bool effect_has_view(const effect *e) {
    return e->given.has_view;
}

bool effect_set_lights(effect *e, const struct light_entry *lights, size_t count) {
    if (count > e->scene.light_count + 1)
        return err_set(
            "%s: %zu lights besides the sun; the effect is made for %zu (`lights` of the "
            "effect declares them)",
            e->facts.file, count - 1, e->scene.light_count);
    e->given.has_lights = count > 0;
    memset(&e->given.lights, 0, sizeof e->given.lights);
    e->given.lights.count.v[0] = (uint32_t)e->scene.light_count + 1;
    for (size_t i = 0; i <= e->scene.light_count; i++)
        e->given.lights.lights[i].color.v[3] = i ? LIGHT_POINT : LIGHT_SUN;
    if (count) memcpy(e->given.lights.lights, lights, count * sizeof *lights);
    return true;
}

void effect_give_depth(effect *e, gpu_image *depth) {
    scene_lens lens;
    e->host.given_depth = NULL;
    if (!depth || !e->given.has_view || !scene_view_lens(&e->given.view, &lens)) return;
    e->host.given_depth = depth;
    memcpy(e->host.given_depths, lens.depths, sizeof e->host.given_depths);
}

void effect_around_frame(effect *e, bool (*begin)(void *user), bool (*end)(void *user, bool done),
                         void *user) {
    e->given.begin = begin;
    e->given.end = end;
    e->given.user = user;
}

// ---- in a frame -------------------------------------------------------------------------------

static void give_sun(const struct light_entry *sun, struct frame_block *out) {
    memcpy(out->sun_direction.v, sun->position.v, 3 * sizeof(float));
    for (int i = 0; i < 3; i++) out->sun_radiance.v[i] = sun->color.v[i] / GLM_PIf;
}

bool effect_fill_frame(effect *e, struct frame_block *out) {
    const uint32_t size[2] = {e->width ? e->width : 1, e->height ? e->height : 1};
    if (!scene_fill_frame(&e->scene, &e->context, (float)size[0] / (float)size[1], out))
        return false;
    if (e->given.has_view) scene_view_fill(&e->given.view, size, out);
    if (e->given.has_lights) give_sun(&e->given.lights.lights[0], out);
    return true;
}

bool effect_fill_lights(effect *e, struct light_block *out) {
    if (!e->given.has_lights) return scene_fill_lights(&e->scene, &e->context, out);
    *out = e->given.lights;
    return true;
}

// ---- passes -----------------------------------------------------------------------------------

enum { MOST_MEDIA = 3 }; // that `media` composes

typedef struct medium {
    pass *march; // the effect's own
    pass *seen;  // the march before the host's walls
    const field *velocity;
} medium;

static bool has(const medium *all, size_t count, const pass *march) {
    for (size_t i = 0; i < count; i++)
        if (all[i].march == march) return true;
    return false;
}

static void mark_writer(const effect *e, graph_image image, bool *shown) {
    const pass *p = image.id ? pass_writer(&e->host, image) : NULL;
    for (size_t i = 0; p && i < e->pass_count; i++) shown[i] = shown[i] || e->passes[i] == p;
}

// Marches that the effect's picture shows as they are, the last one first. What is not laid over a
// picture may only count or colour what another one shows.
static size_t find_shown(effect *e, medium *all) {
    static const char *const inputs[] = {"volume", "source"}, *const types[] = {
                                                                  "over", "accumulate", "final"};
    size_t count = 0;
    bool *shown = mem_alloc(e->pass_count + 1); // each reads what those before it write
    mark_writer(e, e->pictures[EFFECT_OUTPUT], shown);
    for (size_t i = e->pass_count; i-- > 0;) {
        pass *p = e->passes[i];
        if (shown[i] && effect_is_medium(p) && count < MOST_MEDIA) all[count++].march = p;
        for (size_t k = 0; k < COUNT_OF(types) * COUNT_OF(inputs) && shown[i]; k++)
            if (pass_is(p, types[k / COUNT_OF(inputs)]))
                mark_writer(e, pass_input(p, inputs[k % COUNT_OF(inputs)]), shown);
    }
    mem_free(shown);
    return count;
}

static size_t find_media(effect *e, const char *source, medium *all) {
    const size_t count = source ? 0 : find_shown(e, all);
    if (count > 0) return count;
    all[0].march = effect_find_march(e, source);
    return all[0].march ? 1 : 0;
}

// What a host would miss besides the media: surfaces, sprites, and other media.
static void tell_what_is_left_out(const effect *e, const medium *all, size_t count) {
    static const char *const types[] = {"march",  "stack",    "splats",  "shell",
                                        "pieces", "geometry", "forward", "point_light_glows"};
    strbuf left = {0}, shown = {0};
    for (size_t i = 0; i < e->pass_count; i++)
        for (size_t k = 0; k < COUNT_OF(types) && !has(all, count, e->passes[i]); k++)
            if (pass_is(e->passes[i], types[k]))
                strbuf_add(&left, "%s'%s'", left.length ? ", " : "", pass_label(e->passes[i]));
    for (size_t i = 0; i < count; i++)
        strbuf_add(&shown, "%s'%s'", i ? ", " : "", pass_label(all[i].march));
    if (left.length)
        log_write(LOG_WARNING, "%s: a layer shows the medium of %s alone; it leaves out %s",
                  e->facts.file, strbuf_text(&shown), strbuf_text(&left));
    strbuf_free(&left);
    strbuf_free(&shown);
}

static pass *add_depth(effect *e) {
    pass *p = effect_add_pass(e, "host_depth", NULL, NULL);
    return p && pass_declare(p) ? p : NULL;
}

// Motion is found sample by sample where the medium has one of its own, by `maps`.
static bool add_medium(effect *e, medium *m, const pass *depth, float scale) {
    m->seen = effect_add_pass(e, m->velocity ? "maps" : "march", NULL, NULL);
    if (!m->seen) return false;
    pass_add_source(m->seen, m->march);
    return pass_set_scale(m->seen, scale) && effect_take_light(m->march, m->seen) &&
           (!m->velocity || pass_set_field(m->seen, "velocity", m->velocity)) &&
           pass_set_image(m->seen, "depth", pass_output(depth, "depth")) && pass_declare(m->seen);
}

static bool give_medium(pass *to, const medium *from, char end) {
    static const char *const images[] = {"color", "transmittance", "reach", "edge"};
    char name[32];
    for (size_t i = 0; i < COUNT_OF(images); i++) {
        snprintf(name, sizeof name, "%s_%c", images[i], end);
        if (!pass_set_image(to, name, pass_output(from->seen, images[i]))) return false;
    }
    snprintf(name, sizeof name, "moves_%c", end);
    return !from->velocity || pass_set_image(to, name, pass_output(from->seen, "motion"));
}

// Several as one, with images as a march has them.
static pass *add_media(effect *e, const medium *all, size_t count, float scale) {
    pass *p = effect_add_pass(e, "media", NULL, NULL);
    if (!p || !pass_set_scale(p, scale)) return NULL;
    for (size_t i = 0; i < count; i++)
        if (!give_medium(p, &all[i], (char)('a' + i))) return NULL;
    return pass_declare(p) ? p : NULL;
}

static bool add_reach(effect *e, pass *shown, float scale, effect_layer *out) {
    pass *p = effect_add_pass(e, "layer", NULL, NULL);
    if (!p || !pass_set_scale(p, scale) ||
        !pass_set_image(p, "reach", pass_output(shown, "reach")) ||
        (out->moves && !pass_set_image(p, "moves", pass_output(shown, "motion"))) ||
        !pass_declare(p))
        return false;
    out->images[EFFECT_LAYER_DEPTH] = pass_output(p, "depth");
    out->images[EFFECT_LAYER_MOTION] = pass_output(p, "motion");
    return true;
}

bool effect_add_layer(effect *e, const char *source, bool motion, effect_layer *out) {
    medium all[MOST_MEDIA] = {0};
    const size_t count = find_media(e, source, all);
    float scale = 0; // the finest
    *out = (effect_layer){0};
    if (!count) return false;
    tell_what_is_left_out(e, all, count);
    for (size_t i = 0; i < count; i++) {
        scale = fmaxf(scale, pass_get_scale(all[i].march));
        all[i].velocity = motion ? effect_find_velocity(e, all[i].march) : NULL;
        out->moves = out->moves || all[i].velocity;
    }
    pass *depth = add_depth(e);
    if (!depth) return false;
    for (size_t i = 0; i < count; i++)
        if (!add_medium(e, &all[i], depth, scale)) return false;
    pass *shown = count > 1 ? add_media(e, all, count, scale) : all[0].seen;
    if (!shown || !add_reach(e, shown, scale, out)) return false;
    out->images[EFFECT_LAYER_COLOR] = pass_output(shown, "color");
    out->images[EFFECT_LAYER_TRANSMITTANCE] = pass_output(shown, "transmittance");
    return true;
}
