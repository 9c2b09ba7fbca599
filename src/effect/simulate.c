// Brings simulations to the time of a frame before it is drawn. Skipped frames (after a jump,
// before the first frame, for warming up) are simulated too, with `update` and the numbers of their
// own time, but without pictures: each in a submission of its own, or in several if it is long.
//
// A live window waits only briefly for this. It shows the state that the simulation has reached,
// and continues with the next picture.
#include "base/clock.h"
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include "scene/bvh.h"
#include <math.h>
#include <string.h>

// Limits of the time that a live window waits, seconds. Within these it waits as long as the rest
// of a frame takes.
static const double least_patience = 0.03, most_patience = 0.25;

static double time_of(const effect *e, double frame) {
    return (frame - e->facts.first) / e->facts.fps;
}

// Returns the next pass that simulates and runs, from `*index` on; NULL: there are no more.
static pass *next_simulation(const effect *e, size_t *index) {
    while (*index < e->pass_count) {
        pass *p = e->passes[(*index)++];
        if (pass_get_simulation(p) && effect_runs(e, p)) return p;
    }
    return NULL;
}

// Returns how many steps all simulations need to reach a time.
static int64_t left(const effect *e, double time) {
    int64_t sum = 0;
    pass *p;
    for (size_t i = 0; (p = next_simulation(e, &i));) {
        int64_t one = pass_get_simulation(p)->left(p, time);
        if (one > 0) sum += one;
    }
    return sum;
}

// Returns whether recording a frame does all remaining steps.
static bool is_near(const effect *e, double time) {
    pass *p;
    for (size_t i = 0; (p = next_simulation(e, &i));)
        if (pass_get_simulation(p)->left(p, time) > pass_get_simulation(p)->most(p)) return false;
    return true;
}

static double reached(const effect *e) {
    double least = (double)INFINITY;
    pass *p;
    for (size_t i = 0; (p = next_simulation(e, &i));)
        least = fmin(least, pass_get_simulation(p)->reached(p));
    return least;
}

static bool is_past(const effect *e, double time) {
    pass *p;
    for (size_t i = 0; (p = next_simulation(e, &i));)
        if (pass_get_simulation(p)->left(p, time) < 0) return true;
    return false;
}

// Returns the first frame that has not been simulated, at most `frame`.
static double next_frame(const effect *e, double frame) {
    double shown = reached(e);
    double next = isfinite(shown) ? floor(shown * e->facts.fps + 1e-6) + e->facts.first + 1
                                  : (double)e->facts.first;
    return fmin(fmax(next, (double)e->facts.first), frame);
}

// Simulations that are beyond the frame restart, or all continue from a snapshot before it; so they
// do where one has already been closer to it than they are.
static void turn_to(effect *e, double frame) {
    double time = time_of(e, frame);
    bool past = is_past(e, time);
    double after = past ? -(double)INFINITY : next_frame(e, frame) - 1;
    if (effect_take_snapshot(e, frame, after) || !past) return;
    e->partly = (double)NAN;
    pass *p;
    for (size_t i = 0; (p = next_simulation(e, &i));)
        if (pass_get_simulation(p)->left(p, time) < 0) pass_get_simulation(p)->restart(p);
}

void effect_stop_simulations(effect *e) {
    pass *p;
    e->partly = (double)NAN;
    e->stepped = e->behind = false;
    graph_reset_history(e->graph);
    for (size_t i = 0; (p = next_simulation(e, &i));) pass_get_simulation(p)->restart(p);
}

void effect_restart(effect *e) {
    pass *p;
    effect_free_snapshots(&e->snapshots); // those that branches began with, too
    effect_restart_systems(e);
    effect_restart_clocks(e);
    e->partly = (double)NAN;
    if (!e->compiled) return;
    for (size_t i = 0; (p = next_simulation(e, &i));) pass_get_simulation(p)->restart(p);
}

// Adds the times of the submission simulated last to those of the frame, which waits for it.
static void collect_times(effect *e) {
    if (!e->ahead) return;
    gpu_pass_time *times = mem_alloc(GPU_MAX_PASSES * sizeof *times);
    size_t count = gpu_frame_times(e->device, e->ahead, times, GPU_MAX_PASSES);
    e->ahead = 0;
    for (size_t i = 0; i < count; i++) {
        size_t k = 0;
        while (k < e->ahead_count && strcmp(e->ahead_times[k].label, times[i].label) != 0) k++;
        if (k < e->ahead_count) {
            e->ahead_times[k].milliseconds += times[i].milliseconds;
            continue;
        }
        *MEM_ADD(e->ahead_times, e->ahead_count, e->ahead_capacity) = times[i];
    }
    mem_free(times);
}

