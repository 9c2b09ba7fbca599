// Bloom: the bright picture is halved again and again into one image with mip levels, then added
// back up level by level. One shader, compiled for each direction.
#include "base/error.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include <string.h>

typedef struct bloom_state {
    shader_binary binary[2]; // down, up
    gpu_pipeline *pipeline[2];
    unsigned char *block;
} bloom_state;

static const shader_define directions[2] = {{"DIRECTION_UP", "0"}, {"DIRECTION_UP", "1"}};

bool bloom_declare(pass *p) {
    int output = pass_find_image(p, "color");
    p->images[output] = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.color", p->label),
                            .format = p->formats[output],
                            .scale = p->scale,
                            .mips = GRAPH_ALL_MIPS,
                        });
    return p->images[output].id && pass_declare_images(p) && pass_add_to_graph(p);
}

static bool compile_both(pass *p, shader_binary out[2]) {
    return pass_compile(p, p->shader, SHADER_COMPUTE, &directions[0], 1, &out[0]) &&
           pass_compile(p, p->shader, SHADER_COMPUTE, &directions[1], 1, &out[1]);
}

bool bloom_check(pass *p) {
    shader_binary binary[2];
    return compile_both(p, binary);
}

bool bloom_build(pass *p) {
    bloom_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    if (!compile_both(p, s->binary)) return false;
    for (int i = 0; i < 2; i++) {
        s->pipeline[i] = pass_create_compute(p, &s->binary[i]);
        if (!s->pipeline[i]) return false;
    }
    s->block = arena_alloc(p->host->memory, pass_block_size(&s->binary[1]) + 16);
    p->binary = s->binary[0];
    return true;
}

static uint32_t mip_size(uint32_t size, uint32_t mip) {
    return size >> mip ? size >> mip : 1;
}

// Reads level `from` of `source`, writes level `to` of the chain.
static bool step(pass *p, int direction, gpu_image *source, uint32_t from, gpu_image *chain,
                 uint32_t to) {
    bloom_state *s = p->state;
    unsigned char *block = direction ? s->block : p->block;
    const pass_override overrides[] = {
        {"source", {.image = source, .mip = from, .one_mip = true, .sampler = GPU_LINEAR_CLAMP}},
        {"color", {.image = chain, .mip = to}},
    };
    gpu_binding bindings[GPU_MAX_SLOTS];
    size_t count;
    if (!pass_bind(p, &s->binary[direction], block, overrides, 2, bindings, &count)) return false;
    const gpu_image_desc *desc = gpu_image_get_desc(chain);
    return gpu_dispatch(p->host->device,
                        &(gpu_dispatch_desc){
                            s->pipeline[direction],
                            bindings,
                            count,
                            {mip_size(desc->width, to), mip_size(desc->height, to), 1},
                        });
}

// The first level is the bright picture itself; level i + 1 is level i halved. The way up stops
// where `levels` says; 0 takes all, as the paper does (section 3.8.2).
bool bloom_record(pass *p) {
    bloom_state *s = p->state;
    if (!pass_prepare(p) || !pass_fill_block(p, &s->binary[1], s->block)) return false;
    gpu_image *chain = graph_get_image(p->host->graph, p->images[pass_find_image(p, "color")]);
    gpu_image *source = graph_get_image(p->host->graph, p->images[pass_find_image(p, "source")]);
    uint32_t last = gpu_image_get_desc(chain)->mips - 1;
    uint32_t wanted = (uint32_t)pass_evaluate(p, "levels");
    if (wanted && wanted < last) last = wanted;
    if (!step(p, 0, source, 0, chain, 0)) return false;
    for (uint32_t mip = 0; mip < last; mip++)
        if (!step(p, 0, chain, mip, chain, mip + 1)) return false;
    for (uint32_t mip = last; mip > 0; mip--)
        if (!step(p, 1, chain, mip, chain, mip - 1)) return false;
    return true;
}

void bloom_destroy(pass *p) {
    bloom_state *s = p->state;
    for (int i = 0; s && i < 2; i++)
        if (s->pipeline[i]) gpu_pipeline_destroy(p->host->device, s->pipeline[i]);
}
