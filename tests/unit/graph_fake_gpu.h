// A gpu of the few calls that the graph makes, which writes down what was asked of it. Included by
// a test program in place of the gpu layer, so that allocation is tested without a device.
#pragma once
#include "graph_helper.h"
#include <stdlib.h>

struct gpu {
    uint64_t created, alive, fail_at; // fail_at: the creation with this number fails
    strbuf log;                       // "begin a;clear x;end;"
};

struct gpu_image {
    gpu_image_desc desc;
    char label[64];
};

gpu_image *gpu_image_create(gpu *g, const gpu_image_desc *desc) {
    if (++g->created == g->fail_at) {
        err_set("no device memory");
        return NULL;
    }
    gpu_image *made = calloc(1, sizeof *made);
    assert_non_null(made);
    made->desc = *desc;
    strncpy(made->label, desc->label, sizeof made->label - 1);
    g->alive++;
    return made;
}

uint64_t gpu_image_bytes(const gpu_image_desc *desc) {
    return (uint64_t)desc->width * desc->height * (desc->depth ? desc->depth : 1);
}

void gpu_lend_memory(gpu *g, const gpu_image_desc *going, size_t count) {
    (void)g, (void)going, (void)count;
}

void gpu_image_destroy(gpu *g, gpu_image *destroyed) {
    if (destroyed) g->alive--;
    free(destroyed);
}

const gpu_image_desc *gpu_image_get_desc(const gpu_image *of) {
    return &of->desc;
}

void gpu_image_clear(gpu *g, gpu_image *cleared, const float color[4]) {
    for (int i = 0; i < 4; i++) assert_true(color[i] == 0.0f);
    strbuf_add(&g->log, "clear %s;", cleared->label);
}

void gpu_pass_begin(gpu *g, const char *label) {
    strbuf_add(&g->log, "begin %s;", label);
}

void gpu_pass_end(gpu *g) {
    strbuf_add(&g->log, "end;");
}

const char *gpu_format_name(gpu_format format) {
    return format == GPU_RGBA16F ? "rgba16f" : "other";
}
