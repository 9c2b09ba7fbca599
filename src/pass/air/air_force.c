// The force field of simulated air, and its guide, as images that steps sample: evaluated anew so
// many times a second of the simulation, whatever is drawn. A force that is the same everywhere
// needs none of this (air_constant_force).
#include "pass/air/air_parts.h"
#include <math.h>

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

bool air_is_guided(const pass *p) {
    return air_of(p)->kind->guide_cells && pass_given_field(p, N_guide);
}

// ---- images -----------------------------------------------------------------------------------

static air_baked *baked_by(air *a, int which) {
    return which == AIR_FORCE ? &a->force : &a->guide;
}

static gpu_image_desc describe(const air *a, int which) {
    uint32_t n[3];
    for (int i = 0; i < 3; i++) n[i] = (a->desc.size[i] + AIR_COARSER - 1) / AIR_COARSER;
    if (which == AIR_GUIDE) a->kind->guide_cells(a, true, n);
    return (gpu_image_desc){
        .label = which == AIR_FORCE ? "force" : "guide",
        .format = GPU_RGBA16F,
        .width = n[0],
        .height = n[1],
        .depth = n[2],
        .use = GPU_USE_SAMPLED | GPU_USE_STORAGE,
    };
}

gpu_image_desc air_describe_force(const air *a, const char *label) {
    gpu_image_desc desc = describe(a, AIR_FORCE);
    desc.label = label;
    return desc;
}

static bool lacks_image(const air *a, int which) {
    const air_baked *b = which == AIR_FORCE ? &a->force : &a->guide;
    return !b->image && pass_has_kernel(a->pass, which);
}

void air_list_force(const air *a, budget_list *out) {
    for (int i = AIR_FORCE; i <= AIR_GUIDE; i++) {
        if (!lacks_image(a, i)) continue;
        const gpu_image_desc desc = describe(a, i);
        budget_list_add(out, desc.label, gpu_image_bytes(&desc));
    }
}

bool air_allocate_force(air *a) {
    for (int i = AIR_FORCE; i <= AIR_GUIDE; i++) {
        if (!lacks_image(a, i)) continue;
        const gpu_image_desc desc = describe(a, i);
        baked_by(a, i)->image = gpu_image_create(a->pass->host->device, &desc);
        if (!baked_by(a, i)->image) return false;
    }
    a->kind->take_force(a, a->templates.image ? a->templates.image : a->force.image);
    return true;
}

void air_destroy_force(air *a) {
    for (int i = AIR_FORCE; i <= AIR_GUIDE; i++)
        gpu_image_destroy(a->pass->host->device, baked_by(a, i)->image);
}

// ---- what lies in them ------------------------------------------------------------------------

static bool bake(air *a, int which) {
    pass *p = a->pass;
    gpu_image *image = baked_by(a, which)->image;
    const gpu_image_desc *size = gpu_image_get_desc(image);
    uint32_t n[3] = {size->width, size->height, size->depth};
    if (which == AIR_GUIDE) a->kind->guide_cells(a, false, n);
    const float cells[3] = {(float)n[0], (float)n[1], (float)n[2]};
    kernel *k = pass_prepare(p) ? pass_use(p, which) : NULL;
    if (!k) return false;
    kernel_bind_image(k, N_acceleration, image);
    kernel_set(k, N_count, cells, sizeof cells);
    return kernel_run(k, p->host->device, n[0], n[1], n[2]);
}

static bool push(air *a, int which) {
    air_baked *b = baked_by(a, which);
    double begin, end;
    if (!b->image) return true;
    uint64_t turn = air_turn(a, &begin, &end);
    if (turn == b->turn) return true;
    b->turn = turn;
    // As of the turn's first step, also where a state is taken over in the middle of one.
    pass_host *host = a->pass->host;
    const field_context *now = host->context;
    field_context first = *now;
    first.time = begin;
    host->context = &first;
    bool done = bake(a, which);
    host->context = now;
    return done;
}

bool air_push(air *a) {
    return push(a, AIR_FORCE) && push(a, AIR_GUIDE);
}
