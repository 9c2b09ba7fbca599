// Pictures that are averaged: over the moments of a shutter, or from frame to frame, with a camera
// that is moved by a part of a pixel and within its lens.
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include <math.h>

enum { ANTIALIAS_PLACES = 16 }; // in a pixel, from frame to frame

// ---- where the camera is moved ----------------------------------------------------------------

uint32_t effect_moments(const effect *e) {
    return e->samples ? e->samples : 1;
}

double effect_moment(const effect *e, double frame) {
    return e->samples ? frame + e->shutter * (e->moment + 0.5) / e->samples : frame;
}

// Digits of a number, mirrored at the point (Halton 1960): fills 0 to 1 evenly.
static float mirrored(uint32_t number, uint32_t base) {
    double sum = 0, part = 1;
    for (; number > 0; number /= base) {
        part /= base;
        sum += part * (number % base);
    }
    return (float)sum;
}

// As path_blackman_harris of lib/path.glsl: a place in a pixel, from its middle, by a filter of 1.5
// pixels whose samples count alike.
static float filtered(float random) {
    static const double share[] = {-0.48829 / 0.35875, 0.14128 / 0.35875, -0.01168 / 0.35875};
    double x = 0.5;
    for (int i = 0; i < 12; i++) {
        double below = x - (double)random, height = 1;
        for (int k = 0; k < 3; k++) {
            const double turns = 2 * (k + 1) * M_PI;
            below += share[k] / turns * sin(turns * x);
            height += share[k] * cos(turns * x);
        }
        x -= fmin(fmax(below / fmax(height, 0.05), -0.1), 0.1);
        x = fmin(fmax(x, 0), 1);
    }
    return (float)(1.5 * (x - 0.5));
}

// Evenly over the disc: Shirley and Chiu, "A low distortion map between disk and square" (1997).
static void on_disc(float u, float v, float out[2]) {
    const float a = 2 * u - 1, b = 2 * v - 1, quarter = (float)M_PI / 4;
    const bool wide = fabsf(a) > fabsf(b);
    const float radius = wide ? a : b;
    const float angle = wide ? quarter * b / a : radius != 0 ? quarter * (2 - a / b) : 0;
    out[0] = radius * cosf(angle);
    out[1] = radius * sinf(angle);
}

// The moments of a frame are Hammersley's points, the time first. From frame to frame the pattern
// repeats, so that what stands still does not flicker. Where frames are gathered, the first of them
// is not moved, for it may be the only one; nor is any where a simulation minds what the camera
// sees, since that is the same whichever frames are drawn.
void effect_move_sight(effect *e, double frame) {
    const bool gathered =
        e->antialiased && e->has_last && !graph_feeds_simulation(e->graph, e->antialias_depth);
    if (e->host.ahead || (!e->samples && !gathered)) return;
    if (e->given.has_view) return; // whose jitter is in its projection
    const uint32_t turn = e->samples ? e->moment + 1 : e->in_a_row % ANTIALIAS_PLACES + 1;
    float picture[2], lens[2] = {0};
    for (int i = 0; i < 2; i++)
        picture[i] = filtered(mirrored(turn, i ? 3 : 2)) / (float)(i ? e->height : e->width);
    if (e->samples) {
        on_disc(mirrored(turn, 5), mirrored(turn, 7), lens);
        e->frame.time.v[3] = (float)turn;
        e->frame.size.v[2] = (uint32_t)llrint(floor(frame)) * e->samples + e->moment;
    }
    scene_move_sight(&e->frame, picture, lens);
}

// ---- what is averaged -------------------------------------------------------------------------

bool effect_add_mean(effect *e, graph_image *image, bool weighted) {
    const float scale = graph_get_desc(e->graph, *image)->scale;
    if (!(scale > 0))
        return err_set("%s: the size of the picture '%s' is fixed, which samples are averaged of",
                       e->facts.file, graph_get_desc(e->graph, *image)->name);
    pass *p = effect_add_pass(e, "mean", NULL, NULL);
    if (!p || !pass_set_image(p, "source", *image) || !pass_set_scale(p, scale) ||
        !pass_set_option(p, "weighted", weighted ? "on" : "off") || !pass_declare(p))
        return false;
    graph_image mean = pass_output(p, "color");
    pass_redirect(&e->host, *image, mean, p);
    *image = mean;
    return true;
}

// The mean of an image; zero: there is none.
static graph_image mean_of(const effect *e, graph_image image) {
    for (size_t i = 0; i < e->pass_count; i++)
        if (pass_is(e->passes[i], "mean") && pass_input(e->passes[i], "source").id == image.id)
            return pass_output(e->passes[i], "color");
    return (graph_image){0};
}

