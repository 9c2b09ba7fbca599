// Advected fields: what a flow carries, without ever being torn apart by it.
//
// Max and Becker, "Flow visualization using moving textures", 1995: a pattern that is carried along
// is stretched more and more, so there are several, each made anew after every period, and what is
// seen is their blend, in which a pattern weighs nothing when it is replaced. Neyret, "Advected
// textures", 2003, section 3: a plain mean of unlike patterns washes out; divided by the length of
// the weights it keeps its contrast.
//
// Pattern k of N has the age a = (fract(t / period + k / N) - 1/2) period: it is whole when it
// weighs most, half a period before and after. Its weight, sin(pi fract(t / period + k / N)), is
// zero at both ends, and the squares of all weights add up to N / 2 at all times. So
//   value = mean + sqrt(2 / N) sum_k weight_k (value_k(p - a_k v(p)) - mean).
// Ages, weights and seeds do not vary in space: they are numbers for the host. The rest is made of
// "warp" and arithmetic, hence there is nothing to generate, evaluate or bound here.
#include "base/error.h"
#include "base/map.h"
#include "base/memory.h"
#include "field/compose.h"
#include "field/kinds.h"
#include <math.h>
#include <string.h>

enum { VALUE, VELOCITY, PERIOD, MEAN };             // arguments
enum { PHASES, PATH };                              // options
enum { SEED = 4, SEED_STEP = 101, MAX_PHASES = 3 }; // of noises: argument; between two patterns

static const float pi = 3.14159265f;

static field *warp(arena *memory, const field *value, const field *by, const field *amount) {
    const field *args[FIELD_MAX_ARGS] = {value, by, amount};
    return value && by && amount ? field_make(memory, "warp", args, NULL) : NULL;
}

// ---- other seeds ------------------------------------------------------------------------------

typedef struct seeding {
    arena *memory;
    const field *add; // to every seed
    map places;       // node -> place among `made`
    const field *made[4 * FIELD_MAX_ADVECTED];
    uint32_t count, copies;
} seeding;

static bool is_tile(const field *node) {
    return kind_of(node) == KIND_GRID && ((const field_grid *)node->object)->repeats;
}

// A tile has the seed that it was baked with: other parts of it do for other patterns.
static const field *shift(seeding *s, const field *tile) {
    const field_grid *grid = tile->object;
    const float turn[4] = {0.7549f, 0.5698f, 0.4302f}; // of the plastic number: far from ratios
    const float size[4] = {grid->box.max.x - grid->box.min.x, grid->box.max.y - grid->box.min.y,
                           grid->box.max.z - grid->box.min.z};
    field *part = compose_two(s->memory, "mul", s->add, field_constant(s->memory, 3, turn));
    part = compose_two(s->memory, "mul", compose_one(s->memory, "fract", part),
                       field_constant(s->memory, 3, size));
    return warp(s->memory, tile, part, compose_number(s->memory, 1));
}

// The same expression with other seeds; what holds no noise is shared. NULL: too many nodes.
static const field *reseed(seeding *s, const field *node) {
    if (!node->args[0] && !is_tile(node)) return node;
    const uint32_t *place = map_find(&s->places, node, 0);
    if (place) return s->made[*place];
    if (s->count == COUNT_OF(s->made)) return NULL;
    const field *args[FIELD_MAX_ARGS] = {NULL};
    bool noise = strcmp(node->kind->group, "noise") == 0, changed = noise || is_tile(node);
    for (size_t i = 0; i < kind_arg_count(node); i++) {
        args[i] = reseed(s, node->args[i]);
        if (!args[i]) return NULL;
        changed = changed || args[i] != node->args[i];
    }
    const field *result = node;
    if (changed) {
        if (s->copies++ == FIELD_MAX_ADVECTED) return NULL;
        if (noise) args[SEED] = compose_two(s->memory, "add", args[SEED], s->add);
        result = is_tile(node) ? shift(s, node) : field_with_args(s->memory, node, args);
    }
    if (s->count == COUNT_OF(s->made)) return NULL;
    map_set(&s->places, node, 0, s->count);
    s->made[s->count++] = result;
    return result;
}

static const field *seeded(arena *memory, const field *value, const field *add) {
    seeding s = {.memory = memory, .add = add};
    const field *result = add ? reseed(&s, value) : NULL;
    map_free(&s.places);
    if (add && !result)
        err_set("advect: the value is made of too many nodes; advect the noise alone and combine "
                "afterwards (at most %d nodes that hold noise are accepted)",
                FIELD_MAX_ADVECTED);
    return result;
}

// ---- phases -----------------------------------------------------------------------------------

static field *phase(arena *memory, const field *node, int k, int count) {
    const field *mean = node->args[MEAN], *velocity = node->args[VELOCITY];
    field *turns = compose_two(memory, "div", field_time(memory), node->args[PERIOD]);
    turns = compose_two(memory, "add", turns, compose_number(memory, (float)k / (float)count));
    field *part = compose_one(memory, "fract", turns), *cycle = compose_one(memory, "floor", turns);
    field *back = compose_two(memory, "mul", node->args[PERIOD],
                              compose_two(memory, "sub", compose_number(memory, 0.5f), part));
    if (node->options[PATH] == 1) { // the velocity half way back: the midpoint rule
        field *half = compose_two(memory, "mul", back, compose_number(memory, 0.5f));
        velocity = warp(memory, velocity, velocity, half);
    }
    field *index = compose_two(
        memory, "add", compose_two(memory, "mul", cycle, compose_number(memory, (float)count)),
        compose_number(memory, (float)k));
    const field *value =
        seeded(memory, node->args[VALUE],
               compose_two(memory, "mul", index, compose_number(memory, SEED_STEP)));
    field *weight =
        compose_one(memory, "sin", compose_two(memory, "mul", part, compose_number(memory, pi)));
    weight = compose_two(memory, "mul", weight, compose_number(memory, sqrtf(2 / (float)count)));
    return compose_two(memory, "mul", weight,
                       compose_two(memory, "sub", warp(memory, value, velocity, back), mean));
}

field *field_advect(arena *memory, const field *node) {
    int count = node->options[PHASES] == 0 ? 2 : MAX_PHASES;
    field *sum = NULL;
    for (int k = 0; k < count; k++)
        sum = compose_two(memory, "add", k == 0 ? node->args[MEAN] : sum,
                          phase(memory, node, k, count));
    if (sum) sum->velocity = node->args[VELOCITY];
    return sum;
}
