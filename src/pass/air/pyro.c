// Life of the pass type `pyro`: gas that burns, as a grid.
#include "base/error.h"
#include "base/memory.h"
#include "pass/air/pyro_parts.h"
#include <math.h>
#include <string.h>

field_grid *pass_pyro_open(pass *p, const pass_air_desc *desc) {
    static const double courant = 1.5; // cells of the velocity a step, by the expected speed
    if (!air_check_desc(p, desc)) return NULL;
    pyro_air *a = p->state = arena_alloc(p->host->memory, sizeof *a);
    *a = (pyro_air){0};
    const double cell = desc->voxel_size * (pass_option(p, N_velocity_cells) == 1 ? 2 : 1);
    const double step = desc->time_step > 0 ? desc->time_step : courant * cell / desc->speed;
    return air_open(&a->air, &pyro_kind, p, desc, (sim_units){desc->voxel_size, step});
}

// The side of a grid's cells, m; of those of the velocity where it is burning gas.
static float cell_of(const pass_host *host, const field_grid *grid) {
    const graph_image image = pass_grid_image(host, grid, 0);
    const pass *writer = image.id ? pass_writer(host, image) : NULL;
    const bool larger =
        writer && writer->type == &pyro_type && pass_option(writer, N_velocity_cells) == 1;
    return (larger ? 2 : 1) * (grid->box.max.x - grid->box.min.x) / (float)grid->size[0];
}

// The side of the largest cells that a field reads, m; 0: it reads no grid.
static float largest_cell(const pass_host *host, const field *f) {
    const field_grid *grids[64];
    const size_t count = field_grids(f, grids, COUNT_OF(grids));
    float most = 0;
    for (size_t i = 0; i < count && i < COUNT_OF(grids); i++)
        most = fmaxf(most, cell_of(host, grids[i]));
    return most;
}

static bool find_guide_cell(pass *p, pyro_air *a) {
    const field *size = p->uniforms[p->names[N_guide_size].uniform];
    const bool given = size && (!field_is_constant(size) || size->value[0] > 0);
    a->guide_cell = largest_cell(p->host, pass_given_field(p, N_guide));
    return given || a->guide_cell > 0 ||
           err_set("%s: 'guide_size' is missing: 'guide' reads no grid whose cells it could be",
                   p->label);
}

// A source gives some, a field wants it, or fuel makes it.
static bool has_smoke(const pass *p) {
    const air *a = air_of(p);
    bool used = pass_may_be(p, N_smoke_yield, 0, true);
    for (size_t i = 0; i < a->kind->field_count && !used; i++)
        used = a->used[i] && strcmp(a->kind->fields[i].name, "smoke") == 0;
    return used;
}

static bool pyro_air_complete(pass *p) {
    pyro_air *a = pyro_air_of(p);
    pyro_desc d = {
        .advection = (pyro_advection)pass_option(p, N_advection),
        .precision = (pyro_precision)pass_option(p, N_precision),
        .half_velocity = pass_option(p, N_velocity_cells) == 1,
        .variable_density = pass_option(p, N_density) == 1,
        .smoke = has_smoke(p),
        .premixed = pass_option(p, N_combustion) == 1,
        .confinement = pass_may_be(p, N_vorticity, 0, true), // a constant 0 leaves it out
        .turbulence = pass_may_be(p, N_turbulence, 0, true),
        .force = air_force_varies(p) || air_has_templates(&a->air),
        .outflow = air_has_outflow(&a->air),
        .guide = air_is_guided(p),
        .solids = a->air.solids.count > 0,
    };
    for (int i = 0; i < 3; i++) d.size[i] = a->air.desc.size[i];
    for (int i = 0; i < 6; i++) d.faces[i] = (pyro_face)pass_option(p, N_boundary_left + i);
    if (d.guide && !find_guide_cell(p, a)) return false;
    a->fuel = &sim_fuels[pass_option(p, N_fuel)];
    a->solver = pyro_create(p->host->memory, &d);
    if (!a->solver || !air_make_bodies(&a->air)) return err_prefix("%s: ", p->label);
    return air_add_part(p, p->type->record);
}

static bool pyro_air_defines(pass *p, size_t index, pass_defines *out) {
    pass_define_flag(out, "SMOKES", pyro_get_desc(pyro_air_of(p)->solver)->smoke);
    return air_defines(p, index, out);
}

// ---- building ---------------------------------------------------------------------------------

static bool pyro_air_build(pass *p) {
    pyro_air *a = pyro_air_of(p);
    const pass_host *host = p->host;
    if (!pass_build_kernels(p)) return false;
    if (!pyro_build(a->solver, host->device, host->library, host->reader) ||
        !air_build_bodies(&a->air))
        return err_prefix("%s: ", p->label);
    return air_each_source(&a->air, pass_build_part);
}

