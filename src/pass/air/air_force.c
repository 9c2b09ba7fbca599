// The force field of simulated air, as an image that steps sample: evaluated anew so many times a
// second of the simulation, whatever is drawn. A force that is the same everywhere needs none of
// this (air_constant_force).
#include "pass/air/air_parts.h"
#include <math.h>

enum { COARSER = 2 }; // cells of the lattice along a side of one of the image's

bool air_force_varies(const pass *p) {
    const field *force = pass_given_field(p, N_force);
    return force && !force->uniform;
}

bool air_constant_force(const pass *p, float out[3]) {
    const field *force = pass_given_field(p, N_force);
    float value[4] = {0};
    for (int i = 0; i < 3; i++) out[i] = 0;
    if (!force || !force->uniform) return true;
    if (!field_eval(force, p->host->context, (float3){0, 0, 0}, value)) return false;
    for (int i = 0; i < 3; i++) {
        const float v = value[force->components == 1 ? 0 : i];
        if (isfinite(v)) out[i] = v;
    }
    return true;
}

static gpu_image_desc describe(const air *a) {
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

static bool lacks_image(const air *a) {
    return !a->force.image && pass_has_kernel(a->pass, AIR_FORCE);
}

void air_list_force(const air *a, budget_list *out) {
    const gpu_image_desc desc = describe(a);
    if (lacks_image(a)) budget_list_add(out, desc.label, gpu_image_bytes(&desc));
}

bool air_allocate_force(air *a) {
    const gpu_image_desc desc = describe(a);
    air_force *f = &a->force;
    if (!lacks_image(a)) return true;
    f->image = gpu_image_create(a->pass->host->device, &desc);
    if (!f->image) return false;
    return a->kind->take_force(a);
}

void air_destroy_force(air *a) {
    gpu_image_destroy(a->pass->host->device, a->force.image);
}

static bool bake(pass *p, air_force *f) {
    const gpu_image_desc *size = gpu_image_get_desc(f->image);
    kernel *k = pass_prepare(p) ? pass_use(p, AIR_FORCE) : NULL;
    if (!k) return false;
    kernel_bind_image(k, N_acceleration, f->image);
    return kernel_run(k, p->host->device, size->width, size->height, size->depth);
}

bool air_push(air *a) {
    double begin, end;
    if (!a->force.image) return true;
    uint64_t turn = air_turn(a, &begin, &end);
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
