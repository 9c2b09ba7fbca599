// Simulated air in a checkpoint: the state of its solver, and what its time and place must be.
#include "sim/lbm_state.h"
#include "base/str.h"
#include "pass/air/lbm_parts.h"

void lbm_air_save(const pass *p, checkpoint_list *out) {
    const lbm_air *a = lbm_air_of(p);
    strbuf more = {0};
    air_describe(&a->air, &more);
    lbm_state_list(a->solver, p->label, strbuf_text(&more), out);
    air_save_templates(&a->air, out);
    strbuf_free(&more);
}

bool lbm_air_load(pass *p, checkpoint *from) {
    lbm_air *a = lbm_air_of(p);
    strbuf more = {0};
    air_describe(&a->air, &more);
    air_restart(p);
    a->air.fresh =
        !lbm_state_load(a->solver, p->host->device, p->label, strbuf_text(&more), from) ||
        !air_load_templates(&a->air, from);
    strbuf_free(&more);
    return !a->air.fresh;
}
