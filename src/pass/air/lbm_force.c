// The force field of simulated air, as an image that steps sample: evaluated anew so many times a
// second of the simulation, whatever is drawn. A force that is the same everywhere needs none of
// this (lbm_numbers.c).
#include "pass/air/lbm_parts.h"

enum { COARSER = 2 }; // cells of the lattice along a side of one of the image's

static gpu_image_desc describe(const lbm_air *a) {
    const uint32_t *n = a->desc.size;
    return (gpu_image_desc){
        .label = "force",
        .format = GPU_RGBA16F,
        .width = (n[0] + COARSER - 1) / COARSER,
        .height = (n[1] + COARSER - 1) / COARSER,
        .depth = (n[2] + COARSER - 1) / COARSER,
        .use = GPU_USE_SAMPLED | GPU_USE_STORAGE,
    };
}

static bool lacks_image(const lbm_air *a) {
    return !a->force.image && pass_has_kernel(a->pass, LBM_FORCE);
}

void lbm_air_list_force(const lbm_air *a, budget_list *out) {
    const gpu_image_desc desc = describe(a);
    if (lacks_image(a)) budget_list_add(out, desc.label, gpu_image_bytes(&desc));
}

bool lbm_air_allocate_force(lbm_air *a) {
    const gpu_image_desc desc = describe(a);
    lbm_force *f = &a->force;
    if (!lacks_image(a)) return true;
    f->image = gpu_image_create(a->pass->host->device, &desc);
    if (!f->image) return false;
    lbm_set_force(a->solver, f->image, (float)sim_acceleration(&a->units, 1));
    return true;
}

void lbm_air_destroy_force(lbm_air *a) {
    gpu_image_destroy(a->pass->host->device, a->force.image);
}

static bool bake(pass *p, lbm_force *f) {
    const gpu_image_desc *size = gpu_image_get_desc(f->image);
    kernel *k = pass_prepare(p) ? pass_use(p, LBM_FORCE) : NULL;
    if (!k) return false;
    kernel_bind_image(k, N_acceleration, f->image);
    return kernel_run(k, p->host->device, size->width, size->height, size->depth);
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
