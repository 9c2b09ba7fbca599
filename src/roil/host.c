// An effect as a layer of a host's picture, and images that are read back without waiting.
#include "base/error.h"
#include "base/maths.h"
#include "base/memory.h"
#include "roil/roil_impl.h"
#include <math.h>
#include <string.h>

// ---- the layer --------------------------------------------------------------------------------

static bool make_layer(roil_effect *e, const roil_layer_desc *desc) {
    if (e->has_layer)
        return err_set("%s: the effect is a layer already", effect_get_facts(e->effect)->file);
    if (e->width) return err_set("roil_make_layer comes before roil_prepare");
    if (e->averaged) return err_set("the pictures of a layer are not averaged");
    if (!effect_add_layer(e->effect, desc ? desc->source : NULL, desc && desc->motion, &e->layer))
        return false;
    e->has_layer = true;
    for (int i = 0; i < EFFECT_LAYER_IMAGES; i++) {
        const char *name = graph_get_desc(effect_graph(e->effect), e->layer.images[i])->name;
        bool wanted = i != EFFECT_LAYER_MOTION || (desc && desc->motion);
        if (wanted && !roil_keep(e, name)) return false;
    }
    effect_skip_pictures(e->effect);
    return true;
}

bool roil_make_layer(roil_effect *e, const roil_layer_desc *desc) {
    return MEM_CALL(make_layer(e, desc));
}

const char *roil_get_layer_image(const roil_effect *e, roil_layer_image image) {
    if (e->has_layer && (unsigned)image < ROIL_LAYER_IMAGES)
        return graph_get_desc(effect_graph(e->effect), e->layer.images[image])->name;
    return ERR_NULL("%s", e->has_layer ? "there is no such image of a layer"
                                       : "the effect is no layer: roil_make_layer makes it one");
}

// ---- what the host says -----------------------------------------------------------------------

bool roil_set_view(roil_effect *e, const roil_view *given) {
    scene_view own;
    if (!given) return effect_set_view(e->effect, NULL);
    memcpy(own.view, given->view, sizeof own.view);
    memcpy(own.projection, given->projection, sizeof own.projection);
    memcpy(own.jitter, given->jitter, sizeof own.jitter);
    return effect_set_view(e->effect, &own);
}

static void take(float *out, const float *from, float low, float high) {
    for (int i = 0; i < 3; i++) out[i] = isfinite(from[i]) ? clampf(from[i], low, high) : 0;
}

static bool take_sun(const roil_sun *sun, struct light_entry *out) {
    out->color.v[3] = LIGHT_SUN;
    out->position.v[2] = 1;
    if (!sun) return true;
    vec3 towards = {sun->towards[0], sun->towards[1], sun->towards[2]};
    if (!(glm_vec3_norm(towards) > 1e-20f && isfinite(glm_vec3_norm(towards))))
        return err_set("the host's sun: its direction has no length, or one that is not finite");
    glm_vec3_normalize(towards);
    memcpy(out->position.v, towards, sizeof towards);
    out->position.v[3] = sinf(glm_rad(clampf(sun->angle, 0, 180)) / 2);
    take(out->color.v, sun->irradiance, 0, 1e12f);
    return true;
}

static void take_point(const roil_point_light *light, struct light_entry *out) {
    take(out->position.v, light->position, -1e9f, 1e9f);
    out->position.v[3] = isfinite(light->radius) ? clampf(light->radius, 0, 1e9f) : 0;
    take(out->color.v, light->intensity, 0, 1e12f);
    out->color.v[3] = LIGHT_POINT;
    out->spread.v[1] = isfinite(light->range) ? clampf(light->range, 0, 1e9f) : 0;
}

bool roil_set_lights(roil_effect *e, const roil_lights *lights) {
    struct light_entry own[LIGHT_MAX] = {0};
    if (!lights) return effect_set_lights(e->effect, NULL, 0);
    if (lights->count >= LIGHT_MAX)
        return err_set("%zu lights; accepted: up to %d", lights->count, LIGHT_MAX - 1);
    if (!take_sun(lights->sun, &own[0])) return false;
    for (size_t i = 0; i < lights->count; i++) take_point(&lights->points[i], &own[i + 1]);
    return effect_set_lights(e->effect, own, lights->count + 1);
}

// ---- reading back -----------------------------------------------------------------------------

struct roil_readback {
    gpu *device;
    gpu_buffer *buffer;
    gpu_image_desc size;
    uint64_t frame; // that copies it
};

static graph_image image_to_read(roil_effect *e, const char *name) {
    if (name) return roil_find_image(e, name);
    if (e->has_layer) return e->layer.images[EFFECT_LAYER_COLOR];
    graph_image linear = effect_get_picture(e->effect, EFFECT_LINEAR);
    return linear.id ? linear : effect_get_picture(e->effect, EFFECT_OUTPUT);
}

static bool begin_copy(roil_readback *b, gpu_image *image) {
    b->frame = gpu_frame_begin(b->device);
    if (!b->frame) return false;
    bool done = gpu_image_copy_to_buffer(b->device, image, b->buffer, 0);
    bool ended = gpu_frame_end(b->device);
    return done && ended;
}

static roil_readback *read_begin(roil_effect *e, const char *image) {
    const graph_image which = image_to_read(e, image);
    gpu_image *source = which.id ? graph_get_image(effect_graph(e->effect), which) : NULL;
    if (image && !which.id) return NULL;
    if (!source || !e->frame)
        return ERR_NULL("there is no such image yet: keep it (roil_keep) and render a frame first");
    const gpu_image_desc *desc = gpu_image_get_desc(source);
    if (desc->depth > 1 || desc->format == GPU_R32U)
        return ERR_NULL("%s: only two-dimensional pictures can be read", desc->label);
    roil_readback *b = mem_alloc(sizeof *b);
    b->device = e->owner->device;
    b->size = *desc;
    b->size.label = NULL;
    b->buffer = gpu_buffer_create(b->device, &(gpu_buffer_desc){.label = "pictures read back",
                                                                .size = gpu_image_bytes(desc),
                                                                .kind = GPU_BUFFER_READBACK});
    if (b->buffer && begin_copy(b, source)) return b;
    roil_read_end(b, NULL);
    return NULL;
}

roil_readback *roil_read_begin(roil_effect *e, const char *image) {
    RETURN_MADE(roil_readback, read_begin(e, image), roil_read_end(made, NULL));
}

bool roil_read_ready(roil_readback *b) {
    return gpu_frame_done(b->device, b->frame) || gpu_pending(b->device) == 0;
}

void roil_read_size(const roil_readback *b, uint32_t *width, uint32_t *height) {
    *width = b->size.width;
    *height = b->size.height;
}

static bool read_end(roil_readback *b, float *out) {
    bool done = !out || gpu_frame_wait(b->device, b->frame);
    if (out && done)
        roil_expand(gpu_buffer_map(b->buffer), b->size.format,
                    (size_t)b->size.width * b->size.height, out);
    gpu_buffer_destroy(b->device, b->buffer);
    mem_free(b);
    return done;
}

bool roil_read_end(roil_readback *b, float *out) {
    return MEM_CALL(read_end(b, out));
}
