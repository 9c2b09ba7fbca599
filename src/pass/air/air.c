// What all simulated air is, whatever solves it: a grid in a box, with sources.
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include "base/swap.h"
#include "pass/air/air_parts.h"
#include <math.h>
#include <string.h>

const char *const air_names[AIR_NAME_COUNT] = {AIR_NAMES(KERNEL_NAME_TEXT)};
const pass_kernel air_kernels[AIR_KERNELS] = {
    [AIR_FORCE] = {.shader = "pass/air/lbm/force.comp"},
    [AIR_GUIDE] = {.shader = "pass/air/lbm/force.comp", .define = "GUIDE"},
    [AIR_TEMPLATES] = {.shader = "pass/air/templates_draw.comp", .without_fields = true},
};

bool air_defines(pass *p, size_t index, pass_defines *out) {
    if (index == AIR_FORCE) return air_force_varies(p);
    if (index == AIR_GUIDE) return air_is_guided(p);
    if (index == AIR_SHOW) pass_define_flag(out, "HAS_OUTFLOW", air_has_outflow(air_of(p)));
    if (index != AIR_TEMPLATES) return true;
    if (air_has_templates(air_of(p))) air_define_templates(air_of(p), out);
    return air_has_templates(air_of(p));
}

// ---- the grid ---------------------------------------------------------------------------------

static bool same_place(const air *a, const air *b) {
    return a->kind == b->kind && memcmp(&a->grid.box, &b->grid.box, sizeof a->grid.box) == 0 &&
           a->units.step == b->units.step && a->desc.warm_up == b->desc.warm_up &&
           a->desc.time_scale == b->desc.time_scale;
}

static bool exchange_grids(field_grid *grid, field_grid *other) {
    air *a = (air *)grid, *b = (air *)other;
    if (a->stopped || b->stopped || !same_place(a, b) || !a->kind->exchange(a, b)) return false;
    template_set_exchange(&a->templates.set, &b->templates.set);
    SWAP(a->fresh, b->fresh);
    a->shown_steps = b->shown_steps = UINT64_MAX;
    return true;
}

static const char *field_name(const field_grid *grid, size_t index) {
    const air *a = (const air *)grid;
    for (size_t i = 0; i < a->kind->field_count; i++)
        if ((a->used[i] || strcmp(a->kind->fields[i].name, "velocity") == 0) && index-- == 0)
            return a->kind->fields[i].name;
    return NULL;
}

static int find_field(field_grid *grid, const char *name, int *components) {
    return pass_air_use(((air *)grid)->pass, name, components);
}

static box3 box_of(const pass_air_desc *d) {
    float h = (float)d->voxel_size, w[3];
    for (int i = 0; i < 3; i++) w[i] = h * (float)d->size[i];
    return (box3){{d->position.x - w[0] / 2, d->position.y - w[1] / 2, d->position.z},
                  {d->position.x + w[0] / 2, d->position.y + w[1] / 2, d->position.z + w[2]}};
}

bool air_check_desc(const pass *p, const pass_air_desc *d) {
    if (!(d->voxel_size >= 1e-6 && d->voxel_size <= 1e6))
        return err_set("%s: 'voxel_size' is %g m; accepted: 1e-6 to 1e6", p->label, d->voxel_size);
    const float at[3] = {d->position.x, d->position.y, d->position.z};
    for (int i = 0; i < 3; i++)
        if (!(fabsf(at[i]) <= 1e6f))
            return err_set("%s: 'position' has %g m; accepted: -1e6 to 1e6", p->label,
                           (double)at[i]);
    if (!(d->speed >= 1e-6 && d->speed <= 1e6))
        return err_set("%s: 'speed' is %g m/s; accepted: 1e-6 to 1e6", p->label, d->speed);
    if (!(d->time_step >= 0 && d->time_step <= 3600))
        return err_set("%s: 'time_step' is %g s; accepted: 0 to 3600, where 0 goes by 'speed'",
                       p->label, d->time_step);
    if (!(d->warm_up >= 0 && d->warm_up <= 86400))
        return err_set("%s: 'warm_up' is %g s; accepted: 0 to 86400", p->label, d->warm_up);
    if (!(d->time_scale >= 1e-3 && d->time_scale <= 1e3))
        return err_set("%s: 'time_scale' is %g; accepted: 0.001 to 1000, above 1 is time lapse",
                       p->label, d->time_scale);
    return true;
}

