// The clock of simulated air (pass/steps.h), and its steps.
#include "pass/air/air_parts.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

// Steps of a frame whose parts are timed apart, for which each takes microseconds more: while
// counters are off few, else as many as there are times for.
enum { FEW_TIMED = 4, MOST_TIMED = GPU_MAX_PASSES / 4 };

enum { TURNS = 96 }; // a second

double air_step_seconds(const air *a) {
    return a->units.step / a->desc.time_scale;
}

static pass_steps clock_of(const air *a) {
    return (pass_steps){.step = air_step_seconds(a),
                        .warm_up = a->desc.warm_up / a->desc.time_scale,
                        .late = a->kind->late};
}

double air_step_time(const air *a, uint64_t step) {
    pass_steps clock = clock_of(a);
    return pass_steps_time(&clock, step);
}

uint64_t air_turn(const air *a, double *begin, double *end) {
    uint64_t each = (uint64_t)fmax(1, floor(1 / (TURNS * a->units.step)));
    uint64_t turn = a->kind->steps(a) / each;
    *begin = air_step_time(a, turn * each);
    *end = air_step_time(a, (turn + 1) * each);
    return turn;
}

static int64_t done(const air *a) {
    return a->fresh ? 0 : (int64_t)a->kind->steps(a);
}

int64_t air_left(const pass *p, double time) {
    const air *a = air_of(p);
    pass_steps clock = clock_of(a);
    return a->stopped ? 0 : pass_steps_wanted(&clock, time) - done(a);
}

double air_reached(const pass *p) {
    const air *a = air_of(p);
    pass_steps clock = clock_of(a);
    return pass_steps_reached(&clock, done(a));
}

// How the two kept states are mixed for a time.
static double air_blend(const air *a, double time) {
    pass_steps clock = clock_of(a);
    return pass_steps_blend(&clock, done(a), time);
}

void air_restart(pass *p) {
    air *a = air_of(p);
    a->fresh = true;
    a->stopped = false;
    a->reported = false;
    a->trouble[0] = '\0';
    a->solids.updated = (double)NAN;
    for (size_t i = 0; i < a->giver_count; i++) a->givers[i].updated = (double)NAN;
    a->force.turn = a->guide.turn = UINT64_MAX;
    a->templates.set.fresh = true;
    for (size_t i = 0; i < a->source_count; i++) air_forget_source(a->sources[i]);
    a->shown_steps = UINT64_MAX;
    if (a->kind->restart) a->kind->restart(a);
}

int64_t air_most(const pass *p) {
    const air *a = air_of(p);
    const gpu_profile *device = gpu_get_profile(p->host->device);
    double cells = (double)a->desc.size[0] * a->desc.size[1] * a->desc.size[2];
    double cost = a->kind->burns ? device->burning_cost : 1;
    return pass_steps_most(cells * cost, device, p->host->brief);
}

// `apart`: what a step consists of is timed by itself.
static bool step(pass *p, air *a, bool keep, bool apart) {
    gpu *device = p->host->device;
    if (!a->kind->evaluate(a)) return false;
    if (a->fresh && !a->kind->reset(a)) return false;
    a->fresh = false;
    if (apart) gpu_pass_next(device, a->labels[AIR_VOXELS]);
    if (!air_move_bodies(a)) return false;
    if (apart) gpu_pass_next(device, a->labels[AIR_SOURCES]);
    if (!air_push(a)) return false;
    for (size_t i = 0; i < a->source_count; i++)
        if (!air_run_source(a->sources[i])) return false;
    if (!air_run_templates(a)) return false;
    if (apart) gpu_pass_next(device, a->labels[AIR_STEP]);
    return a->kind->step(a, keep);
}

// All parts have a time in every frame, if it is none, and come in the same order. What is not
// timed apart counts as the step's.
static void name_parts(const pass *p, const air *a) {
    for (int i = 0; i < AIR_FIELDS; i++) gpu_pass_next(p->host->device, a->labels[i]);
    gpu_pass_next(p->host->device, a->labels[AIR_STEP]);
}

// For other air that this one reads, and for particles of sources, as where a submit was too short:
// so that who is faster changes nothing.
static bool waits(const air *a) {
    bool waits = pass_waits(a->pass);
    for (size_t i = 0; i < a->source_count && !waits; i++)
        waits = pass_waits(a->sources[i]) || air_source_waits(a->sources[i]);
    return waits;
}

bool air_advance(pass *p) {
    air *a = air_of(p);
    int64_t left = waits(a) ? 0 : air_left(p, p->host->context->time), most = air_most(p);
    if (left > most) left = most;
    const field_context *frame = p->host->context;
    field_context now = *frame;
    p->host->context = &now;
    a->guide.turn = UINT64_MAX; // what it reads is that of the frame
    bool fine = true, apart = left <= (p->host->counters ? MOST_TIMED : FEW_TIMED);
    name_parts(p, a);
    for (int64_t i = 0; i < left && fine; i++) {
        now.time = air_step_time(a, (uint64_t)done(a));
        fine = step(p, a, left - i <= 2, apart);
    }
    p->host->context = frame;
    a->last_steps = left > 0 ? (uint64_t)left : 0;
    return fine;
}

double air_work(const pass *p) {
    const air *a = air_of(p);
    return (double)a->last_steps * a->desc.size[0] * a->desc.size[1] * a->desc.size[2];
}

// ---- what is shown ----------------------------------------------------------------------------

bool air_is_shown(pass *p, air *a) {
    const double blend = air_blend(a, p->host->context->time);
    const uint64_t steps = a->kind->steps(a);
    if (steps == a->shown_steps && blend == a->shown_blend && pass_has_content(p)) return true;
    a->shown_steps = steps;
    a->shown_blend = blend;
    a->grid.state.content++;
    return false;
}

void air_set_frame(pass *p, const air *a) {
    const float size[3] = {(float)a->desc.size[0], (float)a->desc.size[1], (float)a->desc.size[2]};
    pass_set(p, N_size, size, sizeof size);
    pass_set_float(p, N_blend, (float)air_blend(a, p->host->context->time));
    pass_set_box(p, a->grid.box);
}

bool air_tell_absent(air *a) {
    const box3 box = a->grid.box;
    const char *who =
        a->solids.count && !a->solids.met && !isnan(a->solids.updated) ? "no collider" : NULL;
    for (size_t i = 0; i < a->source_count && !who; i++)
        if (air_source_is_away(a->sources[i])) who = pass_label(a->sources[i]);
    if (!who) return false;
    snprintf(a->trouble, sizeof a->trouble,
             "%s has%s been in the air so far, which is from {%.3g, %.3g, %.3g} to {%.3g, %.3g, "
             "%.3g}: move it there, or the air by 'position'",
             who, strcmp(who, "no collider") == 0 ? "" : " not", (double)box.min.x,
             (double)box.min.y, (double)box.min.z, (double)box.max.x, (double)box.max.y,
             (double)box.max.z);
    return true;
}
