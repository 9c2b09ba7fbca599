// Shade: one shader, in two variants (rays.h). Before many rays it is found out what may stand
// between each tile of the picture and each light; for single rays that takes longer than it saves.
#include "base/error.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include "pass/rays.h"
#include "pass/shadow_maps.h"
#include <string.h>

enum { TILE = 16, LIST_WORDS = 16, MAX_LISTED = 64 }; // as in shade/shafts.glsl, shade_shafts.comp

typedef struct shade_state {
    shader_binary binary[2]; // with few and with many rays
    gpu_pipeline *pipeline[2];
    shader_binary shafts;
    gpu_pipeline *shafts_pipeline;
    unsigned char *shafts_block;
    gpu_buffer *lists; // of leaves, for each tile and light
} shade_state;

bool shade_declare(pass *p) {
    pass_drop_matte(p, "surface", "emission");
    return pass_choose_shadows(p) && pass_declare_images(p) && pass_add_to_graph(p);
}

static bool compile(pass *p, shade_state *s) {
    for (int i = 0; i < 2; i++)
        if (!pass_compile(p, p->shader, SHADER_COMPUTE, &pass_rays_variants[i], 1, &s->binary[i]))
            return false;
    return pass_compile(p, "pass/shade_shafts.comp", SHADER_COMPUTE, NULL, 0, &s->shafts);
}

bool shade_check(pass *p) {
    shade_state s;
    return compile(p, &s);
}

static bool make(pass *p, bool many) {
    shade_state *s = p->state;
    if (!s->pipeline[many]) s->pipeline[many] = pass_create_compute(p, &s->binary[many]);
    if (many && !s->shafts_pipeline) s->shafts_pipeline = pass_create_compute(p, &s->shafts);
    return s->pipeline[many] && (!many || s->shafts_pipeline);
}

bool shade_build(pass *p) {
    shade_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    bool can[2];
    pass_rays_foresee(p, can);
    if (!compile(p, s)) return false;
    p->binary = s->binary[1]; // has all that the other has
    s->shafts_block = arena_alloc(p->host->memory, pass_block_size(&s->shafts) + 16);
    return (!can[0] || make(p, false)) && (!can[1] || make(p, true));
}

// ---- in a frame -------------------------------------------------------------------------------

// The variant of this frame. One that was not foreseen is made when a number first asks for it.
static bool choose(pass *p) {
    shade_state *s = p->state;
    bool many = pass_rays_many(p);
    if (!make(p, many)) return false;
    p->binary = s->binary[many];
    p->pipeline = s->pipeline[many];
    return true;
}

static uint32_t lights_to_list(pass *p) {
    if (pass_evaluate(p, "shadow_samples") < 2) return 0;
    graph_image lights = p->images[pass_find_image(p, "lights")];
    uint32_t size[3];
    if (!lights.id) return p->host->lights->count.v[0];
    graph_get_size(p->host->graph, lights, size);
    return size[1];
}

// How many lights get lists, and memory for these.
static bool make_lists(pass *p, uint32_t tiles, int32_t *lights) {
    shade_state *s = p->state;
    uint64_t each = (uint64_t)tiles * LIST_WORDS * sizeof(uint32_t);
    uint64_t most = gpu_get_info(p->host->device)->max_storage_range / each, wanted;
    wanted = lights_to_list(p);
    if (wanted > MAX_LISTED) wanted = MAX_LISTED;
    if (wanted > most) wanted = most;
    *lights = (int32_t)wanted;
    uint64_t size = wanted ? wanted * each : LIST_WORDS * sizeof(uint32_t);
    if (s->lists && gpu_buffer_size(s->lists) >= size) return true;
    gpu_buffer_destroy(p->host->device, s->lists);
    s->lists = gpu_buffer_create(
        p->host->device,
        &(gpu_buffer_desc){.label = "shafts", .size = size, .kind = GPU_BUFFER_DEVICE});
    return s->lists != NULL;
}

static bool dispatch(pass *p, gpu_pipeline *pipeline, const shader_binary *binary,
                     unsigned char *block, uint32_t width, uint32_t height) {
    const shade_state *s = p->state;
    const pass_override lists = {.name = "Shafts", .binding = {.buffer = s->lists}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {
        .pipeline = pipeline, .bindings = bindings, .threads = {width, height, 1}};
    return pass_bind(p, binary, block, &lists, 1, bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

static bool find_shafts(pass *p, const uint32_t size[3], uint32_t across, uint32_t down) {
    shade_state *s = p->state;
    const int32_t width = (int32_t)size[0], height = (int32_t)size[1];
    pass_write_member(&s->shafts, s->shafts_block, "width", &width, sizeof width);
    pass_write_member(&s->shafts, s->shafts_block, "height", &height, sizeof height);
    return dispatch(p, s->shafts_pipeline, &s->shafts, s->shafts_block,
                    across * s->shafts.local_size[0], down);
}

bool shade_record(pass *p) {
    shade_state *s = p->state;
    uint32_t size[3], across, down;
    int32_t listed;
    graph_get_size(p->host->graph, p->images[pass_find_image(p, "color")], size);
    across = (size[0] + TILE - 1) / TILE;
    down = (size[1] + TILE - 1) / TILE;
    if (!choose(p) || !pass_prepare(p) || !make_lists(p, across * down, &listed)) return false;
    pass_write_member(&p->binary, p->block, "shaft_lights", &listed, sizeof listed);
    pass_write_member(&s->shafts, s->shafts_block, "shaft_lights", &listed, sizeof listed);
    return (!listed || find_shafts(p, size, across, down)) &&
           dispatch(p, p->pipeline, &p->binary, p->block, size[0], size[1]);
}

void shade_destroy(pass *p) {
    shade_state *s = p->state;
    if (!s) return;
    for (int i = 0; i < 2; i++)
        if (s->pipeline[i]) gpu_pipeline_destroy(p->host->device, s->pipeline[i]);
    p->pipeline = NULL; // one of these
    if (s->shafts_pipeline) gpu_pipeline_destroy(p->host->device, s->shafts_pipeline);
    if (s->lists) gpu_buffer_destroy(p->host->device, s->lists);
}
