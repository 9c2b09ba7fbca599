// The force field of simulated air, as an image that steps sample: evaluated anew so many times a
// second of the simulation, whatever is drawn. A force that is the same everywhere needs none of
// this (lbm_numbers.c).
#include "base/memory.h"
#include "pass/lbm_parts.h"
#include <string.h>

static const char shader[] = "pass/lbm/force.comp";
enum { COARSER = 2 }; // cells of the lattice along a side of one of the image's

bool lbm_air_compile_force(lbm_air *a) {
    return !lbm_air_force_varies(a->pass) ||
           pass_compile(a->pass, shader, SHADER_COMPUTE, NULL, 0, &a->force.shader);
}

bool lbm_air_build_force(lbm_air *a) {
    if (!lbm_air_force_varies(a->pass)) return true;
    lbm_force *f = &a->force;
    f->block = arena_alloc(a->pass->host->memory, pass_block_size(&f->shader) + 16);
    f->pipeline = pass_create_compute(a->pass, &f->shader);
    return f->pipeline != NULL;
}

bool lbm_air_allocate_force(lbm_air *a) {
    const uint32_t *n = a->desc.size;
    lbm_force *f = &a->force;
    if (f->image || !f->pipeline) return true;
    f->image = gpu_image_create(a->pass->host->device, &(gpu_image_desc){
                                                           .label = "force",
                                                           .format = GPU_RGBA16F,
                                                           .width = (n[0] + COARSER - 1) / COARSER,
                                                           .height = (n[1] + COARSER - 1) / COARSER,
                                                           .depth = (n[2] + COARSER - 1) / COARSER,
                                                           .use = GPU_USE_SAMPLED | GPU_USE_STORAGE,
                                                       });
    if (!f->image) return false;
    lbm_set_force(a->solver, f->image, (float)sim_acceleration(&a->units, 1));
    return true;
}

void lbm_air_destroy_force(lbm_air *a) {
    gpu *device = a->pass->host->device;
    if (a->force.pipeline) gpu_pipeline_destroy(device, a->force.pipeline);
    if (a->force.image) gpu_image_destroy(device, a->force.image);
}

static bool bake(pass *p, lbm_force *f) {
    const gpu_image_desc *size = gpu_image_get_desc(f->image);
    const pass_override overrides[] = {{"acceleration", {.image = f->image}}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc dispatch = {.pipeline = f->pipeline,
                                  .bindings = bindings,
                                  .threads = {size->width, size->height, size->depth}};
    return pass_prepare(p) && pass_fill_block(p, &f->shader, f->block) &&
           pass_bind(p, &f->shader, f->block, overrides, COUNT_OF(overrides), bindings,
                     &dispatch.binding_count) &&
           gpu_dispatch(p->host->device, &dispatch);
}

bool lbm_air_push(lbm_air *a) {
    double begin, end;
    if (!a->force.image) return true;
    uint64_t turn = lbm_air_turn(a, &begin, &end);
    if (turn == a->force.turn) return true;
    a->force.turn = turn;
    // As of the turn's first step, also where a state is taken over in the middle of one.
    pass_host *host = a->pass->host;
    const field_context *now = host->context;
    field_context first = *now;
    first.time = begin;
    host->context = &first;
    bool done = bake(a->pass, &a->force);
    host->context = now;
    return done;
}
