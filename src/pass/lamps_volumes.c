// Light volumes: a sphere around each lamp, as far as it reaches, drawn over the picture; its
// fragments add the lamp's light to what is seen there (Hargreaves and Harris, "Deferred shading",
// 2004). The far side is drawn, without a test of depth, so that a sphere that the eye is in
// counts, too. One draw for all.
#include "pass/lamps_parts.h"
#include <string.h>

enum { SPHERE_VERTICES = 240 }; // as in lamps_volume.vert

bool lamps_check_volumes(pass *p) {
    const shader_define without = {"WITHOUT_FIELDS", "1"};
    lamps_volumes *v = &p->lamps->volumes;
    return pass_compile(p, "pass/lamps_volume.vert", SHADER_VERTEX, &without, 1, &v->vertex) &&
           pass_compile(p, "pass/lamps_volume.frag", SHADER_FRAGMENT, &without, 1, &v->fragment);
}

bool lamps_build_volumes(pass *p) {
    lamps_volumes *v = &p->lamps->volumes;
    if (!lamps_check_volumes(p)) return false;
    v->vertex_block = arena_alloc(p->host->memory, pass_block_size(&v->vertex) + 16);
    v->fragment_block = arena_alloc(p->host->memory, pass_block_size(&v->fragment) + 16);
    v->pipeline = pass_create_graphics(p, &v->vertex, &v->fragment,
                                       (gpu_graphics_desc){
                                           .colors = {GPU_RGBA32F},
                                           .cull = GPU_CULL_BACK,
                                           .blend = true,
                                       });
    return v->pipeline != NULL;
}

void lamps_destroy_volumes(pass *p) {
    lamps_volumes *v = &p->lamps->volumes;
    if (v->pipeline) gpu_pipeline_destroy(p->host->device, v->pipeline);
    gpu_image_destroy(p->host->device, v->light);
}

// ---- in a frame -------------------------------------------------------------------------------

static bool make_light(pass *p, uint32_t width, uint32_t height) {
    gpu_image **light = &p->lamps->volumes.light;
    const gpu_image_desc *now = *light ? gpu_image_get_desc(*light) : NULL;
    if (now && now->width == width && now->height == height) return true;
    gpu_image_destroy(p->host->device, *light);
    *light = gpu_image_create(p->host->device,
                              &(gpu_image_desc){.label = "light of lamps",
                                                .format = GPU_RGBA32F,
                                                .width = width,
                                                .height = height,
                                                .use = GPU_USE_TARGET | GPU_USE_SAMPLED});
    return *light != NULL;
}

static bool bind_stage(pass *p, const shader_binary *binary, unsigned char *block,
                       const float picture[2], gpu_binding *out, size_t *count) {
    gpu_binding bindings[GPU_MAX_SLOTS];
    size_t added;
    if (!pass_fill_block(p, binary, block)) return false;
    pass_write_member(binary, block, "lamp_picture", picture, 2 * sizeof *picture);
    if (!pass_bind(p, binary, block, NULL, 0, bindings, &added)) return false;
    memcpy(out + *count, bindings, added * sizeof *bindings);
    *count += added;
    return true;
}

bool lamps_draw_volumes(pass *p, uint32_t width, uint32_t height) {
    lamps_volumes *v = &p->lamps->volumes;
    const float picture[2] = {(float)width, (float)height};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_draw draw = {
        .bindings = bindings, .vertices = SPHERE_VERTICES, .instances = p->lamps->count};
    if (!make_light(p, width, height) ||
        !bind_stage(p, &v->vertex, v->vertex_block, picture, bindings, &draw.binding_count) ||
        !bind_stage(p, &v->fragment, v->fragment_block, picture, bindings, &draw.binding_count))
        return false;
    return gpu_draw_all(p->host->device, &(gpu_draw_desc){.pipeline = v->pipeline,
                                                          .colors = {v->light},
                                                          .clear = true,
                                                          .draws = &draw,
                                                          .draw_count = 1});
}
