// Bloom of one size: a separable blur of nine taps, across and down, as often as
// `passes` says, to and fro between two images. The wider the light shall reach, the
// more passes it takes: the width grows with their square root.
#include "base/memory.h"
#include "pass/bloom_parts.h"

static bool blur(pass *p, bloom_stage stage, gpu_image *from, gpu_image *to, bool down) {
    bloom_state *s = p->state;
    const gpu_image_desc *size = gpu_image_get_desc(to);
    const gpu_binding input = {.image = from, .one_mip = true, .sampler = GPU_LINEAR_CLAMP};
    const pass_override overrides[] = {
        {"source", input}, {"picture", input}, {"color", {.image = to}}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {.pipeline = s->pipeline[stage],
                              .bindings = bindings,
                              .threads = {size->width, size->height}};
    bloom_write_int(p, stage, "down", down);
    return pass_bind(p, &s->binary[stage], s->block[stage], overrides, COUNT_OF(overrides),
                     bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

bool bloom_record_gaussian(pass *p) {
    const bloom_state *s = p->state;
    graph *g = p->host->graph;
    gpu_image *across = graph_get_image(g, s->across);
    gpu_image *color = graph_get_image(g, p->images[pass_find_image(p, "color")]);
    int passes = (int)pass_evaluate(p, "passes");
    for (int i = 0; i < passes; i++) {
        bool first = i == 0;
        if (!blur(p, first ? BLOOM_BLUR_FIRST : BLOOM_BLUR,
                  first ? graph_get_image(g, s->picture) : color, across, false) ||
            !blur(p, BLOOM_BLUR, across, color, true))
            return false;
    }
    return true;
}
