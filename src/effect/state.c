// Saves and loads the states of all simulations. Histories of pictures are not saved; they start
// again.
#include "base/error.h"
#include "effect/effect_impl.h"
#include "sim/checkpoint.h"
#include <math.h>

typedef struct effect_clock { // as it lies in the file
    double frame;             // rendered last
} effect_clock;

static const char clock_name[] = "effect/clock";

// Returns the next pass that simulates and runs, from `*index` on; NULL: there are no more.
static pass *next_simulation(const effect *e, size_t *index, const pass_simulation **out) {
    while (*index < e->pass_count) {
        pass *p = e->passes[(*index)++];
        *out = pass_get_simulation(p);
        if (*out && effect_runs(e, p)) return p;
    }
    return NULL;
}

bool effect_can_save(const effect *e) {
    const pass_simulation *simulation;
    pass *p;
    for (size_t i = 0; (p = next_simulation(e, &i, &simulation));)
        if (!simulation->save || !simulation->load || !isfinite(simulation->reached(p)))
            return false;
    return true;
}

static bool is_ready(const effect *e) {
    return (e->compiled && graph_simulates(e->graph)) ||
           err_set("%s: nothing in it simulates, so it has no state to keep", e->facts.file);
}

void effect_list_state(const effect *e, double frame, checkpoint_list *out) {
    const pass_simulation *simulation;
    effect_clock *clock = arena_alloc(&out->memory, sizeof *clock);
    clock->frame = frame;
    checkpoint_add(out, &(checkpoint_part){
                            .name = clock_name, .size = sizeof *clock, .width = 8, .bytes = clock});
    pass *p;
    for (size_t i = 0; (p = next_simulation(e, &i, &simulation));) simulation->save(p, out);
}

bool effect_save_state(effect *e, const char *path) {
    const pass_simulation *simulation;
    checkpoint_list list = {0};
    if (!is_ready(e)) return false;
    pass *p;
    for (size_t i = 0; (p = next_simulation(e, &i, &simulation));) {
        if (!isfinite(simulation->reached(p)))
            return err_set("%s: nothing is simulated yet: render a frame first", pass_label(p));
    }
    effect_list_state(e, e->last_frame, &list);
    bool done = checkpoint_save(path, e->device, list.parts, list.count);
    checkpoint_list_free(&list);
    return done;
}

static bool state_load(effect *e, checkpoint *c) {
    const pass_simulation *simulation;
    effect_clock clock;
    const checkpoint_part own = {.name = clock_name, .size = sizeof clock, .bytes = &clock};
    if (!checkpoint_load(c, NULL, &own)) return false;
    if (!isfinite(clock.frame)) return err_set("the checkpoint's frame is no number");
    pass *p;
    for (size_t i = 0; (p = next_simulation(e, &i, &simulation));)
        if (!simulation->load(p, c)) return false;
    graph_reset_history(e->graph);
    e->has_last = false;
    e->last_frame = e->updated = clock.frame;
    e->partly = (double)NAN;
    return true;
}

bool effect_take_state(effect *e, checkpoint *c) {
    bool done = state_load(e, c);
    if (!done) effect_restart(e); // not half of one and half of another
    return done;
}

bool effect_load_state(effect *e, const char *path, double *frame) {
    if (!is_ready(e)) return false;
    checkpoint *c = checkpoint_open(path);
    bool done = c && effect_take_state(e, c);
    checkpoint_close(c);
    effect_forget_snapshots(e);
    if (done) *frame = e->last_frame;
    return done;
}
