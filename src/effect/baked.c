// Fields baked to grids: a grid whose image is filled by a pass "bake" of the effect.
#include "base/error.h"
#include "effect/effect_impl.h"
#include <math.h>

typedef struct effect_baked { // grid first: a field_grid that a pass fills
    field_grid grid;
    effect *owner;
    const field *node;
} effect_baked;

enum { MOST_VOXELS = 1 << 27, MOST_SIDE = 1024 };

static bool update(field_grid *grid, gpu *g, double time) {
    (void)g;
    (void)time;
    const effect_baked *baked = (const effect_baked *)grid;
    float longest = field_longest(baked->node, &baked->owner->context);
    grid->longest = isfinite(longest) ? longest : 0;
    box3 active;
    if (!field_bounds(baked->node, &baked->owner->context, &active)) return false;
    grid->state.active = box3_intersect(active, grid->box);
    return true;
}

static bool bake_check(const effect_bake_desc *desc) {
    uint64_t voxels = 1;
    for (int i = 0; i < 3; i++) {
        if (desc->size[i] < 1 || desc->size[i] > MOST_SIDE)
            return err_set("bake: size is %u x %u x %u; accepted: 1 to %d each", desc->size[0],
                           desc->size[1], desc->size[2], MOST_SIDE);
        voxels *= desc->size[i];
    }
    if (voxels > MOST_VOXELS)
        return err_set("bake: %llu voxels; at most %d", (unsigned long long)voxels, MOST_VOXELS);
    if (box3_is_empty(desc->box) || !box3_is_finite(desc->box))
        return err_set("bake: the field has no finite bounds; give box = { min, max }");
    if (desc->levels && !desc->repeats)
        return err_set("bake: 'levels' is for a grid that repeats; give repeats = true too");
    return true;
}

field_grid *effect_add_bake(effect *e, const field *node, const effect_bake_desc *desc) {
    if (!bake_check(desc)) return NULL;
    // A grid of three channels has four: the first is written once more.
    const field *value = node->components == 3 ? field_swizzle(&e->memory, node, "rgbr") : node;
    pass *p = effect_add_pass(e, "bake", NULL, NULL);
    if (!p || !pass_set_field(p, "value", value)) return NULL;
    if (desc->sampling && !pass_set_option(p, "sampling", desc->sampling)) return NULL;
    effect_baked *baked = arena_alloc(&e->memory, sizeof *baked);
    *baked = (effect_baked){
        .grid = {.name = pass_label(p),
                 .box = desc->box,
                 .size = {desc->size[0], desc->size[1], desc->size[2]},
                 .channel_count = node->components == 1 ? 1 : 4,
                 .repeats = desc->repeats,
                 .content = node,
                 .levels = desc->levels,
                 .state = {.active = desc->box},
                 .update = update},
        .owner = e,
        .node = node,
    };
    pass_set_bake(p, &baked->grid);
    effect_add_grid(e, &baked->grid);
    update(&baked->grid, e->device, 0); // its bounds are asked for before the first frame
    if (!pass_declare(p)) return NULL;
    return &baked->grid;
}

const field *effect_add_tile(effect *e, const field *noise, const effect_tile_desc *desc) {
    field_tile tile;
    float side = (float)desc->cells;
    e->tiled = true;
    if (!field_tile_create(&e->memory, noise, side, desc->octaves, &tile)) return NULL;
    effect_bake_desc bake = {
        .size = {desc->size, desc->size, desc->size},
        .box = {{0, 0, 0}, {side, side, side}},
        .repeats = true,
        .levels = desc->levels,
    };
    field_grid *grid = effect_add_bake(e, tile.content, &bake);
    if (!grid) return NULL;
    const field *baked = field_grid_channel(&e->memory, grid, 0, noise->components);
    return field_tile_sample(&e->memory, &tile, baked);
}
