// Which point lights may light what a tile of a picture shows, for the pass that reads them: two
// dispatches before its own. Of "all" the first alone, which copies the point lights into a buffer:
// there a value that threads side by side read at once costs one access, in an image one for each
// of them.
//
// Or light volumes: a sphere around each point light, as far as it reaches, drawn over the picture;
// its fragments add the point_light's light to what is seen there (Hargreaves and Harris, "Deferred
// shading", 2004). The far side is drawn, without a test of depth, so that a sphere that the eye is
// in counts, too. One draw for all.
#include "base/error.h"
#include "base/memory.h"
#include "pass/light/point_lights.h"
#include "pass/pass_impl.h"

enum {
    TILE = 16,   // pixels, as in lib/point_lights.glsl
    GROUP = 16,  // threads along a group
    RECORD = 32, // bytes
    HEAD = 16,
    WORD_BITS = 32,
    FEW = 4,               // point lights, up to which every pixel may as well look at all
    SPHERE_VERTICES = 240, // as in point_lights_volume.vert
};

typedef enum point_lights_kernel {
    POINT_LIGHTS_RECORDS,
    POINT_LIGHTS_MASKS,
    POINT_LIGHTS_DRAW,
    POINT_LIGHTS_KERNELS
} point_lights_kernel;
typedef enum lists_buffer {
    POINT_LIGHT_RECORDS,
    POINT_LIGHT_MASKS,
    POINT_LIGHT_BOUNDS,
    POINT_LIGHT_BUFFERS
} lists_buffer;

#define POINT_LIGHTS_NAMES(NAME)                                                                   \
    NAME(width), NAME(height), NAME(point_light_count), NAME(point_light_words),                   \
        NAME(point_light_tiles_across), NAME(point_light_picture)
KERNEL_NAMES(POINT_LIGHTS_NAMES);

struct pass_point_lights {
    uint32_t count;
    point_lights_way way;
    gpu_buffer *buffers[POINT_LIGHT_BUFFERS];
    gpu_image *light; // what spheres around the point lights have added up, where the way is
                      // POINT_LIGHTS_VOLUMES
};

static const pass_kernel kernels[POINT_LIGHTS_KERNELS] = {
    [POINT_LIGHTS_RECORDS] = {.shader = "pass/light/point_lights_lists.comp",
                              .define = "STAGE_RECORDS",
                              .without_fields = true},
    [POINT_LIGHTS_MASKS] = {.shader = "pass/light/point_lights_lists.comp",
                            .define = "STAGE_MASKS",
                            .without_fields = true},
    [POINT_LIGHTS_DRAW] = {.shader = "pass/light/point_lights_volume.frag",
                           .vertex = "pass/light/point_lights_volume.vert",
                           .without_fields = true},
};
static const char *const labels[POINT_LIGHT_BUFFERS] = {
    [POINT_LIGHT_RECORDS] = "records of point lights",
    [POINT_LIGHT_MASKS] = "point lights by tiles",
    [POINT_LIGHT_BOUNDS] = "depths of tiles"};

static point_lights_way choose_way(const pass *p, uint32_t count) {
    static const char *const words[] = {"all", "tiles", "volumes"};
    for (size_t i = 0; i < COUNT_OF(words); i++)
        if (pass_has_word(p, "point_lights_by", words[i])) return (point_lights_way)i;
    return count <= FEW ? POINT_LIGHTS_ALL : POINT_LIGHTS_TILES;
}

static bool find_point_lights(pass *p) {
    int input = pass_find_image(p, "point_lights");
    if (input < 0 || p->face->images[input].output || !p->images[input].id) return true;
    const pass *writer = pass_writer(p->host, p->images[input]);
    if (!writer || !pass_is(writer, "point_lights"))
        return err_set(
            "%s: 'point_lights' takes a pass point_lights { }, as in point_lights = fireflies or "
            "from = {scene, fireflies}",
            p->label);
    p->point_lights = arena_alloc(p->host->memory, sizeof *p->point_lights);
    p->point_lights->count = graph_get_desc(p->host->graph, p->images[input])->height;
    p->point_lights->way = choose_way(p, p->point_lights->count);
    return true;
}

static point_lights_way pass_point_lights_way(const pass *p) {
    return p->point_lights ? p->point_lights->way : POINT_LIGHTS_ALL;
}

static size_t point_lights_defines(const pass *p, shader_define out[PASS_PROVIDER_DEFINES]) {
    if (!p->point_lights) return 0;
    out[0] = (shader_define){"POINT_LIGHTS_TILES",
                             pass_point_lights_way(p) == POINT_LIGHTS_TILES ? "1" : "0"};
    out[1] = (shader_define){"POINT_LIGHTS_VOLUMES",
                             pass_point_lights_way(p) == POINT_LIGHTS_VOLUMES ? "1" : "0"};
    out[2] = (shader_define){"POINT_LIGHTS_BETWEEN", pass_is(p, "point_light_glows") ? "1" : "0"};
    return 3;
}

// ---- building ---------------------------------------------------------------------------------

static bool uses_point_lights(const pass *p) {
    return p->point_lights != NULL;
}

static bool wants_kernel(const pass *p, size_t index) {
    if (index == POINT_LIGHTS_RECORDS) return true;
    return p->point_lights->way ==
           (index == POINT_LIGHTS_MASKS ? POINT_LIGHTS_TILES : POINT_LIGHTS_VOLUMES);
}

static void point_lights_target(const pass *p, size_t index, gpu_graphics_desc *out) {
    (void)p;
    (void)index; // the only one that draws
    *out = (gpu_graphics_desc){.colors = {GPU_RGBA32F}, .cull = GPU_CULL_BACK, .blend = true};
}

