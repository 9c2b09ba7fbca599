// Templates in simulated air (pass/templates.h): groups are passes of the types `lbm_templates` and
// `pyro_templates`. Before each step the shader of every group brings its own on by the step, and
// one dispatch puts those of all groups into an image over the air, on top of the force that it has
// there. A solver reads it as it reads a force (air_force.c); what comes out of templates of
// pressure is the image's fourth channel. A force by the gradient of a pressure would do nothing:
// it is what the solvers take away.
#include "base/error.h"
#include "base/hash.h"
#include "pass/air/air_parts.h"
#include "sim/checkpoint.h"
#include "sim/lbm.h"
#include "sim/pyro.h"
#include <string.h>

enum { ROWS = 7, LEAST_SIDE = 4 }; // of a template (templates_state.glsl), and of a tile, texels
enum { PRESSURE, VELOCITY };       // words of `kind`

static air *air_of_group(const pass *p) {
    const template_group *g = p->state;
    return g->owner;
}

bool air_has_templates(const air *a) {
    return a->templates.set.group_count > 0;
}

bool air_has_outflow(const air *a) {
    return template_set_has(&a->templates.set, N_kind, PRESSURE);
}

// ---- declaring --------------------------------------------------------------------------------

// That the air holds what an option names.
static bool use_named(pass *p, const pass *group, const char *option) {
    const char *word = pass_word(group, option);
    int components;
    return strcmp(word, "nothing") == 0 || pass_air_use(p, word, &components) >= 0;
}

static bool check_direction(const pass *group) {
    const bool given = pass_given_field(group, N_direction) != NULL;
    if (pass_option_is(group, N_align, "direction") == given) return true;
    return err_set(given
                       ? "%s: 'direction' is given, and templates are not turned by it; say "
                         "align = \"direction\", too"
                       : "%s: align = \"direction\" wants a field, as in direction = vec(0, 0, 1)",
                   group->label);
}

bool pass_air_add_templates(pass *p, pass *group, const picture *image, uint32_t count) {
    air *a = air_of(p);
    if (!check_direction(group) ||
        air_is_read_by(a, group, "; 'within' and align = \"flow\" go by it") ||
        !use_named(p, group, "scale_by") || !use_named(p, group, "within"))
        return false;
    group->runs_in = p;
    return template_set_add(&a->templates.set, a, group, image, count, "");
}

// ---- building ---------------------------------------------------------------------------------

static uint32_t tile_side(const gpu_image_desc *image) {
    uint32_t most = image->width > image->height ? image->width : image->height;
    if (image->depth > most) most = image->depth;
    return template_tile_side(most, LEAST_SIDE);
}

static uint64_t mask_bytes(const air *a) {
    const gpu_image_desc d = air_describe_force(a, "");
    const uint32_t side = tile_side(&d);
    const uint64_t x = (d.width + side - 1) / side, y = (d.height + side - 1) / side;
    return template_mask_bytes(&a->templates.set, x * y * ((d.depth + side - 1) / side));
}

void air_define_templates(const air *a, pass_defines *out) {
    const gpu_image_desc d = air_describe_force(a, "");
    pass_define_number(a->pass, out, "TEMPLATES_TOTAL", a->templates.set.total);
    pass_define_number(a->pass, out, "TEMPLATES_TILE", tile_side(&d));
    pass_define_number(a->pass, out, "TEMPLATES_NX", d.width);
    pass_define_number(a->pass, out, "TEMPLATES_NY", d.height);
    pass_define_number(a->pass, out, "TEMPLATES_NZ", d.depth);
    pass_define_number(a->pass, out, "AIR_COARSER", AIR_COARSER);
    pass_define_flag(out, "HAS_OWN_FORCE", air_force_varies(a->pass));
}

static bool air_templates_defines(pass *p, size_t index, pass_defines *out) {
    const air *a = air_of_group(p);
    (void)index;
    out->count += a->kind->source_defines(a, out->items + out->count);
    air_define_templates(a, out);
    return true;
}

static uint64_t instance_bytes(const air *a) {
    return template_instance_bytes(&a->templates.set, ROWS, 1);
}

static const char image_label[] = "what templates do";

void air_list_templates(const air *a, budget_list *out) {
    const air_templates *t = &a->templates;
    const gpu_image_desc desc = air_describe_force(a, image_label);
    if (!air_has_templates(a)) return;
    if (!t->image) budget_list_add(out, desc.label, gpu_image_bytes(&desc));
    template_set_list_memory(&t->set, instance_bytes(a), mask_bytes(a), out);
}

