// Reference: bounds of the extinction first, then paths through them. What it has gathered holds as
// long as nothing changes that the picture depends on.
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include "scene/bvh.h"
#include "shared.h"
#include <string.h>

enum { CELLS = 32 }; // along each side of the box, of the bounds

typedef struct reference_state {
    shader_binary bounds;
    gpu_pipeline *bounds_pipeline;
    unsigned char *bounds_block;
    hash128 seen;     // of all that the picture depends on, in the last execution
    int32_t executed; // times, since it changed
    uint32_t samples; // a pixel, since then
} reference_state;

bool reference_declare(pass *p) {
    int bounds = pass_find_image(p, "majorants");
    p->state = arena_alloc(p->host->memory, sizeof(reference_state));
    if (!pass_check_density(p)) return false;
    p->images[bounds] = graph_add_image(
        p->host->graph,
        &(graph_image_desc){
            .name = arena_format(p->host->memory, "%s.%s", p->label, p->face->images[bounds].name),
            .format = p->formats[bounds],
            .width = CELLS,
            .height = CELLS,
            .depth = CELLS,
        });
    return p->images[bounds].id && pass_declare_images(p) && pass_add_to_graph(p);
}

static bool meshes_glow(const pass *p) {
    return p->host->bvh && scene_bvh_glows(p->host->bvh);
}

static bool compile_both(pass *p, shader_binary *bounds) {
    const shader_define glow = {"MESHES_GLOW", meshes_glow(p) ? "1" : "0"};
    return pass_compile(p, "pass/reference_majorants.comp", SHADER_COMPUTE, NULL, 0, bounds) &&
           pass_compile(p, p->shader, SHADER_COMPUTE, &glow, 1, &p->binary);
}

bool reference_check(pass *p) {
    shader_binary bounds;
    return compile_both(p, &bounds);
}

bool reference_build(pass *p) {
    reference_state *s = p->state;
    if (!compile_both(p, &s->bounds)) return false;
    s->bounds_pipeline = pass_create_compute(p, &s->bounds);
    p->pipeline = pass_create_compute(p, &p->binary);
    s->bounds_block = arena_alloc(p->host->memory, pass_block_size(&s->bounds) + 16);
    return s->bounds_pipeline && p->pipeline;
}

bool reference_allocate(pass *p) {
    return !meshes_glow(p) || scene_bvh_allocate_surfaces(p->host->bvh, p->host->device);
}

void reference_list_memory(const pass *p, budget_list *out) {
    if (meshes_glow(p) && budget_list_first(out, p->host->bvh))
        scene_bvh_list_surfaces(p->host->bvh, out);
}

// Members that say how far the picture is.
static const char *const progress[] = {"executed", "paths", "part"};

static void write_progress(const shader_binary *binary, unsigned char *block,
                           const int32_t values[COUNT_OF(progress)]) {
    for (size_t i = 0; i < COUNT_OF(progress); i++)
        pass_write_member(binary, block, progress[i], &values[i], sizeof values[i]);
}

bool reference_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    box3 box;
    if (!pass_density_box(p, &box)) return false;
    pass_write_box(binary, block, box);
    write_progress(binary, block, (int32_t[COUNT_OF(progress)]){0}); // blocks are compared
    return true;
}

// ---- in a frame -------------------------------------------------------------------------------

// Parameters stand for all that moves by them without being a number of this pass, such as meshes.
static hash128 hash_inputs(const pass *p) {
    const struct frame_block *f = p->host->frame;
    const field_context *c = p->host->context;
    const struct {
        shared_mat4 view;
        shared_vec4 eye, lens, sun, sun_radiance, zenith, horizon, night[2];
        shared_uvec4 size;
        double time;
    } camera = {f->view,         f->eye,        f->lens,        f->sun_direction,
                f->sun_radiance, f->sky_zenith, f->sky_horizon, {f->night_zenith, f->night_horizon},
                f->size,         c->time};
    hash128 all = hash_bytes(&camera, sizeof camera);
    all = hash_combine(all, hash_bytes(p->host->lights, sizeof *p->host->lights));
    all = hash_combine(all, hash_bytes(p->block, pass_block_size(&p->binary)));
    all = hash_combine(all, hash_bytes(p->numbers, field_program_block_size(p->program)));
    if (p->host->bvh) {
        uint64_t version = scene_bvh_version(p->host->bvh);
        all = hash_combine(all, hash_bytes(&version, sizeof version));
    }
    if (c->param_count)
        all = hash_combine(all, hash_bytes(c->params, c->param_count * sizeof *c->params));
    for (size_t i = 0; i < p->palette_count; i++) {
        uint32_t version = p->palettes[i].version;
        all = hash_combine(all, hash_bytes(&version, sizeof version));
    }
    return all;
}

static void count_execution(pass *p) {
    reference_state *s = p->state;
    hash128 seen = hash_inputs(p);
    bool same = !p->host->fresh && seen.low == s->seen.low && seen.high == s->seen.high;
    s->executed = same ? s->executed + 1 : 0;
    s->samples = (uint32_t)(s->executed + 1) * (uint32_t)pass_evaluate(p, "samples");
    s->seen = seen;
}

static bool dispatch(pass *p, gpu_pipeline *pipeline, const shader_binary *binary,
                     unsigned char *block, const char *over) {
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {.pipeline = pipeline, .bindings = bindings};
    graph_get_size(p->host->graph, p->images[pass_find_image(p, over)], desc.threads);
    return pass_bind(p, binary, block, NULL, 0, bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

static bool trace(pass *p) {
    const reference_state *s = p->state;
    int32_t samples = (int32_t)pass_evaluate(p, "samples");
    int32_t paths = gpu_get_profile(p->host->device)->reference_single_paths ? 1 : samples;
    for (int32_t part = 0; part < samples / paths; part++) {
        write_progress(&p->binary, p->block, (int32_t[]){s->executed, paths, part});
        if (!dispatch(p, p->pipeline, &p->binary, p->block, "color")) return false;
    }
    return true;
}

bool reference_record(pass *p) {
    reference_state *s = p->state;
    if (!pass_prepare(p) || !pass_fill_block(p, &s->bounds, s->bounds_block)) return false;
    count_execution(p);
    write_progress(&s->bounds, s->bounds_block, (int32_t[COUNT_OF(progress)]){s->executed});
    return dispatch(p, s->bounds_pipeline, &s->bounds, s->bounds_block, "majorants") && trace(p);
}

bool pass_samples(const pass *p, uint32_t *out) {
    const reference_state *s = p->state;
    if (!p->type || p->type->record != reference_record) return false;
    *out = s->samples;
    return true;
}

void reference_destroy(pass *p) {
    reference_state *s = p->state;
    if (s && s->bounds_pipeline) gpu_pipeline_destroy(p->host->device, s->bounds_pipeline);
}