static void point_lights_destroy(pass *p) {
    for (int i = 0; p->point_lights && i < POINT_LIGHT_BUFFERS; i++)
        gpu_buffer_destroy(p->host->device, p->point_lights->buffers[i]);
    if (p->point_lights) gpu_image_destroy(p->host->device, p->point_lights->light);
}

// ---- in a frame -------------------------------------------------------------------------------

typedef struct tiling { // of the picture that the pass writes
    uint32_t width, height, across, down, words;
} tiling;

static tiling tiling_of(const pass *p) {
    uint32_t size[3] = {1, 1, 1};
    for (size_t i = p->face->image_count; i-- > 0;)
        if (p->face->images[i].output) graph_get_size(p->host->graph, p->images[i], size);
    return (tiling){
        .width = size[0],
        .height = size[1],
        .across = (size[0] + TILE - 1) / TILE,
        .down = (size[1] + TILE - 1) / TILE,
        .words = (p->point_lights->count + WORD_BITS - 1) / WORD_BITS,
    };
}

static uint64_t bytes_of(const pass *p, const tiling *t, lists_buffer which) { // 0: none
    if (which == POINT_LIGHT_RECORDS) return HEAD + (uint64_t)RECORD * p->point_lights->count;
    if (p->point_lights->way != POINT_LIGHTS_TILES) return 0;
    return which == POINT_LIGHT_MASKS ? 4ull * t->across * t->down * t->words
                                      : 8ull * t->across * t->height;
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

static void point_lights_list_light(const pass *p, uint32_t width, uint32_t height,
                                    budget_list *out) {
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

static void point_lights_list_memory(const pass *p, budget_list *out) {
    if (!p->point_lights) return;
    const tiling t = tiling_of(p);
    for (lists_buffer i = 0; i < POINT_LIGHT_BUFFERS; i++) {
        const gpu_buffer *now = p->point_lights->buffers[i];
        const uint64_t bytes = bytes_of(p, &t, i);
        if (!now || gpu_buffer_size(now) != bytes) budget_list_add(out, labels[i], bytes);
    }
    if (p->point_lights->way == POINT_LIGHTS_VOLUMES)
        point_lights_list_light(p, t.width, t.height, out);
}

static bool make_buffer(pass *p, lists_buffer which, uint64_t size) {
    gpu *device = p->host->device;
    uint64_t most = gpu_get_info(device)->max_storage_range;
    if (size > most)
        return err_set(
            "%s: lists of %u point lights for %llu bytes of tiles are more than the device "
            "binds (%llu); fewer point lights, point_lights_by = \"all\" or a smaller picture need "
            "less",
            p->label, p->point_lights->count, (unsigned long long)size, (unsigned long long)most);
    return gpu_buffer_make(device, &p->point_lights->buffers[which], labels[which], size);
}

static bool make_buffers(pass *p, const tiling *t) {
    for (lists_buffer i = 0; i < POINT_LIGHT_BUFFERS; i++)
        if (!make_buffer(p, i, bytes_of(p, t, i))) return false;
    return true;
}

static bool run_lists(pass *p, point_lights_kernel index, const tiling *t, uint32_t x, uint32_t y) {
    kernel *k = pass_use_provided(p, &pass_point_lights_provider, index);
    if (!k) return false;
    kernel_set_int(k, N_width, (int32_t)t->width);
    kernel_set_int(k, N_height, (int32_t)t->height);
    kernel_set_int(k, N_point_light_count, (int32_t)p->point_lights->count);
    kernel_set_int(k, N_point_light_words, (int32_t)t->words);
    kernel_set_int(k, N_point_light_tiles_across, (int32_t)t->across);
    return kernel_run(k, p->host->device, x, y, 1);
}

static bool point_lights_draw_volumes(pass *p, uint32_t width, uint32_t height) {
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

static bool point_lights_prepare(pass *p) {
    if (!p->point_lights) return true;
    const tiling t = tiling_of(p);
    uint32_t x = (t.across + GROUP - 1) / GROUP * GROUP,
             rows = (p->point_lights->count + x - 1) / x;
    point_lights_way way = p->point_lights->way;
    if (way == POINT_LIGHTS_TILES && rows < t.height) rows = t.height;
    return make_buffers(p, &t) && run_lists(p, POINT_LIGHTS_RECORDS, &t, x, rows) &&
           (way != POINT_LIGHTS_TILES ||
            run_lists(p, POINT_LIGHTS_MASKS, &t, t.across * t.words, t.down)) &&
           (way != POINT_LIGHTS_VOLUMES || point_lights_draw_volumes(p, t.width, t.height));
}

enum { POINT_LIGHT_LIGHT = POINT_LIGHT_BUFFERS, POINT_LIGHT_SLOTS };
static const char *const slots[POINT_LIGHT_SLOTS] = {"PointLightRecords", "PointLightMasks",
                                                     "PointLightBounds", "PointLightLight"};

static bool point_lights_bind(pass *p, int slot, gpu_binding *out) {
    if (!p->point_lights) return false;
    out->sampler = GPU_NEAREST_CLAMP;
    if (slot == POINT_LIGHT_LIGHT)
        out->image = p->point_lights->light;
    else
        out->buffer = p->point_lights->buffers[slot];
    return out->image || out->buffer;
}

const pass_provider pass_point_lights_provider = {
    .slots = {slots, POINT_LIGHT_SLOTS},
    .find = find_point_lights,
    .defines = point_lights_defines,
    PASS_KERNELS,
    .uses = uses_point_lights,
    .wants = wants_kernel,
    .target = point_lights_target,
    .list_memory = point_lights_list_memory,
    .prepare = point_lights_prepare,
    .bind = point_lights_bind,
    .destroy = point_lights_destroy,
};
