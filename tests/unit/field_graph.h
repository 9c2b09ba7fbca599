// Random graphs of expressions whose parts are shared at every depth.
#pragma once
#include "field_random.h"

enum { GRAPH_MOST_PARTS = 40 };

typedef struct graph { // parts, each of which may be an argument of all later ones
    const field *parts[GRAPH_MOST_PARTS];
    size_t count;
    uint32_t seed;
} graph;

static inline bool graph_chance(graph *g, uint32_t one_in) {
    return random_below(&g->seed, one_in) == 0;
}

// A part of as many components, often one of the last, so that graphs grow deep; or a leaf.
static inline const field *graph_pick(graph *g, int components) {
    for (int tries = 0; tries < 6 && g->count; tries++) {
        size_t back = graph_chance(g, 3) || g->count < 6 ? g->count : 6;
        const field *part = g->parts[g->count - 1 - random_below(&g->seed, (uint32_t)back)];
        if (part->components == components) return part;
        if (part->components == 3 && components == 1) {
            const char *const names[] = {"x", "y", "z"};
            return need_field(
                field_swizzle(build_memory(), part, names[random_below(&g->seed, 3)]));
        }
    }
    return random_leaf(&g->seed, components);
}

static inline const field *graph_palette(graph *g) {
    palette *colors;
    static const palette_stop stops[] = {
        {0, {0, 0.1f, 0.4f, 0}}, {0.3f, {1, 0.5f, 0.2f, 0.6f}}, {1, {2, 1.5f, 1, 1}}};
    const palette_key key = {.stops = stops, .count = COUNT_OF(stops)};
    colors = palette_create(build_memory(), &(palette_desc){.keys = &key, .key_count = 1});
    assert_non_null(colors);
    const field *colored = need_field(field_palette(build_memory(), colors, graph_pick(g, 1)));
    return need_field(field_swizzle(build_memory(), colored, graph_chance(g, 2) ? "rgb" : "a"));
}

// Products decide what is computed where, moved points and vectors what is computed twice.
static inline uint32_t graph_pick_kind(graph *g) {
    static const uint32_t often[] = {KIND_MUL, KIND_MUL, KIND_WARP, KIND_TRANSFORM};
    uint32_t dice = random_below(&g->seed, 10);
    uint32_t end = (uint32_t)(field_kind_find("particle_age") - field_kinds); // 0 here, and on
    while (graph_chance(g, 8) && field_kinds[end].name) end++;
    if (dice < COUNT_OF(often)) return often[dice];
    if (dice < 6) return (uint32_t)(field_kind_find(dice == 4 ? "vec" : "sin") - field_kinds);
    return KIND_WARP + random_below(&g->seed, end - KIND_WARP);
}

// NULL: what was picked does not go together.
static inline const field *graph_part(graph *g) {
    if (graph_chance(g, 20)) return graph_palette(g);
    uint32_t which = graph_pick_kind(g);
    // Its sign is that of a zero, which a device need not keep.
    if (strcmp(field_kinds[which].name, "atan") == 0) return NULL;
    const field_kind *kind = &field_kinds[which];
    const field *args[FIELD_MAX_ARGS] = {NULL};
    uint8_t options[FIELD_MAX_OPTIONS] = {0};
    int any = kind->components ? kind->components : graph_chance(g, 3) ? 3 : 1;
    for (size_t i = 0; i < FIELD_MAX_ARGS && kind->args[i].desc.name; i++) {
        const field_arg *arg = &kind->args[i];
        int width = arg->desc.components          ? arg->desc.components
                    : i > 0 && graph_chance(g, 4) ? 1
                                                  : any;
        if (arg->uniform)
            args[i] = random_uniform(&g->seed, arg);
        else if (arg->desc.required || arg->desc.components == 0 || graph_chance(g, 3))
            args[i] = graph_pick(g, width);
    }
    for (size_t i = 0; i < FIELD_MAX_OPTIONS && kind->options[i].name; i++) {
        uint32_t words = 0;
        while (words < 6 && kind->options[i].words[words]) words++;
        options[i] = (uint8_t)random_below(&g->seed, words);
    }
    return field_make(build_memory(), kind->name, args, options);
}

static inline void graph_grow(graph *g, uint32_t seed) {
    *g = (graph){.seed = seed * 2654435761u + 1};
    size_t wanted = 4 + random_below(&g->seed, GRAPH_MOST_PARTS - 4);
    for (int tries = 0; g->count < wanted && tries < 400; tries++) {
        const field *part = graph_part(g);
        err_clear();
        if (part && part->components != 4) g->parts[g->count++] = part;
    }
}

// The last part of so many components, times an early one or moved by parts, so that factors and
// points share much below.
static inline const field *graph_root(graph *g, int components) {
    const field *last = random_leaf(&g->seed, components);
    for (size_t i = 0; i < g->count; i++)
        if (g->parts[i]->components == components) last = g->parts[i];
    const field *const parts[FIELD_MAX_ARGS] = {graph_pick(g, 1), graph_pick(g, 1),
                                                graph_pick(g, 1)};
    const field *const move[FIELD_MAX_ARGS] = {last,
                                               field_make(build_memory(), "vec", parts, NULL)};
    const field *moved = graph_chance(g, 2) ? NULL : field_make(build_memory(), "warp", move, NULL);
    const field *const factors[FIELD_MAX_ARGS] = {graph_pick(g, 1), moved ? moved : last};
    const field *product =
        graph_chance(g, 3) ? NULL : field_make(build_memory(), "mul", factors, NULL);
    return product ? product : moved ? moved : last;
}
