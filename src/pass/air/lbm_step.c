// What `lbm` does of what all air does (air_kind): its steps, what moves in it, and what it is
// given.
#include "base/memory.h"
#include "pass/air/lbm_parts.h"
#include <math.h>

static lbm_air *lbm_of(const air *a) {
    return (lbm_air *)a;
}

static uint64_t lbm_air_steps(const air *a) {
    return lbm_steps(lbm_of(a)->solver);
}

static bool lbm_air_evaluate(air *a) {
    return lbm_air_numbers(a->pass, &lbm_of(a)->numbers);
}

static bool lbm_air_reset(air *a) {
    lbm_air *l = lbm_of(a);
    return lbm_reset(l->solver, a->pass->host->device, &l->numbers);
}

static bool lbm_air_step(air *a, bool keep) {
    lbm_air *l = lbm_of(a);
    return lbm_step(l->solver, a->pass->host->device, &l->numbers, keep);
}

static void lbm_air_restart(air *a) {
    lbm_of(a)->held = (double)NAN;
    lbm_guard_forget(lbm_of(a)->guard);
}

static bool lbm_air_exchange(air *a, air *other) {
    lbm *mine = lbm_of(a)->solver, *its = lbm_of(other)->solver;
    return mine && its && lbm_exchange(mine, its);
}

static void lbm_air_take_force(air *a, gpu_image *image) {
    lbm_set_force(lbm_of(a)->solver, image, (float)sim_acceleration(&a->units, 1),
                  (float)a->units.step);
}

// ---- bodies -----------------------------------------------------------------------------------

static float3 in_steps(const air *a, float3 v) { // from m/s to cells a step
    float k = (float)sim_velocity(&a->units, 1);
    return (float3){v.x * k, v.y * k, v.z * k};
}

// How a body goes on. One that grows does not push the air.
static lbm_body body_of(const air *a, size_t index) {
    voxels_motion m;
    voxels_get_motion(a->solids.cells, index, &m);
    float3 corner = a->grid.box.min, v = in_steps(a, m.linear);
    float cell = (float)a->units.cell, step = (float)a->units.step;
    return (lbm_body){
        .centre = {(m.centre.x - corner.x) / cell, (m.centre.y - corner.y) / cell,
                   (m.centre.z - corner.z) / cell},
        .linear = {v.x, v.y, v.z},
        .angular = {m.angular.x * step, m.angular.y * step, m.angular.z * step},
    };
}

static bool lbm_air_move_solids(air *a, bool changed) {
    lbm_air *l = lbm_of(a);
    for (size_t i = 0; i < a->solids.count; i++) l->moving[i] = body_of(a, i);
    return lbm_set_bodies(l->solver, a->pass->host->device, &l->numbers,
                          &(lbm_bodies){.ids = voxels_ids(a->solids.cells),
                                        .changed = changed,
                                        .bodies = l->moving,
                                        .count = (uint32_t)a->solids.count});
}

// ---- sources ----------------------------------------------------------------------------------

static size_t lbm_air_source_defines(const air *a, shader_define *out) {
    return lbm_defines(lbm_of(a)->solver, out);
}

static void lbm_air_bind(const air *a, const pass *p, size_t index, kernel *k) {
    const lbm *solver = lbm_of(a)->solver;
    kernel_set_int(k, N_lbm_parity, (int32_t)lbm_parity(solver));
    lbm_bind(solver, k, pass_solver_places(p, index));
}

static bool lbm_air_give(const air *a, pass *source, kernel *k, uint32_t threads[3]) {
    const lbm_air *l = lbm_of(a);
    const uint32_t depth = lbm_depth(l->solver);
    kernel_set_float(k, N_step_speed, (float)sim_velocity(&a->units, 1));
    kernel_set_float(k, N_clamp_speed, lbm_air_clamp_speed(l));
    kernel_set_float(k, N_pascal, (float)(1 / lbm_air_pascals(l)));
    kernel_set_int(k, N_note, (int32_t)air_source_of(source)->note);
    kernel_bind_buffer(k, N_SourceNotes, lbm_guard_notes(l->guard));
    if (threads[2] > depth) threads[2] = depth;
    return true;
}

static const int outputs[] = {N_scalars, N_velocity};
static const int given[] = {N_density, N_temperature, N_dye, N_velocity, N_pressure};

const air_kind lbm_kind = {
    .fields = pass_fluid_fields,
    .field_count = PASS_FLUID_NAMES,
    .outputs = outputs,
    .output_count = COUNT_OF(outputs),
    .periodic = LBM_PERIODIC,
    .check = lbm_air_check_options,
    .late = 1,
    .source_fields = given,
    .source_field_count = COUNT_OF(given),
    .steps = lbm_air_steps,
    .evaluate = lbm_air_evaluate,
    .reset = lbm_air_reset,
    .step = lbm_air_step,
    .move_solids = lbm_air_move_solids,
    .bind = lbm_air_bind,
    .give = lbm_air_give,
    .source_defines = lbm_air_source_defines,
    .exchange = lbm_air_exchange,
    .restart = lbm_air_restart,
    .take_force = lbm_air_take_force,
};
