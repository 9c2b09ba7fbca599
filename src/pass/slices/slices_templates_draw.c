// Drawing templates: their pictures on the device, and the dispatch that puts all of them into all
// slices.
#include "pass/slices/slices_templates_parts.h"

static uint32_t cells_of(const slices_flow *f) {
    return gpu_get_profile(f->pass->host->device)->templates_cells;
}

// ---- building ---------------------------------------------------------------------------------

void slices_templates_define_draw(const slices_flow *f, pass_defines *out) {
    const slices_templates *t = f->templates;
    slices_templates_define(f, out);
    pass_define_number(f->pass, out, "TEMPLATES_CELLS", cells_of(f));
    pass_define_number(f->pass, out, "HAND", t->hand.taken ? SLICES_HAND_MOST : 0);
    pass_define_flag(out, "PRESSES", slices_has_pressing(f->pass));
    pass_define_flag(out, "PUSHES", slices_has_pushing(f->pass));
}

// ---- pictures ---------------------------------------------------------------------------------

bool slices_templates_make_images(slices_flow *f) {
    slices_templates *t = f->templates;
    t->set.more = t->hand.taken ? SLICES_HAND_MOST : 0;
    return template_set_make_images(&t->set, f->pass->host->device, slices_hand_tile, t);
}

// ---- a step -----------------------------------------------------------------------------------

kernel *slices_templates_use(const slices_flow *f, pass *p, size_t index) {
    const slices_templates *t = f->templates;
    kernel *k = pass_use(p, index);
    if (!k) return NULL;
    flow_bind(f->solver, k, pass_solver_places(p, index));
    kernel_bind_buffer(k, N_Templates, t->set.instances);
    kernel_bind_buffer(k, N_TemplateMasks, t->set.masks);
    kernel_bind_image(k, N_TemplateImages, t->set.images);
    return k;
}

// Whether others have written what the flow is given in this step.
static bool has_sources(const slices_flow *f) {
    for (size_t i = 0; i < f->part_count; i++)
        if (!slices_is_template(f->parts[i]) && !slices_is_obstacle(f->parts[i])) return true;
    return false;
}

bool slices_templates_draw(slices_flow *f) {
    slices_templates *t = f->templates;
    const uint32_t *size = f->desc.size, cells = cells_of(f);
    gpu *device = f->pass->host->device;
    if (t->repainted && !template_set_write_images(&t->set, device)) return false;
    t->repainted = false;
    kernel *k = slices_templates_use(f, f->pass, SLICES_DRAW);
    if (!k) return false;
    kernel_set_int(k, N_alone, !has_sources(f));
    kernel_set_int(k, N_parity, (int32_t)t->set.parity);
    kernel_set_float(k, N_time_step, (float)f->clock.step);
    slices_hand_set(f, k);
    return kernel_run(k, device, size[0], (size[1] + cells - 1) / cells, f->desc.count);
}
