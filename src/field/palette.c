// Palettes. A palette is a table of PALETTE_SIZE texels that depends on the time: every texel mixes
// the stops around its position, for the two keys around the time. Stops are kept in the space they
// are mixed in. A black body does not move in time, its texels are made once.
#include "field/palette.h"
#include "base/error.h"
#include "base/maths.h"
#include "field/color.h"
#include <math.h>
#include <string.h>

struct palette {
    palette_space space;
    float min, max;
    const palette_key *keys; // colours in `space`
    size_t key_count;
    const float (*texels)[4]; // of a black body, else NULL
};

static const float half_max = 65504;

static bool check_stops(const palette_key *key, size_t number) {
    if (key->count < 2 || key->count > PALETTE_MAX_STOPS)
        return err_set("palette: key %zu has %zu stop%s; 2 to %d are accepted", number, key->count,
                       key->count == 1 ? "" : "s", PALETTE_MAX_STOPS);
    for (size_t i = 0; i < key->count; i++) {
        const palette_stop *stop = &key->stops[i];
        if (!isfinite(stop->at)) return err_set("palette: stop %zu has no finite position", i + 1);
        for (int c = 0; c < 4; c++)
            if (!isfinite(stop->color[c]) || stop->color[c] < 0 || stop->color[c] > half_max)
                return err_set("palette: stop %zu has a colour component of %g; 0..65504 is "
                               "accepted",
                               i + 1, (double)stop->color[c]);
        if (i > 0 && stop->at < key->stops[i - 1].at)
            return err_set("palette: stop %zu at %g lies before stop %zu at %g; positions must "
                           "not fall",
                           i + 1, (double)stop->at, i, (double)key->stops[i - 1].at);
    }
    return true;
}

static bool check_keys(const palette_desc *desc) {
    if (desc->key_count > PALETTE_MAX_KEYS)
        return err_set("palette: %zu keys; at most %d are accepted", desc->key_count,
                       PALETTE_MAX_KEYS);
    for (size_t i = 0; i < desc->key_count; i++) {
        if (!check_stops(&desc->keys[i], i + 1)) return false;
        if (!isfinite(desc->keys[i].time))
            return err_set("palette: key %zu has no finite time", i + 1);
        if (i > 0 && desc->keys[i].time <= desc->keys[i - 1].time)
            return err_set("palette: key %zu at %g s does not come after key %zu at %g s", i + 1,
                           (double)desc->keys[i].time, i, (double)desc->keys[i - 1].time);
    }
    return true;
}

static void find_range(palette *p, const palette_desc *desc) {
    p->min = desc->min;
    p->max = desc->max;
    if (p->min != 0 || p->max != 0 || desc->key_count == 0) return;
    p->min = INFINITY;
    p->max = -INFINITY;
    for (size_t i = 0; i < desc->key_count; i++) {
        const palette_key *key = &desc->keys[i];
        p->min = fminf(p->min, key->stops[0].at);
        p->max = fmaxf(p->max, key->stops[key->count - 1].at);
    }
}

static void make_blackbody(arena *memory, palette *p, const palette_desc *desc) {
    float(*texels)[4] = arena_alloc(memory, PALETTE_SIZE * sizeof *texels);
    float reference = desc->reference > 0 ? desc->reference : 1500;
    for (int i = 0; i < PALETTE_SIZE; i++) {
        float kelvin = mixf(p->min, p->max, ((float)i + 0.5f) / PALETTE_SIZE);
        float ratio = fmaxf(kelvin, 0) / reference;
        float gain = desc->physical ? ratio * ratio * ratio * ratio : 1;
        palette_blackbody(kelvin, texels[i]);
        for (int c = 0; c < 3; c++) texels[i][c] = fminf(texels[i][c] * gain, half_max);
        texels[i][3] = 1;
    }
    p->texels = (const float(*)[4])texels;
}

static void copy_keys(arena *memory, palette *p, const palette_desc *desc) {
    palette_key *keys = arena_copy(memory, desc->keys, desc->key_count * sizeof *keys);
    for (size_t i = 0; i < desc->key_count; i++) {
        size_t size = keys[i].count * sizeof *keys[i].stops;
        palette_stop *stops = arena_copy(memory, keys[i].stops, size);
        for (size_t k = 0; p->space == PALETTE_OKLAB && k < keys[i].count; k++)
            color_to_oklab(desc->keys[i].stops[k].color, stops[k].color);
        keys[i].stops = stops;
    }
    p->keys = keys;
    p->key_count = desc->key_count;
}

