// Life of the pass type `lbm`: what it is made of is known when the script has run.
#include "pass/air/lbm.h"
#include "base/error.h"
#include "base/memory.h"
#include "pass/air/lbm_parts.h"
#include <math.h>
#include <string.h>

const char *const lbm_names[LBM_NAME_COUNT] = {LBM_NAMES(KERNEL_NAME_TEXT)};
static const pass_kernel kernels[LBM_KERNELS] = {
    [LBM_FORCE] = {.shader = "pass/air/lbm/force.comp"}};

// ---- the grid ---------------------------------------------------------------------------------

static bool same_place(const lbm_air *a, const lbm_air *b) {
    return memcmp(&a->grid.box, &b->grid.box, sizeof a->grid.box) == 0 &&
           a->units.step == b->units.step && a->desc.warm_up == b->desc.warm_up;
}

static bool exchange_grids(field_grid *grid, field_grid *other) {
    lbm_air *a = (lbm_air *)grid, *b = (lbm_air *)other;
    if (!a->solver || !b->solver || a->stopped || b->stopped || !same_place(a, b) ||
        !lbm_exchange(a->solver, b->solver))
        return false;
    bool fresh = a->fresh;
    a->fresh = b->fresh;
    b->fresh = fresh;
    a->shown_steps = b->shown_steps = UINT64_MAX;
    return true;
}

static const char *field_name(const field_grid *grid, size_t index) {
    const lbm_air *a = (const lbm_air *)grid;
    for (int i = 0; i < PASS_FLUID_NAMES; i++)
        if ((a->used[i] || i == PASS_FLUID_VELOCITY) && index-- == 0) return pass_fluid_names[i];
    return NULL;
}

static int find_field(field_grid *grid, const char *name, int *components) {
    return pass_lbm_use(((lbm_air *)grid)->pass, name, components);
}

static box3 box_of(const pass_lbm_desc *d) {
    float h = (float)d->voxel_size, w[3];
    for (int i = 0; i < 3; i++) w[i] = h * (float)d->size[i];
    return (box3){{d->position.x - w[0] / 2, d->position.y - w[1] / 2, d->position.z},
                  {d->position.x + w[0] / 2, d->position.y + w[1] / 2, d->position.z + w[2]}};
}

static bool lbm_air_check_desc(const pass *p, const pass_lbm_desc *d) {
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
    return true;
}

field_grid *pass_lbm_open(pass *p, const pass_lbm_desc *desc) {
    if (!lbm_air_check_desc(p, desc)) return NULL;
    lbm_air *a = p->state = arena_alloc(p->host->memory, sizeof *a);
    *a = (lbm_air){
        .grid = {.name = p->label,
                 .box = box_of(desc),
                 .size = {desc->size[0], desc->size[1], desc->size[2]},
                 .channel_count = PASS_FLUID_CHANNELS,
                 .simulated = true,
                 .state = {.active = box_of(desc)},
                 .exchange = exchange_grids,
                 .field_name = field_name,
                 .find_field = find_field},
        .pass = p,
        .desc = *desc,
        .units = sim_units_make(desc->voxel_size, desc->speed, desc->time_step),
        .solids = {.updated = (double)NAN},
        .force = {.turn = UINT64_MAX},
        .held = (double)NAN,
        .fresh = true,
        .shown_steps = UINT64_MAX,
    };
    a->used[PASS_FLUID_DENSITY] = true;
    static const char *const parts[LBM_LABELS] = {"step", "voxels", "sources", "fields"};
    for (int i = 0; i < LBM_LABELS; i++)
        a->labels[i] = arena_format(p->host->memory, "%s.%s", p->label, parts[i]);
    return &a->grid;
}

double pass_lbm_time_step(const pass *p) {
    return lbm_air_of(p)->units.step;
}

int pass_lbm_use(pass *p, const char *name, int *components) {
    return pass_fluid_use(p->label, lbm_air_of(p)->used, name, components);
}

// ---- declaring --------------------------------------------------------------------------------

static bool add_image(pass *p, lbm_air *a, int output, int index) {
    if (!pass_add_output(p, output,
                         (graph_image_desc){.width = a->desc.size[0],
                                            .height = a->desc.size[1],
                                            .depth = a->desc.size[2],
                                            .optional = true,
                                            .keep = true}))
        return false;
    pass_host_add_grid_image(p->host, &a->grid, index, *pass_image(p, output));
    return true;
}

