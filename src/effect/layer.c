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

// What a host would miss besides the medium: surfaces, sprites, and other media.
static void tell_what_is_left_out(const effect *e, const pass *march) {
    static const char *const types[] = {"march",  "stack",    "splats",  "shell",
                                        "pieces", "geometry", "forward", "point_light_glows"};
    strbuf all = {0};
    for (size_t i = 0; i < e->pass_count; i++)
        for (size_t k = 0; k < COUNT_OF(types) && e->passes[i] != march; k++)
            if (pass_is(e->passes[i], types[k]))
                strbuf_add(&all, "%s'%s'", all.length ? ", " : "", pass_label(e->passes[i]));
    if (all.length)
        log_write(LOG_WARNING, "%s: a layer shows the medium of '%s' alone; it leaves out %s",
                  e->facts.file, pass_label(march), strbuf_text(&all));
    strbuf_free(&all);
}

static pass *add_depth(effect *e) {
    pass *p = effect_add_pass(e, "host_depth", NULL, NULL);
    return p && pass_declare(p) ? p : NULL;
}

static bool add_reach(effect *e, pass *medium, bool moves, effect_layer *out) {
    pass *p = effect_add_pass(e, "layer", NULL, NULL);
    if (!p || !pass_set_scale(p, pass_get_scale(medium)) ||
        !pass_set_image(p, "reach", pass_output(medium, "reach")) ||
        (moves && !pass_set_image(p, "moves", pass_output(medium, "motion"))) || !pass_declare(p))
        return false;
    out->images[EFFECT_LAYER_DEPTH] = pass_output(p, "depth");
    out->images[EFFECT_LAYER_MOTION] = pass_output(p, "motion");
    return true;
}

bool effect_add_layer(effect *e, const char *source, bool motion, effect_layer *out) {
    *out = (effect_layer){0};
    pass *march = effect_find_march(e, source);
    if (!march) return false;
    tell_what_is_left_out(e, march);
    const field *velocity = motion ? effect_find_velocity(e, march) : NULL;
    pass *depth = add_depth(e), *medium = NULL;
    if (!depth) return false;
    // Motion is found sample by sample where the medium has one of its own, by `maps`.
    medium = effect_add_pass(e, velocity ? "maps" : "march", NULL, NULL);
    if (!medium) return false;
    pass_add_source(medium, march);
    if (!pass_set_scale(medium, pass_get_scale(march)) || !effect_take_light(march, medium) ||
        (velocity && !pass_set_field(medium, "velocity", velocity)) ||
        !pass_set_image(medium, "depth", pass_output(depth, "depth")) || !pass_declare(medium) ||
        !add_reach(e, medium, velocity, out))
        return false;
    out->images[EFFECT_LAYER_COLOR] = pass_output(medium, "color");
    out->images[EFFECT_LAYER_TRANSMITTANCE] = pass_output(medium, "transmittance");
    out->moves = velocity;
    return true;
}
