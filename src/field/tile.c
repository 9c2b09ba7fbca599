// Tiles: an expression of noises as one that repeats, to be baked once and sampled anywhere.
//
// The tile has a space of its own, in which its side is `cells` long and a cell of its first noise
// 1: a point q of it is (p + drift) * frequency. So drift and frequency are where a sample is
// taken, not what the tile holds, and may move without a new bake. In that space every noise gets a
// period that fits (noise.glsl: the lattice repeats), and lengths (the amount of a warp, the step
// of paper's curl) are multiplied by the frequency. What changes the shape of a noise (speed, w,
// seed, power ...) is in the tile, and so makes it anew when it moves.
//
// The octaves of a noise that stands alone are alike but for their seeds: the tile holds the first,
// or a few, and the others are samples of the same tile, scaled, and moved by parts of it that have
// no simple ratio. A tile with all octaves would need as many texels for a cell of the last one:
// 2^3 times as many for each octave more. In an expression of several noises, and where the
// lacunarity is part of the result (steps of paper's curl), all octaves are in the tile.
#include "base/error.h"
#include "base/map.h"
#include "field/compose.h"
#include "field/kinds.h"
#include <math.h>
#include <string.h>

enum { FREQUENCY, OCTAVES, PERSISTENCE, LACUNARITY, SEED, AMPLITUDE, DRIFT, PHASE, W, PERIOD };
enum { STEP = 10, MODE = 0, PAPER = 1 }; // of "curl": argument, option, word
enum { MOST_NODES = 1024 };              // that can be rewritten

typedef struct tiling {
    arena *memory;
    field_tile *tile;
    map places; // node -> place among `made`
    const field *made[MOST_NODES];
    uint32_t count;
} tiling;

static bool is_noise(const field *node) {
    return strcmp(node->kind->group, "noise") == 0;
}

static bool is(const field *node, const char *kind) {
    return strcmp(node->kind->name, kind) == 0;
}

static bool equal(const field *a, const field *b) {
    return a == b || (kind_of(a) == KIND_CONSTANT && kind_of(b) == KIND_CONSTANT &&
                      a->components == b->components &&
                      memcmp(a->value, b->value, (size_t)a->components * sizeof *a->value) == 0);
}

// Rates are products with the time, made anew for each noise.
static bool equal_rate(const field *a, const field *b) {
    if (equal(a, b)) return true;
    if (kind_of(a) != KIND_MUL || kind_of(b) != KIND_MUL) return false;
    for (int i = 0; i < 2; i++)
        if (!equal(a->args[i], b->args[i]) &&
            !(kind_of(a->args[i]) == KIND_TIME && kind_of(b->args[i]) == KIND_TIME))
            return false;
    return true;
}

static const field *first_noise(const field *node) {
    if (node->uniform || is_noise(node)) return node->uniform ? NULL : node;
    for (size_t i = 0; i < kind_arg_count(node); i++) {
        const field *found = first_noise(node->args[i]);
        if (found) return found;
    }
    return NULL;
}

// ---- what the tile holds ----------------------------------------------------------------------

// Lattice cells of a noise along the side of the tile: a whole number, for simplex a multiple of 3.
static const field *cells_of(tiling *t, const field *noise) {
    arena *memory = t->memory;
    float cells = t->tile->cells, unit = is(noise, "simplex") ? 3 : 1;
    if (equal(noise->args[FREQUENCY], t->tile->frequency))
        return compose_number(memory, unit * fmaxf(floorf(cells / unit + 0.5f), 1));
    field *ratio = compose_two(memory, "div", noise->args[FREQUENCY], t->tile->frequency);
    ratio = compose_two(memory, "mul", ratio, compose_number(memory, cells / unit));
    ratio = compose_one(memory, "floor",
                        compose_two(memory, "add", ratio, compose_number(memory, 0.5f)));
    ratio = compose_two(memory, "max", ratio, compose_number(memory, 1));
    return compose_two(memory, "mul", ratio, compose_number(memory, unit));
}

// In the unit of the tile. NULL with a message.
static const field *scaled(tiling *t, const field *length) {
    return compose_two(t->memory, "mul", length, t->tile->frequency);
}

static const field *close_noise(tiling *t, const field *noise) {
    const field_tile *tile = t->tile;
    const field *args[FIELD_MAX_ARGS];
    memcpy(args, noise->args, sizeof args);
    args[PERIOD] = cells_of(t, noise);
    args[FREQUENCY] =
        compose_two(t->memory, "div", args[PERIOD], compose_number(t->memory, tile->cells));
    if (equal_rate(noise->args[DRIFT], tile->drift))
        args[DRIFT] = field_constant(t->memory, 3, (const float[4]){0});
    else
        args[DRIFT] = scaled(t, compose_two(t->memory, "sub", noise->args[DRIFT], tile->drift));
    if (is(noise, "curl")) args[STEP] = scaled(t, noise->args[STEP]);
    if (tile->samples > 1) args[OCTAVES] = compose_number(t->memory, (float)tile->octaves);
    if (tile->alone) args[AMPLITUDE] = compose_number(t->memory, 1);
    for (size_t i = 0; i < kind_arg_count(noise); i++)
        if (!args[i]) return NULL;
    return field_make(t->memory, noise->kind->name, args, noise->options);
}

