// A guide of burning gas: it holds large eddies, on a level of multigrid.
#include "base/error.h"
#include "sim/pyro_impl.h"
#include <math.h>
#include <string.h>

// The side of its cells in cells of the velocity: of a cube of their volume.
static double side_of(const pyro *p, const pyro_level *l) {
    double sides = 1;
    for (int i = 0; i < 3; i++) sides *= (double)p->levels[0].size[i] / l->size[i];
    return cbrt(sides);
}

static const pyro_level *level_of(const pyro *p, const pyro_numbers *n) {
    const double wanted = (double)n->guide_size / (double)pyro_flow_cell(p, n);
    const pyro_level *best = &p->levels[1];
    for (uint32_t i = 2; i < p->level_count && wanted > 0; i++)
        if (fabs(log(side_of(p, &p->levels[i]) / wanted)) < fabs(log(side_of(p, best) / wanted)))
            best = &p->levels[i];
    return best;
}

void pyro_find_guide_cells(const pyro *p, const pyro_numbers *n, uint32_t out[3]) {
    memcpy(out, level_of(p, n)->size, sizeof p->levels->size);
}

void pyro_find_most_guide_cells(const pyro *p, uint32_t out[3]) {
    memcpy(out, p->levels[1].size, sizeof p->levels->size);
}

void pyro_set_guide(pyro *p, gpu_image *guide) {
    p->guide = guide;
}

// ---- what it adds -----------------------------------------------------------------------------

static gpu_image_desc describe(const pyro *p) {
    const uint32_t *n = p->levels[1].size;
    return (gpu_image_desc){.label = "pull of a guide",
                            .format = GPU_RGBA16F,
                            .width = n[0],
                            .height = n[1],
                            .depth = n[2],
                            .use = GPU_USE_SAMPLED | GPU_USE_STORAGE};
}

bool pyro_allocate_guide(pyro *p, gpu *g) {
    const gpu_image_desc desc = describe(p);
    if (!p->desc.guide || p->pull) return true;
    p->pull = gpu_image_create(g, &desc);
    return p->pull != NULL;
}

void pyro_list_guide(const pyro *p, budget_list *out) {
    const gpu_image_desc desc = describe(p);
    if (p->desc.guide && !p->pull) budget_list_add(out, desc.label, gpu_image_bytes(&desc));
}

static void set_cells(const pyro *p, kernel *k, const pyro_numbers *n) {
    const uint32_t *size = level_of(p, n)->size;
    const float cells[3] = {(float)size[0], (float)size[1], (float)size[2]};
    kernel_set(k, N_guide_cells, cells, sizeof cells);
}

bool pyro_find_pull(pyro *p, gpu *g, const pyro_numbers *n) {
    if (!p->guide) return err_set("a guide is wanted, and none was given");
    const uint32_t *size = level_of(p, n)->size;
    const float halves = p->desc.advection == PYRO_REFLECTION ? 2 : 1; // each of which adds it
    pyro_stage(p, g, "pyro.guide");
    kernel *k = pyro_use(p, PYRO_K_GUIDE);
    set_cells(p, k, n);
    kernel_set(k, N_inflow, n->inflow, sizeof n->inflow);
    kernel_set_float(k, N_guide_share, (1 - expf(-n->guide_rate * n->dt)) / halves);
    kernel_bind_image(k, N_guide, p->guide);
    kernel_bind_image(k, N_pull, p->pull);
    return kernel_run(k, g, size[0], size[1], size[2]);
}

void pyro_set_pull(const pyro *p, kernel *k, const pyro_numbers *n) {
    set_cells(p, k, n);
    kernel_bind_image(k, N_pull, p->pull);
}
