// Snapshots of simulations. A simulation can only run forwards. While a window plays, its state is
// therefore copied from time to time, so that a jump back restores the snapshot before the frame
// and simulates only the rest, not everything from the beginning. Copies stay on the device. When
// there is no more room for them, every second one is dropped, and the distance between new ones is
// doubled.
//
// A snapshot holds only for the numbers that it was computed with: when a user changes a number,
// all are dropped; when a user changes an event, those after it.
#include "base/budget.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include "sim/checkpoint.h"

enum { MAX_SNAPSHOTS = 32 };
static const double least_gap = 1;                    // seconds between two
static const uint64_t most_bytes = UINT64_C(1) << 30; // of all
static const uint64_t most_part = 8;                  // of the device's memory, one in so many

void effect_forget_snapshots(effect *e) {
    for (size_t i = 0; i < e->snapshot_count; i++) checkpoint_close(e->snapshots[i].state);
    e->snapshot_count = 0;
    e->snapshot_gap = 0;
}

void effect_forget_snapshots_from(effect *e, double time) {
    while (e->snapshot_count > 0) {
        effect_snapshot *last = &e->snapshots[e->snapshot_count - 1];
        if ((last->frame - e->first) / e->fps < time) return;
        checkpoint_close(last->state);
        e->snapshot_count--;
    }
}

static double gap_of(const effect *e) { // frames
    return e->snapshot_gap > 0 ? e->snapshot_gap : least_gap * e->fps;
}

static bool is_due(const effect *e) {
    double last = e->snapshot_count ? e->snapshots[e->snapshot_count - 1].frame : (double)e->first;
    return !e->behind && graph_simulates(e->graph) && e->last_frame >= last + gap_of(e) &&
           effect_can_save(e);
}

static size_t room_for(const effect *e, const checkpoint_list *list) {
    uint64_t bytes = 1, most = gpu_get_info(e->device)->memory / most_part;
    for (size_t i = 0; i < list->count; i++) bytes += list->parts[i].size;
    if (most > most_bytes) most = most_bytes;
    // Half of the memory that is still free is left for what is drawn.
    uint64_t left = budget_room(gpu_get_budget(e->device)) / 2 + e->snapshot_count * bytes;
    if (most > left) most = left;
    return most / bytes < MAX_SNAPSHOTS ? (size_t)(most / bytes) : MAX_SNAPSHOTS;
}

static void thin_out(effect *e) {
    size_t count = 0;
    for (size_t i = 0; i < e->snapshot_count; i++) {
        if (i % 2 == 0)
            checkpoint_close(e->snapshots[i].state);
        else
            e->snapshots[count++] = e->snapshots[i];
    }
    e->snapshot_count = count;
    e->snapshot_gap = 2 * gap_of(e);
}

void effect_keep_snapshot(effect *e) {
    checkpoint_list list = {0};
    if (!is_due(e)) return;
    effect_list_state(e, &list);
    size_t room = room_for(e, &list);
    if (room >= 2) {
        if (e->snapshot_count >= room) thin_out(e);
        checkpoint *state = checkpoint_keep(e->device, list.parts, list.count);
        MEM_RESERVE(e->snapshots, e->snapshot_count + 1, e->snapshot_capacity);
        if (state) e->snapshots[e->snapshot_count++] = (effect_snapshot){e->last_frame, state};
    }
    checkpoint_list_free(&list);
}

bool effect_go_back(effect *e, double frame) {
    size_t i = e->snapshot_count;
    while (i > 0 && e->snapshots[i - 1].frame > frame) i--;
    return i > 0 && effect_take_state(e, e->snapshots[i - 1].state);
}