palette *palette_create(arena *memory, const palette_desc *desc) {
    if (!desc->blackbody && desc->key_count == 0) {
        err_set("palette: no stops; at least two, or blackbody, are needed");
        return NULL;
    }
    if (desc->blackbody && desc->key_count > 0) {
        err_set("palette: a black body has no stops of its own");
        return NULL;
    }
    if (!check_keys(desc)) return NULL;
    palette *p = arena_alloc(memory, sizeof *p);
    p->space = desc->space;
    find_range(p, desc);
    if (!isfinite(p->min) || !isfinite(p->max) || !(p->max > p->min) ||
        !isfinite(1 / (p->max - p->min))) {
        err_set("palette: its range is %g to %g; the end must be greater than the start",
                (double)p->min, (double)p->max);
        return NULL;
    }
    if (desc->blackbody)
        make_blackbody(memory, p, desc);
    else
        copy_keys(memory, p, desc);
    return p;
}

void palette_range(const palette *p, float *min, float *max) {
    *min = p->min;
    *max = p->max;
}

bool palette_is_animated(const palette *p) {
    return p->key_count > 1;
}

// Colour of one key at a position: a stop holds from its position on, so that of two stops at one
// position the second wins.
static void mix_stops(const palette *p, const palette_key *key, float at, float out[4]) {
    size_t next = 0;
    while (next < key->count && key->stops[next].at <= at) next++;
    const palette_stop *b = &key->stops[next < key->count ? next : key->count - 1];
    const palette_stop *a = next > 0 ? &key->stops[next - 1] : b;
    float t = b->at > a->at ? clampf((at - a->at) / (b->at - a->at), 0, 1) : 0;
    float mixed[4];
    for (int c = 0; c < 4; c++) mixed[c] = mixf(a->color[c], b->color[c], t);
    memcpy(out, mixed, sizeof mixed);
    if (p->space == PALETTE_OKLAB) color_from_oklab(mixed, out);
    for (int c = 0; c < 4; c++) out[c] = clampf(out[c], 0, half_max);
}

static void find_texel(const palette *p, double time, int i, float out[4]) {
    if (p->texels) {
        memcpy(out, p->texels[i], 4 * sizeof *out);
        return;
    }
    float at = mixf(p->min, p->max, ((float)i + 0.5f) / PALETTE_SIZE);
    size_t next = 0;
    while (next < p->key_count && (double)p->keys[next].time <= time) next++;
    const palette_key *b = &p->keys[next < p->key_count ? next : p->key_count - 1];
    const palette_key *a = next > 0 ? &p->keys[next - 1] : b;
    mix_stops(p, a, at, out);
    if (a == b) return;
    float t = (float)((time - (double)a->time) / ((double)b->time - (double)a->time)), other[4];
    mix_stops(p, b, at, other);
    for (int c = 0; c < 4; c++) out[c] = mixf(out[c], other[c], t);
}

void palette_bake(const palette *p, double time, uint16_t out[PALETTE_SIZE * 4]) {
    for (int i = 0; i < PALETTE_SIZE; i++) {
        float texel[4];
        find_texel(p, time, i, texel);
        for (int c = 0; c < 4; c++) out[4 * i + c] = half_from_float(texel[c]);
    }
}

void palette_eval(const palette *p, double time, float at, float out[4]) {
    float x = (at - p->min) / (p->max - p->min) * PALETTE_SIZE - 0.5f;
    x = x > 0 ? fminf(x, PALETTE_SIZE - 1) : 0; // NaN gives the first texel
    int i = (int)x, next = i + 1 < PALETTE_SIZE ? i + 1 : i;
    float a[4], b[4];
    find_texel(p, time, i, a);
    find_texel(p, time, next, b);
    for (int c = 0; c < 4; c++)
        out[c] = mixf(half_to_float(half_from_float(a[c])), half_to_float(half_from_float(b[c])),
                      x - (float)i);
}
