// The clock of simulated air (pass/steps.h), and its steps.
#include "pass/air/lbm_parts.h"
#include "pass/steps.h"
#include <math.h>

// Steps of a frame whose parts are timed apart, for which each takes microseconds more: while
// counters are off few, else as many as there are times for.
enum { FEW_TIMED = 4, MOST_TIMED = GPU_MAX_PASSES / 4 };

enum { TURNS = 96 }; // a second

static pass_steps clock_of(const lbm_air *a) {
    return (pass_steps){.step = a->units.step, .warm_up = a->desc.warm_up, .late = 1};
}

double lbm_air_step_time(const lbm_air *a, uint64_t step) {
    pass_steps clock = clock_of(a);
    return pass_steps_time(&clock, step);
}

uint64_t lbm_air_turn(const lbm_air *a, double *begin, double *end) {
    uint64_t each = (uint64_t)fmax(1, floor(1 / (TURNS * a->units.step)));
    uint64_t turn = lbm_steps(a->solver) / each;
    *begin = lbm_air_step_time(a, turn * each);
    *end = lbm_air_step_time(a, (turn + 1) * each);
    return turn;
}

static int64_t done(const lbm_air *a) {
    return a->fresh ? 0 : (int64_t)lbm_steps(a->solver);
}

int64_t lbm_air_left(const pass *p, double time) {
    const lbm_air *a = lbm_air_of(p);
    pass_steps clock = clock_of(a);
    return a->stopped ? 0 : pass_steps_wanted(&clock, time) - done(a);
}

double lbm_air_reached(const pass *p) {
    const lbm_air *a = lbm_air_of(p);
    pass_steps clock = clock_of(a);
    return pass_steps_reached(&clock, done(a));
}

double lbm_air_blend(const lbm_air *a, double time) {
    pass_steps clock = clock_of(a);
    return pass_steps_blend(&clock, done(a), time);
}

void lbm_air_restart(pass *p) {
    lbm_air *a = lbm_air_of(p);
    a->fresh = true;
    a->stopped = false;
    a->reported = false;
    a->held = (double)NAN;
    a->trouble[0] = '\0';
    a->solids.updated = (double)NAN;
    for (size_t i = 0; i < a->giver_count; i++) a->givers[i].updated = (double)NAN;
    a->force.turn = UINT64_MAX;
    for (size_t i = 0; i < a->source_count; i++) lbm_air_forget_source(a->sources[i]);
    lbm_guard_forget(a->guard);
}

int64_t lbm_air_most(const pass *p) {
    const lbm_air *a = lbm_air_of(p);
    double cells = (double)a->desc.size[0] * a->desc.size[1] * a->desc.size[2];
    return pass_steps_most(cells, gpu_get_profile(p->host->device), p->host->brief);
}

// `apart`: what a step consists of is timed by itself.
static bool step(pass *p, lbm_air *a, bool keep, bool apart) {
    gpu *device = p->host->device;
    lbm_numbers numbers;
    if (!lbm_air_numbers(p, &numbers)) return false;
    if (a->fresh && !lbm_reset(a->solver, device, &numbers)) return false;
    a->fresh = false;
    if (apart) gpu_pass_next(device, a->labels[LBM_VOXELS]);
    if (!lbm_air_move_bodies(a, &numbers)) return false;
    if (apart) gpu_pass_next(device, a->labels[LBM_SOURCES]);
    if (!lbm_air_push(a)) return false;
    for (size_t i = 0; i < a->source_count; i++)
        if (!lbm_air_run_source(a->sources[i])) return false;
    if (apart) gpu_pass_next(device, a->labels[LBM_STEP]);
    return lbm_step(a->solver, device, &numbers, keep);
}

// All parts have a time in every frame, if it is none, and come in the same order. What is not
// timed apart counts as the step's.
static void name_parts(const pass *p, const lbm_air *a) {
    for (int i = 0; i < LBM_FIELDS; i++) gpu_pass_next(p->host->device, a->labels[i]);
    gpu_pass_next(p->host->device, a->labels[LBM_STEP]);
}

bool lbm_air_advance(pass *p) {
    lbm_air *a = lbm_air_of(p);
    int64_t left = lbm_air_left(p, p->host->context->time), most = lbm_air_most(p);
    if (left > most) left = most;
    const field_context *frame = p->host->context;
    field_context now = *frame;
    p->host->context = &now;
    bool fine = true, apart = left <= (p->host->counters ? MOST_TIMED : FEW_TIMED);
    name_parts(p, a);
    for (int64_t i = 0; i < left && fine; i++) {
        now.time = lbm_air_step_time(a, (uint64_t)done(a));
        fine = step(p, a, left - i <= 2, apart);
    }
    p->host->context = frame;
    a->last_steps = left > 0 ? (uint64_t)left : 0;
    return fine;
}
