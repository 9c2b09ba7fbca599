// Templates of a flow. Before each step of the solver every group's shader brings its instances on
// by the step, and one dispatch puts those of all groups into all slices. All of it is on the
// device, and depends on seeds and steps alone: what is drawn, and how often, changes nothing.
#include "base/error.h"
#include "base/hash.h"
#include "pass/slices/slices_templates_parts.h"

enum { ROWS = 4 }; // of an instance (shaders/pass/slices/templates.glsl)

slices_templates *slices_templates_make(slices_flow *f) {
    if (!f->templates) f->templates = arena_alloc(f->pass->host->memory, sizeof *f->templates);
    return f->templates;
}

gpu_buffer *slices_templates_buffer(const pass *p) {
    const slices_templates *t = slices_of(p)->templates;
    return t && t->set.total ? t->set.instances : NULL;
}

// ---- declaring --------------------------------------------------------------------------------

static bool has_kind(const pass *p, size_t kind) {
    const slices_templates *t = slices_of(p)->templates;
    return t && (t->hand.taken || template_set_has(&t->set, N_kind, kind));
}

bool slices_has_pressing(const pass *p) {
    return has_kind(p, 0);
}

bool slices_has_pushing(const pass *p) {
    return has_kind(p, 1);
}

bool slices_add_templates(pass *p, pass *group, const picture *image, uint32_t count) {
    slices_flow *f = slices_of(p);
    if (!template_set_add(&slices_templates_make(f)->set, f, group, image, count, " in each slice"))
        return false;
    slices_add_part(f, group);
    return true;
}

// ---- tiles ------------------------------------------------------------------------------------

// Cells along a side: 16, or as many as leave at most 32 tiles along each side of a slice.
static uint32_t tile_side(const slices_flow *f) {
    const uint32_t *size = f->desc.size, most = size[0] > size[1] ? size[0] : size[1];
    return template_tile_side(most, 16);
}

static uint64_t mask_bytes(const slices_flow *f) {
    const uint32_t *size = f->desc.size, side = tile_side(f);
    const uint64_t tiles = (uint64_t)((size[0] + side - 1) / side) * ((size[1] + side - 1) / side);
    return template_mask_bytes(&f->templates->set, tiles * f->desc.count);
}

void slices_templates_define(const slices_flow *f, pass_defines *out) {
    out->count += flow_defines(f->solver, out->items + out->count);
    pass_define_number(f->pass, out, "TEMPLATES_TOTAL", f->templates->set.total);
    pass_define_number(f->pass, out, "TEMPLATES_TILE", tile_side(f));
}

// ---- a group ----------------------------------------------------------------------------------

static bool defines_of_group(pass *p, size_t index, pass_defines *out) {
    const template_group *g = p->state;
    (void)index;
    slices_templates_define(g->owner, out);
    return true;
}

// Where the region may be, in widths of a slice.
static bool region_box(const pass *p, float low[2], float high[2]) {
    const template_group *g = p->state;
    const slices_flow *f = g->owner;
    const uint32_t *size = f->desc.size;
    box3 box = box3_infinite();
    const field *region = pass_given_field(p, N_region);
    if (region && !field_bounds(region, p->host->context, &box)) return false;
    float height = (float)size[1] / (float)size[0];
    low[0] = clampf(box.min.x, 0, 1), high[0] = clampf(box.max.x, 0, 1);
    low[1] = clampf(box.min.y, 0, height), high[1] = clampf(box.max.y, 0, height);
    return true;
}

static bool update_group(pass *p) {
    const template_group *g = p->state;
    const slices_flow *f = g->owner;
    const uint32_t seeds[3] = {slices_seed(f), (uint32_t)pass_value(p, N_seed), g->index};
    float low[2], high[2];
    if (!region_box(p, low, high)) return false;
    pass_set_int(p, N_key, (int32_t)(uint32_t)hash64(seeds, sizeof seeds));
    pass_set_int(p, N_first, (int32_t)g->first);
    pass_set_int(p, N_count, (int32_t)g->count);
    pass_set_int(p, N_parity, (int32_t)f->templates->set.parity);
    pass_set_float(p, N_tile, (float)g->index);
    pass_set_float(p, N_time_step, (float)f->clock.step);
    pass_set(p, N_box_min, low, sizeof low);
    pass_set(p, N_box_max, high, sizeof high);
    return true;
}

// ---- on the device ----------------------------------------------------------------------------

static uint64_t instance_bytes(const slices_flow *f) {
    return template_instance_bytes(&f->templates->set, ROWS, f->desc.count);
}

void slices_templates_list_memory(const slices_flow *f, budget_list *out) {
    template_set_list_memory(&f->templates->set, instance_bytes(f), mask_bytes(f), out);
}

bool slices_templates_allocate(slices_flow *f) {
    return slices_templates_make_images(f) &&
           template_set_allocate(&f->templates->set, f->pass->host->device, instance_bytes(f),
                                 mask_bytes(f));
}

void slices_templates_destroy(slices_flow *f) {
    template_set_destroy(&f->templates->set, f->pass->host->device);
    *f->templates = (slices_templates){0};
}

// ---- a step -----------------------------------------------------------------------------------

static bool run_group(pass *p) {
    const template_group *g = p->state;
    const slices_flow *f = g->owner;
    kernel *k = pass_prepare(p) ? slices_templates_use(f, p, 0) : NULL;
    return (k && kernel_run(k, p->host->device, g->count, f->desc.count, 1)) ||
           err_prefix("%s: ", p->label);
}

bool slices_templates_run(slices_flow *f) {
    template_set *t = &f->templates->set;
    template_set_begin(t, f->pass->host->device);
    return template_set_each(t, run_group) && slices_templates_draw(f);
}

static const pass_kernel kernel_of_group = {0};

const pass_type slices_templates_type = {
    .name = "slices_templates",
    .constructed = true,
    .shader = "pass/slices/slices_templates.comp",
    .kernels = &kernel_of_group,
    .kernel_count = 1,
    .names = {slices_names, SLICES_NAME_COUNT},
    .solver = &flow_kernel_table,
    .unscaled = true,
    .runs_inside = true,
    .defines = defines_of_group,
    .update = update_group,
};
