// Templates of a flow. Before each step of the solver every group's shader brings its instances on
// by the step, and one dispatch puts those of all groups into all slices. All of it is on the
// device, and depends on seeds and steps alone: what is drawn, and how often, changes nothing.
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "pass/slices/slices_templates_parts.h"

static const slices_extra hooks;
enum { ROWS = 4 }; // of an instance (shaders/pass/slices/templates.glsl)

slices_templates *slices_templates_make(slices_flow *f) {
    if (!f->templates_state)
        f->templates_state = arena_alloc(f->pass->host->memory, sizeof(slices_templates));
    f->templates = &hooks;
    return f->templates_state;
}

gpu_buffer *slices_templates_buffer(const pass *p) {
    const slices_templates *t = slices_templates_of(slices_of(p));
    return t && t->total ? t->instances : NULL;
}

// ---- declaring --------------------------------------------------------------------------------

static bool pushes(const pass *group) {
    return pass_option(group, N_kind) == 1;
}

static bool has_kind(const pass *p, bool pushing) {
    const slices_templates *t = slices_templates_of(slices_of(p));
    for (uint32_t i = 0; t && i < t->group_count; i++)
        if (pushes(t->groups[i]->pass) == pushing) return true;
    return t && t->hand.taken;
}

bool slices_has_pressing(const pass *p) {
    return has_kind(p, false);
}

bool slices_has_pushing(const pass *p) {
    return has_kind(p, true);
}

bool slices_add_templates(pass *p, pass *group, const picture *image, uint32_t count) {
    slices_flow *f = slices_of(p);
    slices_templates *t = slices_templates_make(f);
    if (t->group_count == SLICES_TEMPLATES_GROUPS)
        return err_set("%s: a flow has at most %d groups of templates", group->label,
                       SLICES_TEMPLATES_GROUPS);
    if (count < 1 || count > SLICES_TEMPLATES_MOST - t->total)
        return err_set("%s: 'count' is %u; a flow has 1 to %d templates in each slice, and %u are "
                       "in other groups",
                       group->label, count, SLICES_TEMPLATES_MOST, t->total);
    template_group *g = group->state = arena_alloc(p->host->memory, sizeof *g);
    *g = (template_group){group, f, image, t->group_count, t->total, count};
    t->groups[t->group_count++] = g;
    t->total += count;
    slices_add_part(f, group);
    return true;
}

// ---- tiles ------------------------------------------------------------------------------------

// Cells along a side: 16, or as many as leave at most 32 tiles along each side of a slice.
static uint32_t tile_side(const slices_flow *f) {
    const uint32_t *size = f->desc.size, most = size[0] > size[1] ? size[0] : size[1];
    return 16 * ((most + 511) / 512);
}

static uint64_t mask_bytes(const slices_flow *f) {
    const uint32_t *size = f->desc.size, side = tile_side(f);
    const uint64_t words = (slices_templates_of(f)->total + 31) / 32;
    const uint64_t tiles = (uint64_t)((size[0] + side - 1) / side) * ((size[1] + side - 1) / side);
    return 2 * 4 * tiles * (words ? words : 1) * f->desc.count;
}

void slices_templates_define(const slices_flow *f, pass_defines *out) {
    out->count += flow_defines(f->solver, out->items + out->count);
    pass_define_number(f->pass, out, "TEMPLATES_TOTAL", slices_templates_of(f)->total);
    pass_define_number(f->pass, out, "TEMPLATES_TILE", tile_side(f));
}

// ---- a group ----------------------------------------------------------------------------------

static bool defines_of_group(pass *p, size_t index, pass_defines *out) {
    const template_group *g = p->state;
    (void)index;
    slices_templates_define(g->flow, out);
    return true;
}

static bool declare_group(pass *p) {
    (void)p;
    return true; // the flow runs it
}

// Where the region may be, in widths of a slice.
static bool region_box(const pass *p, float low[2], float high[2]) {
    const template_group *g = p->state;
    const uint32_t *size = g->flow->desc.size;
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
    const uint32_t seeds[3] = {slices_seed(g->flow), (uint32_t)pass_value(p, N_seed), g->index};
    float low[2], high[2];
    if (!region_box(p, low, high)) return false;
    pass_set_int(p, N_key, (int32_t)(uint32_t)hash64(seeds, sizeof seeds));
    pass_set_int(p, N_first, (int32_t)g->first);
    pass_set_int(p, N_count, (int32_t)g->count);
    pass_set_int(p, N_parity, (int32_t)slices_templates_of(g->flow)->parity);
    pass_set_float(p, N_tile, (float)g->index);
    pass_set_float(p, N_time_step, (float)g->flow->clock.step);
    pass_set(p, N_box_min, low, sizeof low);
    pass_set(p, N_box_max, high, sizeof high);
    return true;
}

