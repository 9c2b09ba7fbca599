// The clock of simulated air. Steps are so long whatever is drawn; the time of a frame lies between
// two states, which the last two steps left behind.
#include "pass/lbm_parts.h"
#include <math.h>

// Cell updates that one submit may take: about 0.1 s of a large device, 2 s of a software one. In a
// window it is a part of that.
static const double most_updates = 2e9, most_in_software = 5e7;
enum { BRIEF = 64 };

// Steps of a frame whose parts are timed apart, for which each takes microseconds more: while
// counters are off few, else as many as there are times for.
enum { FEW_TIMED = 4, MOST_TIMED = GPU_MAX_PASSES / 4 };

static const double rounding = 1e-6; // of a step
enum { TURNS = 96 };                 // a second

static double steps_at(const lbm_air *a, double time) { // from the beginning, with a fraction
    return fmax((time + a->desc.warm_up) / a->units.step, 0);
}

double lbm_air_step_time(const lbm_air *a, uint64_t step) {
    return (double)step * a->units.step - a->desc.warm_up;
}

uint64_t lbm_air_turn(const lbm_air *a, double *begin, double *end) {
    uint64_t each = (uint64_t)fmax(1, floor(1 / (TURNS * a->units.step)));
    uint64_t turn = lbm_steps(a->solver) / each;
    *begin = lbm_air_step_time(a, turn * each);
    *end = lbm_air_step_time(a, (turn + 1) * each);
    return turn;
}

// Steps that must be done for a time: two beyond the state before it, which leave that state and
// the one after it.
static int64_t wanted(const lbm_air *a, double time) {
    return (int64_t)floor(steps_at(a, time) + rounding) + 2;
}

static int64_t done(const lbm_air *a) {
    return a->fresh ? 0 : (int64_t)lbm_steps(a->solver);
}

int64_t lbm_air_left(const pass *p, double time) {
    const lbm_air *a = lbm_air_of(p);
    return a->stopped ? 0 : wanted(a, time) - done(a);
}

double lbm_air_reached(const pass *p) {
    const lbm_air *a = lbm_air_of(p);
    int64_t steps = done(a);
    return steps < 2 ? -(double)INFINITY : lbm_air_step_time(a, (uint64_t)steps - 1);
}

double lbm_air_blend(const lbm_air *a, double time) {
    double blend = steps_at(a, time) - (double)(done(a) - 2);
    return blend < rounding ? 0 : fmin(blend, 1);
}

void lbm_air_restart(pass *p) {
    lbm_air *a = lbm_air_of(p);
    a->fresh = true;
    a->stopped = false;
    a->reported = false;
    a->trouble[0] = '\0';
    a->givers.updated = a->solids.updated = (double)NAN;
    a->force.turn = UINT64_MAX;
    for (size_t i = 0; i < a->source_count; i++) lbm_air_forget_source(a->sources[i]);
    lbm_guard_forget(a->guard);
}

int64_t lbm_air_most(const pass *p) {
    const lbm_air *a = lbm_air_of(p);
    bool software = gpu_get_info(p->host->device)->kind == GPU_CPU;
    double cells = (double)a->desc.size[0] * a->desc.size[1] * a->desc.size[2];
    double most = (software ? most_in_software : most_updates) / cells;
    return (int64_t)fmax(1, p->host->brief ? most / BRIEF : most);
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
