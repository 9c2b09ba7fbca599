// Bricks: where a density can be above 0 is found from the ranges of its fields, then how far from
// that each empty block lies. As many as fit the box: numbers, so that they may change with it.
#include "pass/march/bricks.h"
#include "field/range.h"
#include "pass/march/march_around.h"
#include <math.h>
#include <string.h>

enum {
    MOST_BLOCKS = 43,
    FREE_WIDE = 24,
    FREE_HIGH = 8,
    FREE_ROWS = 16,
    HOLD_THREADS = 32,
    MANY_NODES = 200, // of an expression: more are dear
};

static const float many_samples = 4e7f;
static const float dear = 45; // operations: more than one fetch from a grid

static float cost_of(const field *node) {
    if (node->uniform) return 0;
    if (node->size > MANY_NODES) return INFINITY;
    float cost = node->kind->cost;
    for (size_t i = 0; i < FIELD_MAX_ARGS && node->args[i]; i++) cost += cost_of(node->args[i]);
    return cost;
}

// Whether it is dear to find that the density is 0. Of a product cheap factors are looked at first:
// only a dear one that can itself be 0 is computed for nothing.
static bool wastes(const field *node, const field_context *context) {
    if (cost_of(node) < dear) return false;
    if (node->size <= MANY_NODES && strcmp(node->kind->name, "mul") == 0)
        return wastes(node->args[0], context) || wastes(node->args[1], context);
    const float end = INFINITY;
    const box3 space = {{-end, -end, -end}, {end, end, end}};
    intervals all;
    return !field_ranges(node, context, space, &all) || (all.c[0].low <= 0 && all.c[0].high >= 0);
}

bool bricks_declare(pass *p, bricks *b, bool (*record)(pass *p)) {
    b->dear = wastes(pass_density(p), p->host->context);
    b->image = graph_add_image(p->host->graph,
                               &(graph_image_desc){
                                   .name = arena_format(p->host->memory, "%s.bricks", p->label),
                                   .format = GPU_R32U,
                                   .width = MOST_BLOCKS,
                                   .height = MOST_BLOCKS,
                                   .depth = MOST_BLOCKS,
                               });
    return b->image.id && pass_add_part(p, &(pass_part){.name = "bricks",
                                                        .writes = &b->image,
                                                        .write_count = 1,
                                                        .fields = true,
                                                        .record = record});
}

// Along the longest side; 0: none.
static float blocks_along(pass *p, const bricks *b, float samples) {
    float asked = pass_value(p, N_bricks);
    if (asked > 0) return fminf(ceilf(asked / 3), MOST_BLOCKS);
    const gpu_profile *device = gpu_get_profile(p->host->device);
    if (b->dear) return device->bricks_dear;
    return samples > many_samples ? device->bricks_many : device->bricks_cheap;
}

// Bricks are about as long as wide, and three of them are a block.
void bricks_update(pass *p, bricks *b, box3 box, float samples) {
    const float sides[3] = {box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
    float longest = fmaxf(fmaxf(sides[0], sides[1]), sides[2]);
    float most = blocks_along(p, b, samples), blocks[3] = {0};
    for (int i = 0; i < 3 && most > 0; i++)
        blocks[i] = sides[i] > 0 ? fmaxf(ceilf(most * sides[i] / longest - 0.01f), 1) : 1;
    memcpy(b->blocks, blocks, sizeof blocks);
    pass_set(p, N_brick_blocks, blocks, sizeof blocks);
}

void bricks_bind(const pass *p, const bricks *b, kernel *k) {
    gpu_image *image = graph_get_image(p->host->graph, b->image);
    kernel_bind(k, N_brick_words, (gpu_binding){.image = image, .sampler = GPU_NEAREST_CLAMP});
}

static bool dispatch(pass *p, const bricks *b, march_kernel which, uint32_t x, uint32_t y,
                     uint32_t z) {
    kernel *k = pass_use(p, which);
    if (!k) return false;
    kernel_bind_image(k, N_bricks_kept, graph_get_image(p->host->graph, b->image));
    return kernel_run(k, p->host->device, x, y, z);
}

static uint32_t groups(float blocks, uint32_t each) {
    return ((uint32_t)blocks + each - 1) / each;
}

bool bricks_record(pass *p, bricks *b) {
    const float *n = b->blocks;
    return n[0] == 0 ||
           (dispatch(p, b, MARCH_HOLD, HOLD_THREADS, (uint32_t)(n[0] * n[1] * n[2]), 1) &&
            dispatch(p, b, MARCH_FREE, FREE_ROWS * groups(n[0], FREE_WIDE),
                     FREE_ROWS * groups(n[1], FREE_HIGH), groups(n[2], FREE_HIGH)));
}
