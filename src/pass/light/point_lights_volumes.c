// Light volumes: a sphere around each point light, as far as it reaches, drawn over the picture;
// its fragments add the point_light's light to what is seen there (Hargreaves and Harris, "Deferred
// shading", 2004). The far side is drawn, without a test of depth, so that a sphere that the eye is
// in counts, too. One draw for all.
#include "pass/light/point_lights_parts.h"

enum { SPHERE_VERTICES = 240 }; // as in point_lights_volume.vert

void point_lights_target(const pass *p, size_t index, gpu_graphics_desc *out) {
    (void)p;
    (void)index; // the only one that draws
    *out = (gpu_graphics_desc){.colors = {GPU_RGBA32F}, .cull = GPU_CULL_BACK, .blend = true};
}

static gpu_image_desc describe_light(uint32_t width, uint32_t height) {
    return (gpu_image_desc){.label = "light of point lights",
                            .format = GPU_RGBA32F,
                            .width = width,
                            .height = height,
                            .use = GPU_USE_TARGET | GPU_USE_SAMPLED};
}

static bool has_light(const pass *p, uint32_t width, uint32_t height) {
    const gpu_image *light = p->point_lights->light;
    const gpu_image_desc *now = light ? gpu_image_get_desc(light) : NULL;
    return now && now->width == width && now->height == height;
}

void point_lights_list_light(const pass *p, uint32_t width, uint32_t height, budget_list *out) {
    const gpu_image_desc desc = describe_light(width, height);
    if (!has_light(p, width, height)) budget_list_add(out, desc.label, gpu_image_bytes(&desc));
}

static bool make_light(pass *p, uint32_t width, uint32_t height) {
    const gpu_image_desc desc = describe_light(width, height);
    if (has_light(p, width, height)) return true;
    gpu_image_destroy(p->host->device, p->point_lights->light);
    p->point_lights->light = gpu_image_create(p->host->device, &desc);
    return p->point_lights->light != NULL;
}

bool point_lights_draw_volumes(pass *p, uint32_t width, uint32_t height) {
    const float picture[2] = {(float)width, (float)height};
    gpu_binding kept[GPU_MAX_SLOTS];
    kernel *k = pass_use_provided(p, &pass_point_lights_provider, POINT_LIGHTS_DRAW);
    if (!k || !make_light(p, width, height)) return false;
    kernel_set(k, N_point_light_picture, picture, sizeof picture);
    gpu_draw draw = kernel_draw(k, kept);
    draw.vertices = SPHERE_VERTICES;
    draw.instances = p->point_lights->count;
    return kernel_is_bound(k) &&
           gpu_draw_all(p->host->device, &(gpu_draw_desc){.pipeline = k->pipeline,
                                                          .colors = {p->point_lights->light},
                                                          .clear = true,
                                                          .draws = &draw,
                                                          .draw_count = 1});
}
