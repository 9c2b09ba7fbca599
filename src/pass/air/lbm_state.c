// Simulated air in a checkpoint: the state of its solver, and what its time and place must be.
#include "sim/lbm_state.h"
#include "base/str.h"
#include "pass/air/lbm_parts.h"

static void describe(const lbm_air *a, strbuf *out) {
    const float *at = &a->desc.position.x;
    strbuf_add(out, "voxel_size = %.9g\n", a->units.cell);
    strbuf_add(out, "position = %g, %g, %g\n", (double)at[0], (double)at[1], (double)at[2]);
    strbuf_add(out, "time_step = %.9g\n", a->units.step);
    strbuf_add(out, "warm_up = %.9g\n", a->desc.warm_up);
}

void lbm_air_save(const pass *p, checkpoint_list *out) {
    const lbm_air *a = lbm_air_of(p);
    strbuf more = {0};
    describe(a, &more);
    lbm_state_list(a->solver, p->label, strbuf_text(&more), out);
    strbuf_free(&more);
}

bool lbm_air_load(pass *p, checkpoint *from) {
    lbm_air *a = lbm_air_of(p);
    strbuf more = {0};
    describe(a, &more);
    lbm_air_restart(p);
    a->shown_steps = UINT64_MAX;
    a->fresh = !lbm_state_load(a->solver, p->host->device, p->label, strbuf_text(&more), from);
    strbuf_free(&more);
    return !a->fresh;
}