size_t effect_times_ahead(effect *e, gpu_pass_time *out, size_t capacity) {
    collect_times(e);
    for (size_t i = 0; i < e->ahead_count && i < capacity; i++) out[i] = e->ahead_times[i];
    return e->ahead_count < capacity ? e->ahead_count : capacity;
}

void effect_add_times(effect *e, uint64_t number) {
    collect_times(e);
    e->ahead = number;
}

// A live window does not wait, and its times are those of the picture alone.
static bool run_frame(effect *e, double frame, bool again) {
    if (!gpu_frame_begin(e->device)) return false;
    uint64_t number = gpu_frame_open(e->device);
    e->host.ahead = true;
    bool done = effect_evaluate(e, frame, e->device, again) &&
                scene_bvh_update(e->host.bvh, e->device, &e->context) &&
                graph_execute_simulation(e->graph, e->device);
    e->host.ahead = false;
    if (!gpu_frame_end(e->device)) done = false;
    if (e->never_waits) return done;
    collect_times(e); // of the one before: this one is at work meanwhile
    e->ahead = done ? number : 0;
    return done;
}

static bool simulate_until(effect *e, double frame, bool *again) {
    double next = next_frame(e, frame), begin = clock_seconds();
    double patience = e->counter ? begin - e->rendered_at : 0;
    patience = fmin(fmax(patience, least_patience), most_patience);
    double time = time_of(e, frame);
    int64_t whole = left(e, time);
    bool far = next < frame || !is_near(e, time);
    if (far && !effect_tell_progress(e, 0, (double)whole)) return false;
    while (next < frame || !is_near(e, time)) {
        if (e->never_waits && (e->stepped || clock_seconds() > begin + patience)) {
            e->behind = true;
            break;
        }
        if (!run_frame(e, next, *again)) return false;
        double done = (double)(whole - left(e, time));
        if (!effect_tell_progress(e, done, (double)whole)) return false;
        *again = next == frame || left(e, time_of(e, next)) > 0;
        if (!*again) next = fmin(next + 1, frame);
    }
    return true;
}

bool effect_simulate(effect *e, double frame, bool *again) {
    *again = e->behind = e->host.hold = false;
    if (e->moment == 0) e->ahead = e->ahead_count = 0;
    if (!graph_simulates(e->graph)) return true;
    e->host.brief = e->never_waits;
    turn_to(e, frame);
    *again = e->partly == frame;
    bool done = simulate_until(e, frame, again);
    e->partly = (double)NAN;
    e->stepped = false;
    if (!done) return false;
    e->host.hold = e->behind;
    *again = *again || e->behind; // what frames before it set is not to be set after it
    return true;
}

bool effect_catch_up(effect *e, double frame, bool *more) {
    *more = false;
    if (!e->compiled || !graph_simulates(e->graph)) return true;
    e->host.brief = true;
    e->host.hold = false;
    if (!e->stepped && !e->behind) effect_keep_snapshot(e, e->last_frame);
    turn_to(e, frame);
    double next = next_frame(e, frame);
    *more = next < frame || !is_near(e, time_of(e, frame));
    if (!*more) return true;
    if (e->stepped && e->partly != next) effect_keep_snapshot(e, next - 1);
    if (!run_frame(e, next, e->partly == next)) return false;
    e->stepped = true;
    e->partly = next == frame || left(e, time_of(e, next)) > 0 ? next : (double)NAN;
    return true;
}

bool effect_get_simulation(const effect *e, effect_simulation *out) {
    *out = (effect_simulation){.waiting = e->behind};
    if (!e->compiled || !graph_simulates(e->graph)) return false;
    out->reached = reached(e);
    pass *p;
    for (size_t i = 0; (p = next_simulation(e, &i)) && !out->trouble;) {
        out->trouble = pass_get_simulation(p)->trouble(p);
        out->where = pass_label(p);
    }
    return true;
}

bool effect_tell_progress(effect *e, double done, double whole) {
    return !e->progress || e->progress(e->progress_user, done, whole) ||
           err_set("stopped after %.0f of %.0f steps", done, whole);
}

void effect_on_progress(effect *e, bool (*call)(void *user, double done, double whole),
                        void *user) {
    e->progress = call;
    e->progress_user = user;
}
