// Bricks: where a density can be above 0 is found from the ranges of its fields, then how far from
// that each empty block lies. As many as fit the box: numbers, so that they may change with it.
#include "pass/bricks.h"
#include "base/memory.h"
#include "field/range.h"
#include <math.h>
#include <string.h>

enum {
    MOST_BLOCKS = 43,
    USUAL_BLOCKS = 15,
    SOFTWARE_BLOCKS = 11, // where threads are few, looking for what is empty costs more
    FEW_BLOCKS = 5,
    FREE_WIDE = 24,
    FREE_HIGH = 8,
    FREE_ROWS = 16,
    HOLD_THREADS = 32,
    MANY_NODES = 200, // of an expression: more are dear
};

// On hardware, below which cheap samples of nothing cost less than bricks do.
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

// The second stage looks at no field.
static bool compile(pass *p, int stage, shader_binary *out) {
    static const shader_define hold[] = {{"STAGE_HOLD", "1"}, {"WITH_RANGES", "1"}};
    static const shader_define empty[] = {{"STAGE_FREE", "1"}, {"WITHOUT_FIELDS", "1"}};
    return pass_compile(p, p->shader, SHADER_COMPUTE, stage == 0 ? hold : empty, 2, out);
}

bool bricks_check(pass *p) {
    shader_binary binary;
    return compile(p, 0, &binary) && compile(p, 1, &binary);
}

bool bricks_build(pass *p, bricks *b) {
    for (int i = 0; i < BRICKS_STAGES; i++) {
        if (!compile(p, i, &b->binary[i])) return false;
        b->pipeline[i] = pass_create_compute(p, &b->binary[i]);
        if (!b->pipeline[i]) return false;
        b->block[i] = arena_alloc(p->host->memory, pass_block_size(&b->binary[i]) + 16);
    }
    return true;
}

void bricks_destroy(pass *p, bricks *b) {
    for (int i = 0; i < BRICKS_STAGES; i++)
        if (b->pipeline[i]) gpu_pipeline_destroy(p->host->device, b->pipeline[i]);
}

// Along the longest side; 0: none.
static float blocks_along(pass *p, const bricks *b, float samples) {
    float asked = pass_evaluate(p, "bricks");
    if (asked > 0) return fminf(ceilf(asked / 3), MOST_BLOCKS);
    if (gpu_get_info(p->host->device)->kind == GPU_CPU)
        return b->dear ? SOFTWARE_BLOCKS : FEW_BLOCKS;
    return b->dear || samples > many_samples ? USUAL_BLOCKS : 0;
}

// Bricks are about as long as wide, and three of them are a block.
void bricks_fill(pass *p, const bricks *b, const shader_binary *binary, unsigned char *block,
                 box3 box, float samples) {
    const float sides[3] = {box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
    float longest = fmaxf(fmaxf(sides[0], sides[1]), sides[2]);
    float most = blocks_along(p, b, samples), blocks[3] = {0};
    for (int i = 0; i < 3 && most > 0; i++)
        blocks[i] = sides[i] > 0 ? fmaxf(ceilf(most * sides[i] / longest - 0.01f), 1) : 1;
    pass_write_member(binary, block, "brick_blocks", blocks, sizeof blocks);
}

pass_override bricks_slot(const pass *p, const bricks *b) {
    gpu_image *image = graph_get_image(p->host->graph, b->image);
    return (pass_override){"brick_words", {.image = image, .sampler = GPU_NEAREST_CLAMP}};
}

static bool dispatch(pass *p, const bricks *b, int stage, const uint32_t threads[3]) {
    gpu_image *image = graph_get_image(p->host->graph, b->image);
    const pass_override kept = {"bricks_kept", {.image = image}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {.pipeline = b->pipeline[stage], .bindings = bindings};
    for (int i = 0; i < 3; i++) desc.threads[i] = threads[i];
    return pass_bind(p, &b->binary[stage], b->block[stage], &kept, 1, bindings,
                     &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

static uint32_t groups(float blocks, uint32_t each) {
    return ((uint32_t)blocks + each - 1) / each;
}

bool bricks_record(pass *p, bricks *b) {
    for (int i = 0; i < BRICKS_STAGES; i++)
        if (!pass_fill_block(p, &b->binary[i], b->block[i])) return false;
    shader_member member;
    float n[3] = {1, 1, 1};
    if (pass_find_member(&b->binary[0], "brick_blocks", &member))
        memcpy(n, b->block[0] + member.offset, sizeof n);
    if (n[0] == 0) return true;
    const uint32_t hold[3] = {HOLD_THREADS, (uint32_t)(n[0] * n[1] * n[2]), 1};
    const uint32_t empty[3] = {FREE_ROWS * groups(n[0], FREE_WIDE),
                               FREE_ROWS * groups(n[1], FREE_HIGH), groups(n[2], FREE_HIGH)};
    return dispatch(p, b, 0, hold) && dispatch(p, b, 1, empty);
}