static bool lbm_air_declare(pass *p) {
    lbm_air *a = lbm_air_of(p);
    return add_image(p, a, N_scalars, 0) && add_image(p, a, N_velocity, PASS_FLUID_VELOCITY / 4);
}

// ---- options ----------------------------------------------------------------------------------

// A constant that is 0 leaves the subgrid term out.
static bool has_subgrid(const pass *p) {
    const field *given = p->uniforms[p->names[N_smagorinsky].uniform];
    return !given || !field_is_constant(given) || given->value[0] > 0;
}

static uint32_t count_scalars(const lbm_air *a) {
    return a->used[PASS_FLUID_DYE] ? 3 : a->used[PASS_FLUID_TEMPERATURE] ? 2 : 1;
}

bool pass_lbm_check(const pass *p) {
    for (int i = 0; i < 6; i += 2) {
        bool periodic = pass_option(p, N_boundary_left + i) == LBM_PERIODIC;
        if (periodic != (pass_option(p, N_boundary_left + i + 1) == LBM_PERIODIC))
            return err_set("%s: '%s' is periodic and '%s' is not; what leaves one comes in at the "
                           "other, so both are, or none",
                           p->label, lbm_names[N_boundary_left + (periodic ? i : i + 1)],
                           lbm_names[N_boundary_left + (periodic ? i + 1 : i)]);
    }
    if (pass_option(p, N_forcing) == LBM_WEIGHTS_ONLY && pass_option(p, N_collision) != LBM_BGK)
        return err_set("%s: forcing = \"weights_only\" wants collision = \"bgk\"; with another "
                       "collision \"guo\" is accepted",
                       p->label);
    return true;
}

static lbm_desc structure_of(const pass *p, const lbm_air *a) {
    lbm_desc d = {
        .set = (lbm_set)pass_option(p, N_velocity_set),
        .scalar_set = (lbm_scalar_set)pass_option(p, N_scalar_set),
        .collision = (lbm_collision)pass_option(p, N_collision),
        .forcing = (lbm_forcing)pass_option(p, N_forcing),
        .beside_bodies = (lbm_beside)pass_option(p, N_beside_bodies),
        .precision = (lbm_precision)pass_option(p, N_precision),
        .scalars = count_scalars(a),
        .subgrid = has_subgrid(p),
        .force = lbm_air_force_varies(p),
        .bodies = a->solids.count > 0,
    };
    memcpy(d.size, a->desc.size, sizeof d.size);
    for (int i = 0; i < 6; i++) d.faces[i] = (lbm_face)pass_option(p, N_boundary_left + i);
    return d;
}

static bool lbm_air_complete(pass *p) {
    lbm_air *a = lbm_air_of(p);
    lbm_desc structure = structure_of(p, a);
    a->stops = pass_option(p, N_guard) == 1;
    a->solver = lbm_create(p->host->memory, &structure);
    if (!a->solver || !lbm_air_make_bodies(a)) return err_prefix("%s: ", p->label);
    a->guard = lbm_guard_create(p->host->memory, a->desc.size);
    const graph_image writes[] = {*pass_image(p, N_scalars), *pass_image(p, N_velocity)};
    return a->guard && pass_add_part(p, &(pass_part){
                                            .name = "step",
                                            .writes = writes,
                                            .write_count = COUNT_OF(writes),
                                            .fields = true,
                                            .with = a->sources,
                                            .with_count = a->source_count,
                                            .simulates = true,
                                            .record = lbm_air_record,
                                        });
}

static bool lbm_air_defines(pass *p, size_t index, pass_defines *out) {
    (void)out;
    return index != LBM_FORCE || lbm_air_force_varies(p);
}

const pass_type lbm_type = {
    .name = "lbm",
    .constructed = true,
    .shader = "pass/air/lbm.comp",
    .kernels = kernels,
    .kernel_count = LBM_KERNELS,
    .names = {lbm_names, LBM_NAME_COUNT},
    .unscaled = true,
    .simulation = &lbm_simulation,
    .declare = lbm_air_declare,
    .complete = lbm_air_complete,
    .defines = lbm_air_defines,
    .check = lbm_air_check,
    .build = lbm_air_build,
    .allocate = lbm_air_allocate,
    .list_memory = lbm_air_list_memory,
    .update = lbm_air_update,
    .rehearse = lbm_air_rehearse,
    .record = lbm_air_record,
    .destroy = lbm_air_destroy,
};