static const field *close(tiling *t, const field *node);

static const field *close_operator(tiling *t, const field *node) {
    const field *args[FIELD_MAX_ARGS] = {NULL};
    for (size_t i = 0; i < kind_arg_count(node); i++)
        if (!(args[i] = close(t, node->args[i]))) return NULL;
    if (kind_of(node) == KIND_WARP && !(args[2] = scaled(t, args[2]))) return NULL;
    return field_with_args(t->memory, node, args);
}

static const field *close(tiling *t, const field *node) {
    if (node->uniform) return node;
    const uint32_t *place = map_find(&t->places, node, 0);
    if (place) return t->made[*place];
    const field *made;
    if (is_noise(node)) {
        made = close_noise(t, node);
    } else if (kind_of(node) == KIND_TRANSFORM || node->kind->spatial) {
        err_set("tile: '%s' does not repeat; noises and what is computed of them are accepted",
                node->kind->name);
        return NULL;
    } else {
        made = close_operator(t, node);
    }
    if (made && t->count == MOST_NODES)
        return ERR_NULL("tile: more than %d operations", MOST_NODES);
    if (!made) return NULL;
    map_set(&t->places, node, 0, t->count);
    return t->made[t->count++] = made;
}

// Samples that make all octaves, of so many each; 1: the tile holds all that there are.
static int count_samples(const field *noise, int octaves) {
    bool fixed = kind_of(noise->args[OCTAVES]) == KIND_CONSTANT;
    if (!fixed || (is(noise, "curl") && noise->options[MODE] == PAPER)) return 1;
    return ((int)(noise->args[OCTAVES]->value[0] + 0.5f) + octaves - 1) / octaves;
}

bool field_tile_create(arena *memory, const field *node, float cells, int octaves,
                       field_tile *out) {
    const field *noise = first_noise(node);
    if (!noise) return err_set("tile: there is no noise in it");
    *out = (field_tile){
        .noise = noise,
        .cells = cells,
        .frequency = noise->args[FREQUENCY],
        .drift = noise->args[DRIFT],
        .alone = node == noise,
        .samples = node == noise ? count_samples(noise, octaves) : 1,
        .octaves = octaves,
    };
    tiling t = {.memory = memory, .tile = out};
    out->content = close(&t, node);
    map_free(&t.places);
    return out->content != NULL;
}

// ---- where it is sampled ----------------------------------------------------------------------

// Sample i: at (p + drift) * frequency * lacunarity^(i octaves) + i * apart.
static field *place_sample(arena *memory, const field_tile *tile, const field *baked, int i) {
    const field *noise = tile->noise, *frequency = tile->frequency, *drift = tile->drift;
    if (i > 0) {
        const float turn[3] = {0.7549f, 0.5698f, 0.4302f}; // of the plastic number: far from ratios
        float apart[4] = {0};
        for (int c = 0; c < 3; c++) apart[c] = (float)i * turn[c] * tile->cells;
        field *factor = compose_two(memory, "pow", noise->args[LACUNARITY],
                                    compose_number(memory, (float)(i * tile->octaves)));
        frequency = compose_two(memory, "mul", frequency, factor);
        field *moved = compose_two(memory, "div", field_constant(memory, 3, apart), frequency);
        drift = compose_two(memory, "add", drift, moved);
    }
    const field *scale = compose_two(memory, "div", compose_number(memory, 1), frequency);
    const field *args[FIELD_MAX_ARGS] = {baked, compose_one(memory, "negate", drift), NULL, scale};
    return args[1] && scale ? field_make(memory, "transform", args, NULL) : NULL;
}

// Sample i: persistence^(i octaves), over the sum of all.
static field *weight_of(arena *memory, const field_tile *tile, int i) {
    const field *persistence = tile->noise->args[PERSISTENCE];
    field *total = compose_number(memory, 1);
    for (int k = 1; k < tile->samples; k++)
        total = compose_two(memory, "add", total,
                            compose_two(memory, "pow", persistence,
                                        compose_number(memory, (float)(k * tile->octaves))));
    field *own =
        compose_two(memory, "pow", persistence, compose_number(memory, (float)(i * tile->octaves)));
    return compose_two(memory, "div", own, total);
}

field *field_tile_sample(arena *memory, const field_tile *tile, const field *baked) {
    field *sum = NULL;
    for (int i = 0; i < tile->samples; i++) {
        field *sample = place_sample(memory, tile, baked, i);
        if (tile->samples > 1)
            sample = compose_two(memory, "mul", weight_of(memory, tile, i), sample);
        sum = i == 0 ? sample : compose_two(memory, "add", sum, sample);
    }
    const field *amplitude = tile->noise->args[AMPLITUDE];
    if (tile->alone && !equal(amplitude, compose_number(memory, 1)))
        sum = compose_two(memory, "mul", amplitude, sum);
    return sum;
}
