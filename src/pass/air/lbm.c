// The pass type `lbm`: what it is made of is known when the script has run. In a frame it does its
// steps, then the grid as of the frame's time.
#include "base/error.h"
#include "pass/air/lbm_parts.h"
#include <math.h>
#include <string.h>

static const double air_density = 1.2; // kg/m^3

field_grid *pass_lbm_open(pass *p, const pass_air_desc *desc) {
    if (!air_check_desc(p, desc)) return NULL;
    lbm_air *a = p->state = arena_alloc(p->host->memory, sizeof *a);
    *a = (lbm_air){.held = (double)NAN};
    field_grid *grid = air_open(&a->air, &lbm_kind, p, desc,
                                sim_units_make(desc->voxel_size, desc->speed, desc->time_step));
    a->air.used[PASS_FLUID_DENSITY] = true;
    return grid;
}

// ---- options ----------------------------------------------------------------------------------

// A constant that is 0 leaves the subgrid term out.
static bool has_subgrid(const pass *p) {
    const field *given = p->uniforms[p->names[N_smagorinsky].uniform];
    return !given || !field_is_constant(given) || given->value[0] > 0;
}

static uint32_t count_scalars(const lbm_air *a) {
    return a->air.used[PASS_FLUID_DYE] ? 3 : a->air.used[PASS_FLUID_TEMPERATURE] ? 2 : 1;
}

bool lbm_air_check_options(const pass *p) {
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
        .force = air_force_varies(p) || air_has_templates(&a->air),
        .outflow = air_has_outflow(&a->air),
        .bodies = a->air.solids.count > 0,
    };
    memcpy(d.size, a->air.desc.size, sizeof d.size);
    for (int i = 0; i < 6; i++) d.faces[i] = (lbm_face)pass_option(p, N_boundary_left + i);
    return d;
}

// ---- a frame ----------------------------------------------------------------------------------

double lbm_air_pascals(const lbm_air *a) {
    double speed = a->air.units.cell / a->air.units.step;
    return air_density * speed * speed / 3;
}

static bool lbm_air_update(pass *p) {
    const lbm_air *a = lbm_air_of(p);
    air_set_frame(p, &a->air);
    pass_set_float(p, N_speed, (float)(a->air.units.cell / a->air.units.step));
    pass_set_float(p, N_pressure, (float)lbm_air_pascals(a));
    return true;
}

static bool lbm_air_rehearse(pass *p) {
    lbm_numbers numbers;
    return lbm_air_numbers(p, &numbers) && air_rehearse_sources(air_of(p));
}

// The grid for the host's time, unless it is that already.
static bool show(pass *p, lbm_air *a) {
    gpu_buffer *now = lbm_moments(a->solver, 0), *before = lbm_moments(a->solver, 1);
    if (air_is_shown(p, &a->air)) return true;
    gpu_buffer *seen = lbm_guard_newest(a->guard);
    if (!now || !seen || a->air.fresh) return pass_clear_outputs(p);
    if (!pass_has_content(p) && !pass_clear_outputs(p)) return false; // it may stay as it is
    kernel *k = pass_use(p, AIR_SHOW);
    if (!k) return false;
    const uint32_t *n = a->air.desc.size;
    kernel_bind_buffer(k, N_Moments, now);
    kernel_bind_buffer(k, N_MomentsBefore, before ? before : now);
    kernel_bind_buffer(k, N_Guard, seen);
    return kernel_run(k, p->host->device, n[0], n[1], n[2]);
}

static bool lbm_air_record(pass *p) {
    lbm_air *a = lbm_air_of(p);
    a->air.last_steps = 0;
    if (!p->host->hold && !a->air.stopped && !air_advance(p)) return false;
    gpu_pass_next(p->host->device, a->air.labels[AIR_FIELDS]);
    return lbm_air_watch(p) && (!pass_is_watched(p) || (pass_prepare(p) && show(p, a)));
}

// ---- building ---------------------------------------------------------------------------------

static bool lbm_air_complete(pass *p) {
    lbm_air *a = lbm_air_of(p);
    lbm_desc structure = structure_of(p, a);
    a->stops = pass_option(p, N_guard) == 1;
    a->solver = lbm_create(p->host->memory, &structure);
    if (!a->solver || !air_make_bodies(&a->air)) return err_prefix("%s: ", p->label);
    a->moving = arena_alloc(p->host->memory, a->air.solids.count * sizeof *a->moving);
    a->guard = lbm_guard_create(p->host->memory, a->air.desc.size);
    return a->guard && air_add_part(p, lbm_air_record);
}

static bool lbm_air_build(pass *p) {
    lbm_air *a = lbm_air_of(p);
    const pass_host *host = p->host;
    if (!pass_build_kernels(p)) return false;
    if (!lbm_build(a->solver, host->device, host->library, host->reader) ||
        !lbm_guard_compile(a->guard, host->library, host->reader) || !air_build_bodies(&a->air))
        return err_prefix("%s: ", p->label);
    return air_each_source(&a->air, pass_build_part);
}

static bool lbm_air_allocate(pass *p) {
    lbm_air *a = lbm_air_of(p);
    return (lbm_allocate(a->solver, p->host->device) &&
            lbm_guard_allocate(a->guard, p->host->device) && air_allocate_bodies(&a->air) &&
            air_allocate_templates(&a->air) && air_allocate_force(&a->air)) ||
           err_prefix("%s: ", p->label);
}

static void lbm_air_list_memory(const pass *p, budget_list *out) {
    const lbm_air *a = lbm_air_of(p);
    lbm_list_memory(a->solver, out);
    air_list_bodies(&a->air, out);
    air_list_force(&a->air, out);
    air_list_templates(&a->air, out);
}

static void lbm_air_destroy(pass *p) {
    lbm_air *a = lbm_air_of(p);
    gpu *device = p->host->device;
    if (!a) return;
    if (a->guard) lbm_guard_destroy(a->guard, device);
    if (a->solver) lbm_destroy(a->solver, device);
    air_destroy(p);
}

const pass_type lbm_type = {
    .name = "lbm",
    .constructed = true,
    .shader = "pass/air/lbm.comp",
    .kernels = air_kernels,
    .kernel_count = AIR_KERNELS,
    .names = {air_names, AIR_NAME_COUNT},
    .unscaled = true,
    .simulation = &lbm_simulation,
    .declare = air_declare,
    .complete = lbm_air_complete,
    .defines = air_defines,
    .build = lbm_air_build,
    .allocate = lbm_air_allocate,
    .list_memory = lbm_air_list_memory,
    .update = lbm_air_update,
    .rehearse = lbm_air_rehearse,
    .record = lbm_air_record,
    .destroy = lbm_air_destroy,
};