static bool pyro_air_allocate(pass *p) {
    pyro_air *a = pyro_air_of(p);
    return (pyro_allocate(a->solver, p->host->device) && air_allocate_bodies(&a->air) &&
            air_allocate_templates(&a->air) && air_allocate_force(&a->air)) ||
           err_prefix("%s: ", p->label);
}

static void pyro_air_list_memory(const pass *p, budget_list *out) {
    const pyro_air *a = pyro_air_of(p);
    pyro_list_memory(a->solver, out);
    air_list_bodies(&a->air, out);
    air_list_force(&a->air, out);
    air_list_templates(&a->air, out);
}

static void pyro_air_destroy(pass *p) {
    pyro_air *a = pyro_air_of(p);
    if (!a) return;
    if (a->solver) pyro_destroy(a->solver, p->host->device);
    air_destroy(p);
}

// ---- a frame ----------------------------------------------------------------------------------

static bool pyro_air_update(pass *p) {
    const pyro_air *a = pyro_air_of(p);
    pyro_numbers n;
    if (!pyro_air_numbers(p, &n)) return false;
    air_set_frame(p, &a->air);
    pass_set_float(p, N_cell_size, n.cell);
    pass_set_float(p, N_burn_power, n.heat / 1e6f / (n.burn_time > n.dt ? n.burn_time : n.dt));
    pass_set_float(p, N_flame_power, n.heat / 1e6f * n.flame_speed / n.ambient);
    pass_set_float(p, N_oxygen_need, n.oxygen > 1e-4f ? n.oxygen : 1e-4f);
    pass_set_float(p, N_burns_above, n.ignition);
    return true;
}

static bool pyro_air_rehearse(pass *p) {
    pyro_numbers numbers;
    return pyro_air_numbers(p, &numbers) && air_rehearse_sources(air_of(p));
}

// The images of the last two states.
static void bind_looks(const pyro_air *a, kernel *k) {
    static const int names[PYRO_LOOKS][2] = {
        {N_gas_now, N_gas_before}, {N_flow_now, N_flow_before}, {N_smoke_now, N_smoke_before}};
    for (int look = 0; look < PYRO_LOOKS; look++) {
        gpu_image *now = pyro_image(a->solver, (pyro_look)look, 0);
        gpu_image *before = pyro_image(a->solver, (pyro_look)look, 1);
        gpu_image *both[2] = {now, before ? before : now};
        for (int i = 0; i < 2; i++)
            kernel_bind(k, names[look][i],
                        (gpu_binding){.image = both[i], .sampler = GPU_LINEAR_CLAMP});
    }
}

static bool show(pass *p, pyro_air *a) {
    if (air_is_shown(p, &a->air)) return true;
    if (a->air.fresh || !pyro_image(a->solver, PYRO_GAS, 0)) return pass_clear_outputs(p);
    kernel *k = pass_use(p, AIR_SHOW);
    if (!k) return false;
    const uint32_t *n = a->air.desc.size;
    bind_looks(a, k);
    if (air_has_outflow(&a->air)) kernel_bind_image(k, N_outflow, a->air.templates.image);
    return kernel_run(k, p->host->device, n[0], n[1], n[2]);
}

static bool pyro_air_record(pass *p) {
    pyro_air *a = pyro_air_of(p);
    gpu *device = p->host->device;
    a->air.last_steps = 0;
    if (!p->host->hold && !a->air.stopped && !air_advance(p)) return false;
    if (a->air.last_steps && !pyro_watch(a->solver, device, &a->numbers)) return false;
    pyro_air_look(a);
    gpu_pass_next(device, a->air.labels[AIR_FIELDS]);
    return !pass_is_watched(p) || (pass_prepare(p) && show(p, a));
}

const pass_type pyro_type = {
    .name = "pyro",
    .constructed = true,
    .shader = "pass/air/pyro.comp",
    .kernels = air_kernels,
    .kernel_count = AIR_KERNELS,
    .names = {air_names, AIR_NAME_COUNT},
    .unscaled = true,
    .simulation = &pyro_simulation,
    .declare = air_declare,
    .complete = pyro_air_complete,
    .defines = pyro_air_defines,
    .build = pyro_air_build,
    .allocate = pyro_air_allocate,
    .list_memory = pyro_air_list_memory,
    .update = pyro_air_update,
    .rehearse = pyro_air_rehearse,
    .record = pyro_air_record,
    .destroy = pyro_air_destroy,
};