bool air_allocate_templates(air *a) {
    air_templates *t = &a->templates;
    gpu *device = a->pass->host->device;
    const gpu_image_desc desc = air_describe_force(a, image_label);
    if (!air_has_templates(a)) return true;
    if (!t->image) t->image = gpu_image_create(device, &desc);
    return t->image && template_set_make_images(&t->set, device, NULL, NULL) &&
           template_set_allocate(&t->set, device, instance_bytes(a), mask_bytes(a));
}

void air_destroy_templates(air *a) {
    gpu *device = a->pass->host->device;
    gpu_image_destroy(device, a->templates.image);
    template_set_destroy(&a->templates.set, device);
    a->templates.image = NULL;
}

// ---- a step -----------------------------------------------------------------------------------

// Where the region may be.
static bool region_box(const pass *p, box3 *out) {
    const field *region = pass_given_field(p, N_region);
    *out = box3_infinite();
    if (region && !field_bounds(region, p->host->context, out)) return false;
    *out = box3_intersect(*out, air_of_group(p)->grid.box);
    return true;
}

static bool air_templates_update(pass *p) {
    const template_group *g = p->state;
    const air *a = g->owner;
    const uint32_t seeds[2] = {(uint32_t)pass_value(p, N_seed), g->index};
    box3 box;
    if (!region_box(p, &box)) return false;
    pass_set_int(p, N_key, (int32_t)(uint32_t)hash64(seeds, sizeof seeds));
    pass_set_int(p, N_first, (int32_t)g->first);
    pass_set_int(p, N_count, (int32_t)g->count);
    pass_set_int(p, N_parity, (int32_t)a->templates.set.parity);
    pass_set_float(p, N_tile, (float)g->index);
    pass_set_float(p, N_time_step, (float)a->units.step);
    pass_set(p, N_corner, &a->grid.box.min, sizeof a->grid.box.min);
    pass_set_float(p, N_cell_size, (float)a->units.cell);
    pass_set_box(p, box);
    return true;
}

static void bind(const air_templates *t, kernel *k) {
    kernel_bind_buffer(k, N_Templates, t->set.instances);
    kernel_bind_buffer(k, N_TemplateMasks, t->set.masks);
}

static bool run_group(pass *p) {
    const air *a = air_of_group(p);
    const template_group *g = p->state;
    kernel *k = pass_prepare(p) ? pass_use(p, 0) : NULL;
    if (k) {
        a->kind->bind(a, p, 0, k);
        bind(&a->templates, k);
    }
    return (k && kernel_run(k, p->host->device, g->count, 1, 1)) || err_prefix("%s: ", p->label);
}

static bool draw(const air *a) {
    const air_templates *t = &a->templates;
    const gpu_image_desc *size = gpu_image_get_desc(t->image);
    kernel *k = pass_use(a->pass, AIR_TEMPLATES);
    if (!k) return false;
    bind(t, k);
    kernel_set_int(k, N_parity, (int32_t)t->set.parity);
    kernel_bind_image(k, N_TemplateImages, t->set.images);
    kernel_bind_image(k, N_acceleration, t->image);
    if (a->force.image) kernel_bind_image(k, N_own_force, a->force.image);
    return kernel_run(k, a->pass->host->device, size->width, size->height, size->depth);
}

bool air_run_templates(air *a) {
    if (!air_has_templates(a)) return true;
    template_set_begin(&a->templates.set, a->pass->host->device);
    return template_set_each(&a->templates.set, run_group) && draw(a);
}

// ---- other states -----------------------------------------------------------------------------

static checkpoint_part part_of(const air *a, arena *memory) {
    gpu_buffer *buffer = a->templates.set.instances;
    return (checkpoint_part){.name = arena_format(memory, "%s/templates", a->pass->label),
                             .size = gpu_buffer_size(buffer),
                             .width = 4,
                             .buffer = buffer};
}

void air_save_templates(const air *a, checkpoint_list *out) {
    if (!air_has_templates(a)) return;
    const checkpoint_part part = part_of(a, &out->memory);
    checkpoint_add(out, &part);
}

bool air_load_templates(air *a, checkpoint *from) {
    arena memory = {0};
    if (!air_has_templates(a)) return true;
    const checkpoint_part part = part_of(a, &memory);
    bool done = checkpoint_load(from, a->pass->host->device, &part);
    if (done) a->templates.set.fresh = false;
    arena_free(&memory);
    return done;
}

#define TEMPLATES_TYPE(KIND)                                                                       \
    {                                                                                              \
        .name = #KIND "_templates", .constructed = true,                                           \
        .shader = "pass/air/" #KIND "_templates.comp", .names = {air_names, AIR_NAME_COUNT},       \
        .solver = &KIND##_kernel_table, .unscaled = true, .runs_inside = true,                     \
        .defines = air_templates_defines, .update = air_templates_update,                          \
    }

const pass_type lbm_templates_type = TEMPLATES_TYPE(lbm);
const pass_type pyro_templates_type = TEMPLATES_TYPE(pyro);
