// What `pyro` does of what all air does (air_kind): its numbers, its steps, and what it is given.
#include "base/memory.h"
#include "pass/air/pyro_parts.h"

static pyro_air *pyro_of(const air *a) {
    return (pyro_air *)a;
}

// ---- numbers ----------------------------------------------------------------------------------

bool pyro_air_numbers(const pass *p, pyro_numbers *out) {
    const pyro_air *a = pyro_air_of(p);
    const sim_fuel *fuel = a->fuel;
    float v[AIR_NAME_COUNT][4];
    static const int names[] = {N_gravity,     N_ambient_temperature, N_ignition_temperature,
                                N_flame_speed, N_burn_time,           N_heat_of_combustion,
                                N_soot_yield,  N_soot_burn_time,      N_cooling,
                                N_expansion,   N_vorticity,           N_dissolve_rate,
                                N_wind,        N_guide_rate,          N_guide_size,
                                N_smoke_yield, N_smoke_dissolve_rate, N_turbulence};
    for (size_t i = 0; i < COUNT_OF(names); i++)
        if (!pass_evaluate_now(p, names[i], v[names[i]])) return false;
    const float ignition = v[N_ignition_temperature][0], heat = v[N_heat_of_combustion][0];
    const float soot = v[N_soot_yield][0], guide = v[N_guide_size][0];
    *out = (pyro_numbers){
        .dt = (float)a->air.units.step,
        .cell = (float)a->air.units.cell,
        .ambient = v[N_ambient_temperature][0],
        .gravity = v[N_gravity][0],
        .inflow = {v[N_wind][0], v[N_wind][1], v[N_wind][2]},
        .confinement = v[N_vorticity][0],
        .turbulence = v[N_turbulence][0],
        .guide_rate = v[N_guide_rate][0],
        .guide_size = guide > 0 ? guide : a->guide_cell,
        .ignition = ignition > 0 ? ignition : (float)fuel->ignition,
        .flame_speed = v[N_flame_speed][0],
        .burn_time = v[N_burn_time][0],
        .heat = heat > 0 ? heat * 1e6f : (float)(fuel->heat * (1 - fuel->radiated)),
        .oxygen = (float)fuel->oxygen,
        .molar_mass = (float)fuel->molar_mass,
        .soot_yield = soot >= 0 ? soot : (float)fuel->soot,
        .soot_burn_time = v[N_soot_burn_time][0],
        .dissolve = v[N_dissolve_rate][0],
        .smoke_yield = v[N_smoke_yield][0],
        .smoke_dissolve = v[N_smoke_dissolve_rate][0],
        .cooling = v[N_cooling][0],
        .expansion = v[N_expansion][0],
    };
    return air_constant_force(p, out->acceleration);
}

// ---- steps ------------------------------------------------------------------------------------

static uint64_t pyro_air_steps(const air *a) {
    return pyro_steps(pyro_of(a)->solver);
}

static bool pyro_air_evaluate(air *a) {
    return pyro_air_numbers(a->pass, &pyro_of(a)->numbers);
}

static bool pyro_air_reset(air *a) {
    pyro_air *p = pyro_of(a);
    gpu *device = a->pass->host->device;
    return pyro_reset(p->solver, device, &p->numbers) && pyro_keep(p->solver, device, &p->numbers);
}

static bool pyro_air_step(air *a, bool keep) {
    pyro_air *p = pyro_of(a);
    return pyro_step(p->solver, a->pass->host->device, &p->numbers, keep);
}

static bool pyro_air_move_solids(air *a, bool changed) {
    const float3 corner = a->grid.box.min;
    pyro_set_solids(pyro_of(a)->solver, &(pyro_solids){.ids = voxels_ids(a->solids.cells),
                                                       .motions = voxels_motions(a->solids.cells),
                                                       .corner = {corner.x, corner.y, corner.z},
                                                       .changed = changed});
    return true;
}

static void pyro_air_take_force(air *a, gpu_image *image) {
    pyro_set_force(pyro_of(a)->solver, image);
    pyro_set_guide(pyro_of(a)->solver, a->guide.image);
}

static void pyro_air_guide_cells(const air *a, bool most, uint32_t out[3]) {
    const pyro_air *p = (const pyro_air *)a;
    if (most)
        pyro_find_most_guide_cells(p->solver, out);
    else
        pyro_find_guide_cells(p->solver, &p->numbers, out);
}

static bool pyro_air_exchange(air *a, air *other) {
    pyro *mine = pyro_of(a)->solver, *its = pyro_of(other)->solver;
    return mine && its && pyro_exchange(mine, its);
}

// ---- sources ----------------------------------------------------------------------------------

static size_t pyro_air_source_defines(const air *a, shader_define *out) {
    return pyro_defines(pyro_of(a)->solver, out);
}

static void pyro_air_bind(const air *a, const pass *p, size_t index, kernel *k) {
    const pyro_air *own = pyro_of(a);
    kernel_set_float(k, N_ambient, own->numbers.ambient);
    pyro_bind(own->solver, k, pass_solver_places(p, index));
}

static bool pyro_air_give(const air *a, pass *source, kernel *k, uint32_t threads[3]) {
    const pyro_air *p = pyro_of(a);
    (void)source;
    kernel_set_int(k, N_present_from, pyro_present_from(p->solver));
    kernel_set_float(k, N_burns_above, p->numbers.ignition);
    // From the beginning of a cell of velocity to the faces behind the last one.
    for (int i = 0; i < 3; i++) threads[i] += 2 * pyro_ratio(pyro_get_desc(p->solver)) - 1;
    return true;
}

static const pass_fluid_field fields[] = {
    {"temperature", 0, 1}, {"fuel", 1, 1},       {"soot", 2, 1},
    {"velocity", 4, 3},    {"pressure", 7, 1},   {"burn", 8, 1},
    {"divergence", 9, 1},  {"vorticity", 10, 1}, {"smoke", 11, 1},
};
static const int outputs[] = {N_scalars, N_velocity, N_rates};
static const int given[] = {N_fuel, N_temperature, N_soot, N_smoke, N_velocity};

const air_kind pyro_kind = {
    .fields = fields,
    .field_count = COUNT_OF(fields),
    .outputs = outputs,
    .output_count = COUNT_OF(outputs),
    .periodic = PYRO_PERIODIC,
    .burns = true,
    .source_fields = given,
    .source_field_count = COUNT_OF(given),
    .steps = pyro_air_steps,
    .evaluate = pyro_air_evaluate,
    .reset = pyro_air_reset,
    .step = pyro_air_step,
    .move_solids = pyro_air_move_solids,
    .bind = pyro_air_bind,
    .give = pyro_air_give,
    .source_defines = pyro_air_source_defines,
    .exchange = pyro_air_exchange,
    .take_force = pyro_air_take_force,
    .guide_cells = pyro_air_guide_cells,
};
