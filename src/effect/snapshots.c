// Snapshots of simulations. A simulation can only run forwards. In a window its state is therefore
// copied from time to time, so that a jump back or forth restores the snapshot before the frame and
// simulates only the rest, not everything from the beginning. Copies stay on the device, in the
// order of their frames. When there is no more room for them, every second one is dropped, and the
// distance between new ones is doubled.
//
// A snapshot holds only for the numbers that it was computed with: when a user changes a number,
// all are dropped; when a user changes an event, those after it. Only the one that a branch begins
// with stays, for it is what makes the branch.
#include "base/budget.h"
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include "sim/checkpoint.h"
#include <math.h>
#include <string.h>

enum { MAX_SNAPSHOTS = 32 };
static const double least_gap = 1;                    // seconds between two
static const uint64_t most_bytes = UINT64_C(1) << 30; // of all
static const uint64_t most_part = 8;                  // of the device's memory, one in so many

struct effect_branch {
    effect_snapshots snapshots;
};

void effect_free_snapshots(effect_snapshots *s) {
    for (size_t i = 0; i < s->count; i++) checkpoint_close(s->list[i].state);
    mem_free(s->list);
    *s = (effect_snapshots){0};
}

// Keeps those for which `holds` says so.
static void forget(effect *e, bool (*holds)(const effect_snapshot *one, double frame),
                   double frame) {
    effect_snapshots *s = &e->snapshots;
    size_t count = 0;
    for (size_t i = 0; i < s->count; i++) {
        if (holds(&s->list[i], frame))
            s->list[count++] = s->list[i];
        else
            checkpoint_close(s->list[i].state);
    }
    s->count = count;
}

static bool is_root(const effect_snapshot *one, double frame) {
    (void)frame;
    return one->root;
}

static bool is_before(const effect_snapshot *one, double frame) {
    return one->frame < frame;
}

void effect_forget_snapshots(effect *e) {
    forget(e, is_root, 0);
    e->snapshots.gap = 0;
}

void effect_forget_snapshots_from(effect *e, double time) {
    forget(e, is_before, time * e->facts.fps + e->facts.first);
}

// ---- keeping ----------------------------------------------------------------------------------

static double gap_of(const effect *e) { // frames
    return e->snapshots.gap > 0 ? e->snapshots.gap : least_gap * e->facts.fps;
}

// Returns the number of snapshots up to a frame.
static size_t count_until(const effect *e, double frame) {
    size_t i = e->snapshots.count;
    while (i > 0 && e->snapshots.list[i - 1].frame > frame) i--;
    return i;
}

// The beginning needs none.
static bool is_due(const effect *e, double frame) {
    const effect_snapshots *s = &e->snapshots;
    if (!e->compiled || !graph_simulates(e->graph)) return false;
    size_t i = count_until(e, frame);
    double before = i ? s->list[i - 1].frame : (double)e->facts.first;
    double after = i < s->count ? s->list[i].frame : (double)INFINITY;
    return frame >= before + gap_of(e) && frame + gap_of(e) <= after && effect_can_save(e);
}

static size_t room_for(const effect *e, const checkpoint_list *list) {
    uint64_t bytes = 1, most = gpu_get_info(e->device)->memory / most_part;
    for (size_t i = 0; i < list->count; i++) bytes += list->parts[i].size;
    if (most > most_bytes) most = most_bytes;
    // Half of the memory that is still free is left for what is drawn.
    uint64_t left = budget_room(gpu_get_budget(e->device)) / 2 + e->snapshots.count * bytes;
    if (most > left) most = left;
    return most / bytes < MAX_SNAPSHOTS ? (size_t)(most / bytes) : MAX_SNAPSHOTS;
}

static void thin_out(effect *e) {
    effect_snapshots *s = &e->snapshots;
    size_t count = 0;
    for (size_t i = 0; i < s->count; i++) {
        if (i % 2 == 0 && !s->list[i].root)
            checkpoint_close(s->list[i].state);
        else
            s->list[count++] = s->list[i];
    }
    s->count = count;
    s->gap = 2 * gap_of(e);
}

static void insert(effect *e, double frame, checkpoint *state) {
    effect_snapshots *s = &e->snapshots;
    MEM_RESERVE(s->list, s->count + 1, s->capacity);
    size_t at = count_until(e, frame);
    memmove(&s->list[at + 1], &s->list[at], (s->count - at) * sizeof *s->list);
    s->list[at] = (effect_snapshot){.frame = frame, .state = state};
    s->count++;
}

void effect_keep_snapshot(effect *e, double frame) {
    checkpoint_list list = {0};
    if (!is_due(e, frame)) return;
    effect_list_state(e, frame, &list);
    size_t room = room_for(e, &list);
    if (room >= 2) {
        if (e->snapshots.count >= room) thin_out(e);
        checkpoint *state = checkpoint_keep(e->device, list.parts, list.count);
        if (state) insert(e, frame, state);
    }
    checkpoint_list_free(&list);
}

bool effect_take_snapshot(effect *e, double frame, double after) {
    size_t count = count_until(e, frame);
    if (count == 0) return false;
    const effect_snapshot *last = &e->snapshots.list[count - 1];
    return last->frame > after && effect_take_state(e, last->state);
}

size_t effect_list_snapshots(const effect *e, double *frames, size_t capacity) {
    const effect_snapshots *s = &e->snapshots;
    for (size_t i = 0; i < s->count && i < capacity; i++) frames[i] = s->list[i].frame;
    return s->count;
}

// ---- branches ---------------------------------------------------------------------------------

static checkpoint *keep_root(effect *e) {
    checkpoint_list list = {0};
    effect_list_state(e, e->last_frame, &list);
    checkpoint *state = checkpoint_keep(e->device, list.parts, list.count);
    checkpoint_list_free(&list);
    return state;
}

effect_branch *effect_branch_begin(effect *e) {
    if (!e->compiled || !graph_simulates(e->graph) || !effect_can_save(e) || e->behind)
        return ERR_NULL("%s: nothing in it has a state to branch off from", e->facts.file);
    checkpoint *state = keep_root(e);
    if (!state) return NULL;
    effect_branch *b = mem_alloc(sizeof *b);
    b->snapshots.list = mem_alloc(sizeof *b->snapshots.list);
    b->snapshots.list[0] = (effect_snapshot){.frame = e->last_frame, .root = true, .state = state};
    b->snapshots.count = b->snapshots.capacity = 1;
    return b;
}

effect_branch *effect_branch_leave(effect *e) {
    effect_branch *b = mem_alloc(sizeof *b);
    b->snapshots = e->snapshots;
    e->snapshots = (effect_snapshots){0};
    return b;
}

void effect_branch_enter(effect *e, effect_branch *b) {
    effect_free_snapshots(&e->snapshots);
    if (b) e->snapshots = b->snapshots;
    mem_free(b);
    if (e->compiled) effect_stop_simulations(e);
}

void effect_branch_destroy(effect_branch *b) {
    if (!b) return;
    effect_free_snapshots(&b->snapshots);
    mem_free(b);
}
