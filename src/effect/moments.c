// What simulates goes on in time only. While a window plays, its state is kept now and then, so
// that a jump back is a jump to the moment before and a little way on, and not all the way from the
// beginning. Copies stay on the device; when there is no more room for them, every second goes, and
// from then on they lie twice as far apart.
//
// A moment tells of the numbers that it was computed with: when one is moved by hand, all are
// forgotten; when an event is, those since then.
#include "base/budget.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include "sim/checkpoint.h"

enum { MOST_MOMENTS = 32 };
static const double least_gap = 1;                    // seconds
static const uint64_t most_bytes = UINT64_C(1) << 30; // of all
static const uint64_t most_part = 8;                  // of the device's memory, one in so many

void effect_forget_moments(effect *e) {
    for (size_t i = 0; i < e->moment_count; i++) checkpoint_close(e->moments[i].state);
    e->moment_count = 0;
    e->moment_gap = 0;
}

void effect_forget_moments_from(effect *e, double time) {
    while (e->moment_count > 0) {
        effect_moment *last = &e->moments[e->moment_count - 1];
        if ((last->frame - e->first) / e->fps < time) return;
        checkpoint_close(last->state);
        e->moment_count--;
    }
}

static double gap_of(const effect *e) { // frames
    return e->moment_gap > 0 ? e->moment_gap : least_gap * e->fps;
}

static bool is_due(const effect *e) {
    double last = e->moment_count ? e->moments[e->moment_count - 1].frame : (double)e->first;
    return !e->behind && graph_simulates(e->graph) && e->last_frame >= last + gap_of(e) &&
           effect_can_save(e);
}

static size_t room_for(const effect *e, const checkpoint_list *list) {
    uint64_t bytes = 1, most = gpu_get_info(e->device)->memory / most_part;
    for (size_t i = 0; i < list->count; i++) bytes += list->parts[i].size;
    if (most > most_bytes) most = most_bytes;
    // Of what may still be taken, half is left to what is drawn.
    uint64_t left = budget_room(gpu_get_budget(e->device)) / 2 + e->moment_count * bytes;
    if (most > left) most = left;
    return most / bytes < MOST_MOMENTS ? (size_t)(most / bytes) : MOST_MOMENTS;
}

static void thin_out(effect *e) {
    size_t count = 0;
    for (size_t i = 0; i < e->moment_count; i++) {
        if (i % 2 == 0)
            checkpoint_close(e->moments[i].state);
        else
            e->moments[count++] = e->moments[i];
    }
    e->moment_count = count;
    e->moment_gap = 2 * gap_of(e);
}

void effect_keep_moment(effect *e) {
    checkpoint_list list = {0};
    if (!is_due(e)) return;
    effect_list_state(e, &list);
    size_t room = room_for(e, &list);
    if (room >= 2) {
        if (e->moment_count >= room) thin_out(e);
        checkpoint *state = checkpoint_keep(e->device, list.parts, list.count);
        MEM_RESERVE(e->moments, e->moment_count + 1, e->moment_capacity);
        if (state) e->moments[e->moment_count++] = (effect_moment){e->last_frame, state};
    }
    checkpoint_list_free(&list);
}

bool effect_go_back(effect *e, double frame) {
    size_t i = e->moment_count;
    while (i > 0 && e->moments[i - 1].frame > frame) i--;
    return i > 0 && effect_take_state(e, e->moments[i - 1].state);
}
