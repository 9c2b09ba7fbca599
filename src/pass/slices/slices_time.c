// The clock of slices (pass/steps.h), and their steps: what the solver is told comes from the
// uniforms of the pass.
#include "pass/slices/slices_templates_parts.h"
#include <string.h>

// Updates of a lattice that one of a cell is worth: the pressure is solved for in several sweeps.
static const double dearer = 12;

// Steps of a frame whose parts are timed apart, for which each takes microseconds more: while
// counters are off few, else as many as there are times for.
enum { FEW_TIMED = 4, MOST_TIMED = GPU_MAX_PASSES / 4 };

static int64_t done(const slices_flow *f) {
    return f->fresh ? 0 : (int64_t)flow_steps(f->solver);
}

int64_t slices_left(const pass *p, double time) {
    const slices_flow *f = slices_of(p);
    return pass_steps_wanted(&f->clock, time) - done(f);
}

double slices_reached(const pass *p) {
    const slices_flow *f = slices_of(p);
    return pass_steps_reached(&f->clock, done(f));
}

double slices_blend(const slices_flow *f, double time) {
    return pass_steps_blend(&f->clock, done(f), time);
}

void slices_forget(slices_flow *f) {
    f->shown_steps = UINT64_MAX;
    for (size_t i = 0; i < f->part_count; i++) slices_forget_part(f->parts[i]);
}

void slices_restart(pass *p) {
    slices_flow *f = slices_of(p);
    f->fresh = true;
    f->reported = false;
    slices_forget(f);
    if (f->templates) f->templates->set.fresh = true;
}

int64_t slices_most(const pass *p) {
    const slices_flow *f = slices_of(p);
    double cells = (double)f->desc.size[0] * f->desc.size[1] * f->desc.count;
    return pass_steps_most(cells * dearer, gpu_get_profile(p->host->device), p->host->brief);
}

uint32_t slices_seed(const slices_flow *f) {
    float seed[4];
    return pass_evaluate_now(f->pass, N_seed, seed) ? (uint32_t)seed[0] : 0;
}

bool slices_numbers(const pass *p, flow_numbers *out) {
    const slices_flow *f = slices_of(p);
    float v[N_top_velocity + 1][4];
    for (int i = 0; i <= N_top_velocity; i++)
        if (!pass_evaluate_now(p, i, v[i])) return false;
    float viscosity = v[N_viscosity][0], reynolds = v[N_reynolds][0];
    if (reynolds > 0) viscosity = v[N_speed][0] * (float)f->desc.height / reynolds;
    *out = (flow_numbers){
        .dt = (float)f->clock.step,
        .cell = (float)f->cell,
        .viscosity = viscosity,
        .vorticity = v[N_vorticity][0],
        .acceleration = {v[N_force][0], v[N_force][1]},
        .buoyancy = {v[N_buoyancy_density][0], v[N_buoyancy_heat][0]},
        .decay = {v[N_dissolve_rate][0], v[N_cooling_rate][0], v[N_dissolve_rate][0]},
        .friction = v[N_friction][0],
        .tolerance = v[N_tolerance][0],
        .max_speed = v[N_max_speed][0],
    };
    for (int i = 0; i < 4; i++)
        memcpy(out->wall_velocity[i], v[N_left_velocity + i], 2 * sizeof(float));
    return true;
}

// `apart`: what a step consists of is timed by itself.
static bool step(pass *p, slices_flow *f, bool keep, bool apart) {
    gpu *device = p->host->device;
    flow_numbers numbers;
    if (!slices_numbers(p, &numbers)) return false;
    if (f->fresh && (!flow_reset(f->solver, device) || !flow_keep(f->solver, device, &numbers)))
        return false;
    f->fresh = false;
    if (apart) gpu_pass_next(device, f->labels[SLICES_SOURCES]);
    if (!slices_run_parts(f, true) || !slices_run_parts(f, false)) return false;
    if (apart) gpu_pass_next(device, f->labels[SLICES_TEMPLATES]);
    if (f->templates && !slices_templates_run(f)) return false;
    if (apart) gpu_pass_next(device, f->labels[SLICES_STEP]);
    return flow_step(f->solver, device, &numbers, keep);
}

// All parts have a time in every frame, if it is none, and come in the same order. What is not
// timed apart counts as the step's.
static void name_parts(const pass *p, const slices_flow *f) {
    for (int i = 0; i < SLICES_FIELDS; i++) gpu_pass_next(p->host->device, f->labels[i]);
    gpu_pass_next(p->host->device, f->labels[SLICES_STEP]);
}

bool slices_advance(pass *p) {
    slices_flow *f = slices_of(p);
    int64_t left = slices_left(p, p->host->context->time), most = slices_most(p);
    if (left > most) left = most;
    const field_context *frame = p->host->context;
    field_context now = *frame;
    p->host->context = &now;
    bool fine = true, apart = left <= (p->host->counters ? MOST_TIMED : FEW_TIMED);
    name_parts(p, f);
    for (int64_t i = 0; i < left && fine; i++) {
        now.time = pass_steps_time(&f->clock, (uint64_t)done(f));
        fine = step(p, f, left - i <= 2, apart);
    }
    p->host->context = frame;
    f->last_steps = left > 0 ? (uint64_t)left : 0;
    return fine;
}
