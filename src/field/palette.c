// Palettes. A palette is a table of PALETTE_SIZE texels that depends on the time: every texel mixes
// the stops around its position, for the two keys around the time. Stops are kept as given and in
// the space they are mixed in. A black body does not move in time, its texels are made once.
#include "field/palette.h"
#include "base/error.h"
#include "base/maths.h"
#include "field/color.h"
#include <math.h>
#include <string.h>

typedef struct key_room { // copies of keys; their stops lie one key after the other
    palette_key *keys;
    palette_stop *stops;
} key_room;

struct palette {
    arena *memory;
    palette_desc desc;       // as given, its keys copied
    const palette_key *keys; // the same with colours in desc.space
    float min, max;
    float (*texels)[4];    // of a black body; NULL: none was made yet
    key_room given, mixed; // what replacements are copied to; NULL until the first
    size_t most_stops;     // that they hold
    uint32_t version;
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

static bool find_range(const palette_desc *desc, float *min, float *max) {
    *min = desc->min;
    *max = desc->max;
    if (*min == 0 && *max == 0 && desc->key_count > 0) {
        *min = INFINITY;
        *max = -INFINITY;
    }
    for (size_t i = 0; desc->min == 0 && desc->max == 0 && i < desc->key_count; i++) {
        const palette_key *key = &desc->keys[i];
        *min = fminf(*min, key->stops[0].at);
        *max = fmaxf(*max, key->stops[key->count - 1].at);
    }
    if (isfinite(*min) && isfinite(*max) && *max > *min && isfinite(1 / (*max - *min))) return true;
    return err_set("palette: its range is %g to %g; the end must be greater than the start",
                   (double)*min, (double)*max);
}

static bool palette_check(const palette_desc *desc, float *min, float *max) {
    if (!desc->blackbody && desc->key_count == 0)
        return err_set("palette: no stops; at least two, or blackbody, are needed");
    if (desc->blackbody && desc->key_count > 0)
        return err_set("palette: a black body has no stops of its own");
    return check_keys(desc) && find_range(desc, min, max);
}

static void make_blackbody(palette *p) {
    if (!p->texels) p->texels = arena_alloc(p->memory, PALETTE_SIZE * sizeof *p->texels);
    float reference = p->desc.reference > 0 ? p->desc.reference : 1500;
    for (int i = 0; i < PALETTE_SIZE; i++) {
        float kelvin = mixf(p->min, p->max, ((float)i + 0.5f) / PALETTE_SIZE);
        float ratio = fmaxf(kelvin, 0) / reference;
        float gain = p->desc.physical ? ratio * ratio * ratio * ratio : 1;
        palette_blackbody(kelvin, p->texels[i]);
        for (int c = 0; c < 3; c++) p->texels[i][c] = fminf(p->texels[i][c] * gain, half_max);
        p->texels[i][3] = 1;
    }
}

static size_t count_stops(const palette_desc *desc) {
    size_t count = 0;
    for (size_t i = 0; i < desc->key_count; i++) count += desc->keys[i].count;
    return count;
}

static key_room make_room(arena *memory, size_t keys, size_t stops) {
    return (key_room){arena_alloc(memory, keys * sizeof(palette_key)),
                      arena_alloc(memory, stops * sizeof(palette_stop))};
}

static void copy_keys(key_room to, const palette_desc *desc, palette_space space) {
    palette_stop *stops = to.stops;
    for (size_t i = 0; i < desc->key_count; i++) {
        const palette_key *key = &desc->keys[i];
        to.keys[i] = (palette_key){key->time, stops, key->count};
        for (size_t k = 0; k < key->count; k++, stops++) {
            *stops = key->stops[k];
            if (space == PALETTE_OKLAB) color_to_oklab(key->stops[k].color, stops->color);
        }
    }
}

static void take(palette *p, const palette_desc *desc, key_room given, key_room mixed) {
    copy_keys(given, desc, PALETTE_LINEAR);
    if (desc->space == PALETTE_OKLAB) copy_keys(mixed, desc, PALETTE_OKLAB);
    p->desc = *desc;
    p->desc.keys = given.keys;
    p->keys = desc->space == PALETTE_OKLAB ? mixed.keys : given.keys;
    if (desc->blackbody) make_blackbody(p);
}

palette *palette_create(arena *memory, const palette_desc *desc) {
    float min, max;
    if (!palette_check(desc, &min, &max)) return NULL;
    palette *p = arena_alloc(memory, sizeof *p);
    size_t stops = count_stops(desc);
    *p = (palette){.memory = memory, .min = min, .max = max};
    p->most_stops = stops > PALETTE_MAX_STOPS ? stops : PALETTE_MAX_STOPS;
    bool oklab = desc->space == PALETTE_OKLAB;
    take(p, desc, make_room(memory, desc->key_count, stops),
         oklab ? make_room(memory, desc->key_count, stops) : (key_room){0});
    return p;
}

bool palette_replace(palette *p, const palette_desc *desc) {
    float min, max;
    if (!palette_check(desc, &min, &max)) return false;
    if (count_stops(desc) > p->most_stops)
        return err_set("palette: %zu stops; at most %zu are accepted", count_stops(desc),
                       p->most_stops);
    if (!p->given.keys) {
        p->given = make_room(p->memory, PALETTE_MAX_KEYS, p->most_stops);
        p->mixed = make_room(p->memory, PALETTE_MAX_KEYS, p->most_stops);
    }
    p->min = min;
    p->max = max;
    take(p, desc, p->given, p->mixed);
    p->version++;
    return true;
}

const palette_desc *palette_get_desc(const palette *p) {
    return &p->desc;
}

uint32_t palette_version(const palette *p) {
    return p->version;
}

void palette_range(const palette *p, float *min, float *max) {
    *min = p->min;
    *max = p->max;
}

bool palette_is_animated(const palette *p) {
    return p->desc.key_count > 1;
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
    if (p->desc.space == PALETTE_OKLAB) color_from_oklab(mixed, out);
    for (int c = 0; c < 4; c++) out[c] = clampf(out[c], 0, half_max);
}

static void find_texel(const palette *p, double time, int i, float out[4]) {
    if (p->desc.blackbody) {
        memcpy(out, p->texels[i], 4 * sizeof *out);
        return;
    }
    float at = mixf(p->min, p->max, ((float)i + 0.5f) / PALETTE_SIZE);
    size_t next = 0;
    while (next < p->desc.key_count && (double)p->keys[next].time <= time) next++;
    const palette_key *b = &p->keys[next < p->desc.key_count ? next : p->desc.key_count - 1];
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