// ---- building: of all -------------------------------------------------------------------------

static bool each_group(const slices_templates *t, bool (*call)(pass *group)) {
    for (uint32_t i = 0; i < t->group_count; i++)
        if (!call(t->groups[i]->pass)) return false;
    return true;
}

static bool templates_check(slices_flow *f) {
    return each_group(slices_templates_of(f), pass_check_part);
}

static bool templates_build(slices_flow *f) {
    return each_group(slices_templates_of(f), pass_build_part);
}

static uint64_t instance_bytes(const slices_flow *f) {
    const uint64_t total = slices_templates_of(f)->total;
    return 16 * ROWS * (total ? total : 1) * f->desc.count; // there are none but by hand
}

static void templates_list_memory(const slices_flow *f, budget_list *out) {
    const slices_templates *t = slices_templates_of(f);
    if (!t->masks) budget_list_add(out, "tiles of templates", mask_bytes(f));
    if (!t->instances) budget_list_add(out, "templates", instance_bytes(f));
}

static bool templates_allocate(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    gpu *device = f->pass->host->device;
    if (!slices_templates_make_images(f)) return false;
    if (!t->masks)
        t->masks = gpu_buffer_create(
            device, &(gpu_buffer_desc){.label = "tiles of templates", .size = mask_bytes(f)});
    t->unmarked = true;
    if (!t->masks || t->instances) return t->masks != NULL;
    t->instances = gpu_buffer_create(
        device, &(gpu_buffer_desc){.label = "templates", .size = instance_bytes(f)});
    t->fresh = true;
    return t->instances != NULL;
}

static void templates_destroy(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    slices_templates_destroy_draw(f);
    gpu_buffer_destroy(f->pass->host->device, t->instances);
    gpu_buffer_destroy(f->pass->host->device, t->masks);
    *t = (slices_templates){0};
}

// ---- a step -----------------------------------------------------------------------------------

static bool run_group(const template_group *g) {
    pass *p = g->pass;
    kernel *k = pass_prepare(p) ? slices_templates_use(g->flow, p, 0) : NULL;
    return (k && kernel_run(k, p->host->device, g->count, g->flow->desc.count, 1)) ||
           err_prefix("%s: ", p->label);
}

static bool templates_run(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    if (t->fresh) gpu_buffer_fill(f->pass->host->device, t->instances, 0);
    if (t->unmarked) gpu_buffer_fill(f->pass->host->device, t->masks, 0);
    t->fresh = t->unmarked = false;
    t->parity = 1 - t->parity;
    for (uint32_t i = 0; i < t->group_count; i++)
        if (!run_group(t->groups[i])) return false;
    return slices_templates_draw(f);
}

static void templates_restart(slices_flow *f) {
    slices_templates_of(f)->fresh = true;
}

static void templates_loaded(slices_flow *f) {
    slices_templates_of(f)->fresh = false;
}

static void templates_exchange(slices_flow *f, slices_flow *other) {
    slices_templates *a = slices_templates_of(f), *b = slices_templates_of(other), own = *a;
    bool same = a->total == b->total && a->group_count == b->group_count;
    for (uint32_t i = 0; i < a->group_count && same; i++)
        same = a->groups[i]->count == b->groups[i]->count;
    if (!same) return;
    a->instances = b->instances, a->fresh = b->fresh;
    b->instances = own.instances, b->fresh = own.fresh;
}

static bool templates_rehearse(slices_flow *f) {
    return each_group(slices_templates_of(f), pass_rehearse);
}

static const slices_extra hooks = {
    .check = templates_check,
    .build = templates_build,
    .allocate = templates_allocate,
    .list_memory = templates_list_memory,
    .rehearse = templates_rehearse,
    .restart = templates_restart,
    .loaded = templates_loaded,
    .exchange = templates_exchange,
    .run = templates_run,
    .destroy = templates_destroy,
};

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
    .declare = declare_group,
    .defines = defines_of_group,
    .update = update_group,
};
