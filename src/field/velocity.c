// How fast what a tree says moves.
//
// A product moves as its first factor that moves: smoke times noise goes where the smoke goes,
// since what the noise does on its way is small against it. Where space is bent by more than a
// displacement (column:warp(place - position)) the velocity would have to be bent too, and nothing
// is said.
#include "base/memory.h"
#include "field/compose.h"
#include "field/kinds.h"

enum { MOST_VISITS = 20000 }; // of nodes: shared ones are visited again

typedef struct search {
    arena *memory;
    int visits;
} search;

static const field *find(search *s, const field *node);

const field *field_of_effect_time(arena *memory, const field_grid *grid, const field *velocity) {
    const float scale[4] = {grid->time_scale};
    if (!(scale[0] > 0) || scale[0] == 1) return velocity;
    return compose_two(memory, "mul", velocity, field_constant(memory, 1, scale));
}

static const field *of_grid(search *s, const field *node) {
    static const char *const names[] = {"velocity", "vel", "v"};
    field_grid *grid = (field_grid *)(uintptr_t)node->object;
    int components, first = -1;
    if (grid->content && !grid->repeats) return find(s, grid->content);
    for (size_t i = 0; i < COUNT_OF(names) && grid->find_field && first < 0; i++)
        first = grid->find_field(grid, names[i], &components);
    return first >= 0 && components == 3
               ? field_of_effect_time(s->memory, grid,
                                      field_grid_channel(s->memory, grid, first, 3))
               : NULL;
}

static const field *of_warp(search *s, const field *node) {
    if (kind_is_displacement(node->args[1])) return NULL;
    const field *args[FIELD_MAX_ARGS] = {find(s, node->args[0]), node->args[1], node->args[2]};
    return args[0] ? field_make(s->memory, "warp", args, NULL) : NULL;
}

// Directions turn and grow with the space, where that stands still.
static const field *of_transform(search *s, const field *node) {
    float rows[3][4], back[3][4];
    const field *args[FIELD_MAX_ARGS] = {find(s, node->args[0]), node->args[1], node->args[2],
                                         node->args[3]};
    if (!args[0]) return NULL;
    for (int i = 1; i < 4; i++)
        if (!field_is_constant(args[i])) return NULL;
    const field *there = field_make(s->memory, "transform", args, NULL);
    kind_transform_matrix(args[1]->value, args[2]->value, args[3]->value, rows, back);
    const field *parts[FIELD_MAX_ARGS] = {NULL};
    for (int i = 0; i < 3; i++)
        parts[i] = compose_two(s->memory, "dot", there, field_constant(s->memory, 3, back[i]));
    return field_make(s->memory, "vec", parts, NULL);
}

static bool is_same(const field *a, const field *b) {
    return a == b || (kind_of(a) == KIND_GRID && kind_of(b) == KIND_GRID &&
                      a->object == b->object && a->index == b->index);
}

static const field *of_sum(search *s, const field *node) {
    const field *a = find(s, node->args[0]), *b = find(s, node->args[1]);
    if (!a || !b || is_same(a, b) || node->components != 1) return a ? a : b;
    const field *weighted =
        compose_two(s->memory, "add", compose_two(s->memory, "mul", a, node->args[0]),
                    compose_two(s->memory, "mul", b, node->args[1]));
    return compose_two(s->memory, "div", weighted, node);
}

static const field *find(search *s, const field *node) {
    if (node->velocity) return node->velocity;
    if (s->visits++ > MOST_VISITS || node->uniform) return NULL;
    switch (kind_of(node)) {
    case KIND_GRID:
        return of_grid(s, node);
    case KIND_WARP:
        return of_warp(s, node);
    case KIND_TRANSFORM:
        return of_transform(s, node);
    case KIND_ADD:
        return of_sum(s, node);
    default:
        break;
    }
    for (size_t i = 0; i < kind_arg_count(node); i++) {
        const field *found = find(s, node->args[i]);
        if (found) return found;
    }
    return NULL;
}

const field *field_velocity(arena *memory, const field *node) {
    search s = {.memory = memory};
    return find(&s, node);
}
