#include "pass/march_around.h"
#include "base/maths.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

enum { GROUP_SIDE = 16 };

static const float worth = 0.8f; // of a picture: where more of it is inside, all is

static bool compile(pass *p, shader_binary *out) {
    static const shader_define defines[] = {{"STAGE_AROUND", "1"}, {"WITHOUT_FIELDS", "1"}};
    return pass_compile(p, p->shader, SHADER_COMPUTE, defines, COUNT_OF(defines), out);
}

bool march_around_check(pass *p) {
    shader_binary binary;
    return compile(p, &binary);
}

bool march_around_build(pass *p, march_around *a) {
    if (!compile(p, &a->binary)) return false;
    a->pipeline = pass_create_compute(p, &a->binary);
    a->block = arena_alloc(p->host->memory, pass_block_size(&a->binary) + 16);
    return a->pipeline != NULL;
}

void march_around_destroy(pass *p, march_around *a) {
    if (a->pipeline) gpu_pipeline_destroy(p->host->device, a->pipeline);
}

// ---- in a frame -------------------------------------------------------------------------------

// Where a point lies in the picture, 0..1, y down; false for one that is not in front of the
// camera.
static bool project(const struct frame_block *f, const float at[3], float out[2]) {
    float eye[3];
    for (int i = 0; i < 3; i++) {
        eye[i] = f->view.m[12 + i];
        for (int k = 0; k < 3; k++) eye[i] += f->view.m[4 * k + i] * at[k];
    }
    if (!(eye[2] < -f->lens.v[2])) return false;
    out[0] = 0.5f - 0.5f * eye[0] / (eye[2] * f->lens.v[0]);
    out[1] = 0.5f + 0.5f * eye[1] / (eye[2] * f->lens.v[1]);
    return true;
}

// Whole groups, and a pixel more than the box's corners span; false: the camera is too near.
static bool find_inside(const struct frame_block *f, box3 box, const uint32_t size[3],
                        march_part *out) {
    float low[2] = {1, 1}, high[2] = {0, 0};
    for (int i = 0; i < 8; i++) {
        const float corner[3] = {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                                 i & 4 ? box.max.z : box.min.z};
        float at[2];
        if (!project(f, corner, at)) return false;
        for (int k = 0; k < 2; k++) {
            low[k] = fminf(low[k], clampf(at[k], 0, 1));
            high[k] = fmaxf(high[k], clampf(at[k], 0, 1));
        }
    }
    for (int k = 0; k < 2; k++) {
        int32_t first = (int32_t)(low[k] * (float)size[k]) - 1;
        int32_t end = (int32_t)(high[k] * (float)size[k]) + 2;
        out->low[k] = first > 0 ? first / GROUP_SIDE * GROUP_SIDE : 0;
        out->high[k] = (end + GROUP_SIDE - 1) / GROUP_SIDE * GROUP_SIDE;
        if (out->high[k] > (int32_t)size[k]) out->high[k] = (int32_t)size[k];
    }
    return true;
}

void march_write_corner(const shader_binary *binary, unsigned char *block, march_part part) {
    const float corner[2] = {(float)part.low[0], (float)part.low[1]};
    pass_write_member(binary, block, "corner", corner, sizeof corner);
}

static bool fill(pass *p, march_around *a, march_part part) {
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {.pipeline = a->pipeline, .bindings = bindings};
    for (int i = 0; i < 2; i++) {
        if (part.high[i] <= part.low[i]) return true;
        desc.threads[i] = (uint32_t)(part.high[i] - part.low[i]);
    }
    march_write_corner(&a->binary, a->block, part);
    return pass_bind(p, &a->binary, a->block, NULL, 0, bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

bool march_around_record(pass *p, march_around *a, box3 box, march_part *inside) {
    uint32_t size[3];
    graph_get_size(p->host->graph, pass_output(p, "color"), size);
    const int32_t width = (int32_t)size[0], height = (int32_t)size[1];
    march_part in, all = {{0, 0}, {width, height}};
    *inside = all;
    if (!a || box3_is_empty(box) || !find_inside(p->host->frame, box, size, &in)) return true;
    float pixels = (float)(in.high[0] - in.low[0]) * (float)(in.high[1] - in.low[1]);
    if (pixels > worth * (float)width * (float)height) return true;
    *inside = in;
    return pass_fill_block(p, &a->binary, a->block) &&
           fill(p, a, (march_part){{0, 0}, {width, in.low[1]}}) &&
           fill(p, a, (march_part){{0, in.low[1]}, {in.low[0], in.high[1]}}) &&
           fill(p, a, (march_part){{in.high[0], in.low[1]}, {width, in.high[1]}}) &&
           fill(p, a, (march_part){{0, in.high[1]}, {width, height}});
}