// Returns whether the image is a mean, or made of one.
static bool is_averaged(const effect *e, graph_image image) {
    const pass *writer = pass_writer(&e->host, image);
    if (!writer || pass_is(writer, "mean")) return writer;
    for (size_t i = 0; i < e->pass_count; i++)
        if (pass_is(e->passes[i], "mean") &&
            pass_follows(writer, pass_output(e->passes[i], "color")))
            return true;
    return false;
}

static bool average(effect *e, graph_image *image) {
    if (!image->id || is_averaged(e, *image)) return true;
    graph_image mean = mean_of(e, *image);
    if (!mean.id) return effect_add_mean(e, image, false);
    *image = mean;
    return true;
}

bool effect_set_samples(effect *e, uint32_t samples, double shutter) {
    static const char *const inputs[] = {"source", "bloom"};
    if (e->reference)
        return err_set("samples and a reference exclude each other: that has samples of its own");
    e->samples = samples;
    e->shutter = shutter;
    const size_t count = e->pass_count; // means come after these
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < COUNT_OF(inputs) && pass_is(e->passes[i], "final"); k++) {
            graph_image input = pass_input(e->passes[i], inputs[k]);
            if (!average(e, &input)) return false;
        }
    return average(e, &e->pictures[EFFECT_OUTPUT]) && average(e, &e->pictures[EFFECT_LINEAR]);
}

// ---- what is gathered from frame to frame -----------------------------------------------------

// Passes before an image, the nearest first, until `wanted` takes one. NULL: none does.
static pass *find_before(effect *e, graph_image image, bool (*wanted)(const pass *p)) {
    pass **queue = mem_alloc((e->pass_count + 1) * sizeof *queue), *found = NULL;
    size_t count = 0;
    pass *writer = pass_writer(&e->host, image);
    if (writer) queue[count++] = writer;
    for (size_t i = 0; i < count && !found; i++) {
        const shader_interface *face = pass_interface(queue[i]);
        if (wanted(queue[i])) found = queue[i];
        for (size_t k = 0; k < face->image_count; k++) {
            if (face->images[k].output || face->images[k].history) continue;
            graph_image input = pass_input(queue[i], face->images[k].name);
            pass *p = input.id ? pass_writer(&e->host, input) : NULL;
            bool known = !p || count == e->pass_count;
            for (size_t n = 0; n < count && !known; n++) known = queue[n] == p;
            if (!known) queue[count++] = p;
        }
    }
    mem_free(queue);
    return found;
}

static const char name[] = "antialias";

static bool has_depth(const pass *p) {
    return pass_output(p, "depth").id != 0;
}

static bool has_reach(const pass *p) {
    return pass_is(p, "march");
}

bool effect_set_antialias(effect *e, bool on) {
    static const value_desc desc = {
        .name = name,
        .type = VALUE_BOOL,
        .components = 1,
        .unit = "",
        .help = "edges are smooth: what is seen is gathered over frames, by a pass `antialias`"};
    float value = on;
    if (!effect_add_loaded(e, "effect", &desc, &desc, &value)) return false;
    e->wants_antialias = value != 0;
    return true;
}

bool effect_antialias(effect *e) {
    pass *last = NULL;
    for (size_t i = 0; i < e->pass_count; i++)
        if (pass_is(e->passes[i], "final")) last = e->passes[i];
    if (e->reference || !e->wants_antialias || e->antialiased) return true;
    if (!last)
        return err_set(
            "%s: antialias gathers the picture that a pass `final` takes, and the effect "
            "has none",
            e->facts.file);
    graph_image source = pass_input(last, "source");
    pass *solid = find_before(e, source, has_depth), *volume = find_before(e, source, has_reach);
    pass *p = effect_add_pass(e, "accumulate", NULL, name);
    if (!p || !pass_set_image(p, "source", source)) return false;
    if (solid && !pass_set_image(p, "depth", pass_output(solid, "depth"))) return false;
    if (volume && (!pass_set_image(p, "reach", pass_output(volume, "reach")) ||
                   !pass_set_image(p, "volume", pass_output(volume, "color"))))
        return false;
    // Of surfaces the blurred picture changes by where in a pixel they are looked at.
    static const float none[4];
    if (!volume && !pass_set_uniform(p, "response", field_constant(&e->memory, 1, none)))
        return false;
    if (!pass_declare(p)) return false;
    pass_redirect(&e->host, source, pass_output(p, "color"), p);
    for (int i = 0; i <= EFFECT_LINEAR; i++)
        if (e->pictures[i].id == source.id) e->pictures[i] = pass_output(p, "color");
    e->antialiased = true;
    e->antialias_depth = pass_input(p, "depth");
    return true;
}
