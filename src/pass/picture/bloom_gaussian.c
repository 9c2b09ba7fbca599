// Bloom of one size: a separable blur of nine taps, across and down, as often as `passes` says, to
// and fro between two images. The wider the light shall reach, the more passes it takes: the width
// grows with their square root.
#include "pass/picture/bloom_parts.h"

static bool blur(pass *p, bloom_stage stage, gpu_image *from, gpu_image *to, bool down) {
    const gpu_image_desc *size = gpu_image_get_desc(to);
    kernel *k = pass_use(p, stage);
    if (!k) return false;
    kernel_bind(k, N_source, (gpu_binding){.image = from, .one_mip = true});
    kernel_bind(k, N_picture, (gpu_binding){.image = from, .one_mip = true});
    kernel_bind_image(k, N_color, to);
    kernel_set_int(k, N_down, down);
    return kernel_run(k, p->host->device, size->width, size->height, 1);
}

bool bloom_record_gaussian(pass *p) {
    const bloom_state *s = p->state;
    gpu_image *across = graph_get_image(p->host->graph, s->across);
    gpu_image *color = pass_get_image(p, N_color);
    int passes = (int)pass_value(p, N_passes);
    for (int i = 0; i < passes; i++) {
        gpu_image *from = i == 0 ? graph_get_image(p->host->graph, s->picture) : color;
        if (!blur(p, i == 0 ? BLOOM_BLUR_FIRST : BLOOM_BLUR, from, across, false) ||
            !blur(p, BLOOM_BLUR, across, color, true))
            return false;
    }
    return true;
}