field_grid *air_open(air *a, const air_kind *kind, pass *p, const pass_air_desc *desc,
                     sim_units units) {
    *a = (air){
        .grid = {.name = p->label,
                 .box = box_of(desc),
                 .size = {desc->size[0], desc->size[1], desc->size[2]},
                 .channel_count = 4 * (int)kind->output_count,
                 .simulated = true,
                 .time_scale = (float)desc->time_scale,
                 .state = {.active = box_of(desc)},
                 .exchange = exchange_grids,
                 .field_name = field_name,
                 .find_field = find_field},
        .kind = kind,
        .pass = p,
        .desc = *desc,
        .units = units,
        .solids = {.updated = (double)NAN},
        .force = {.turn = UINT64_MAX},
        .guide = {.turn = UINT64_MAX},
        .fresh = true,
        .shown_steps = UINT64_MAX,
    };
    static const char *const parts[AIR_LABELS] = {"step", "voxels", "sources", "fields"};
    for (int i = 0; i < AIR_LABELS; i++)
        a->labels[i] = arena_format(p->host->memory, "%s.%s", p->label, parts[i]);
    return &a->grid;
}

double pass_air_time_step(const pass *p) {
    return air_of(p)->units.step;
}

const pass_fluid_field *pass_air_fields(const pass *p, size_t *count) {
    *count = air_of(p)->kind->field_count;
    return air_of(p)->kind->fields;
}

int pass_air_use(pass *p, const char *name, int *components) {
    air *a = air_of(p);
    return pass_fluid_use(p->label, a->kind->fields, a->kind->field_count, a->used, name,
                          components);
}

// ---- declaring --------------------------------------------------------------------------------

bool air_declare(pass *p) {
    air *a = air_of(p);
    for (size_t i = 0; i < a->kind->output_count; i++) {
        if (!pass_add_output(p, a->kind->outputs[i],
                             (graph_image_desc){.width = a->desc.size[0],
                                                .height = a->desc.size[1],
                                                .depth = a->desc.size[2],
                                                .optional = true,
                                                .keep = true}))
            return false;
        pass_host_add_grid_image(p->host, &a->grid, (int)i, *pass_image(p, a->kind->outputs[i]));
    }
    return true;
}

bool pass_air_check(const pass *p) {
    const air_kind *kind = air_of(p)->kind;
    for (int i = 0; i < 6; i += 2) {
        bool around = pass_option(p, N_boundary_left + i) == kind->periodic;
        if (around != (pass_option(p, N_boundary_left + i + 1) == kind->periodic))
            return err_set("%s: '%s' is periodic and '%s' is not; what leaves one comes in at the "
                           "other, so both are, or none",
                           p->label, air_names[N_boundary_left + (around ? i : i + 1)],
                           air_names[N_boundary_left + (around ? i + 1 : i)]);
    }
    return !kind->check || kind->check(p);
}

bool air_add_part(pass *p, bool (*record)(pass *p)) {
    const air *a = air_of(p);
    const template_set *t = &a->templates.set;
    const size_t count = a->source_count + t->group_count;
    pass **with = arena_alloc(p->host->memory, (count + 1) * sizeof *with);
    for (size_t i = 0; i < count; i++)
        with[i] = i < a->source_count ? a->sources[i] : t->groups[i - a->source_count]->pass;
    graph_image writes[PASS_FLUID_MOST_NAMES / 4];
    for (size_t i = 0; i < a->kind->output_count; i++)
        writes[i] = *pass_image(p, a->kind->outputs[i]);
    graph_image *reads = arena_alloc(p->host->memory, a->source_count * sizeof *reads);
    for (size_t i = 0; i < a->source_count; i++) reads[i] = air_source_reads(a->sources[i]);
    return pass_add_part(p, &(pass_part){
                                .name = "step",
                                .reads = reads,
                                .read_count = a->source_count,
                                .writes = writes,
                                .write_count = a->kind->output_count,
                                .fields = true,
                                .with = with,
                                .with_count = count,
                                .simulates = true,
                                .record = record,
                            });
}

// ---- parts ------------------------------------------------------------------------------------

bool air_each_source(const air *a, bool (*call)(pass *source)) {
    for (size_t i = 0; i < a->source_count; i++)
        if (!call(a->sources[i])) return false;
    return template_set_each(&a->templates.set, call);
}

static bool rehearse(pass *source) {
    return pass_rehearse(source) || err_prefix("%s: ", source->label);
}

bool air_rehearse_sources(const air *a) {
    return air_each_source(a, rehearse);
}

void air_describe(const air *a, strbuf *out) {
    const float *at = &a->desc.position.x;
    strbuf_add(out, "voxel_size = %.9g\n", a->units.cell);
    strbuf_add(out, "position = %g, %g, %g\n", (double)at[0], (double)at[1], (double)at[2]);
    strbuf_add(out, "time_step = %.9g\n", a->units.step);
    strbuf_add(out, "warm_up = %.9g\n", a->desc.warm_up);
    strbuf_add(out, "time_scale = %.9g\n", a->desc.time_scale);
}

void air_destroy(pass *p) {
    air *a = air_of(p);
    air_destroy_force(a);
    air_destroy_templates(a);
    air_destroy_bodies(a);
    mem_free(a->sources);
}
