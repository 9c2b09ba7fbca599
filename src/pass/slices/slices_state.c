// Slices in a checkpoint: the state of their solver and of their templates, and what their time and
// height must be.
#include "base/error.h"
#include "base/log.h"
#include "base/str.h"
#include "pass/slices/slices_templates_parts.h"
#include "sim/state.h"

static void describe(const slices_flow *f, strbuf *out) {
    strbuf_add(out, "height = %.9g\n", f->desc.height);
    strbuf_add(out, "time_step = %.9g\n", f->clock.step);
    strbuf_add(out, "warm_up = %.9g\n", f->clock.warm_up);
}

static bool templates_part(const pass *p, arena *memory, checkpoint_part *out) {
    gpu_buffer *buffer = slices_templates_buffer(p);
    if (!buffer) return false;
    *out = (checkpoint_part){.name = arena_format(memory, "%s/templates", p->label),
                             .size = gpu_buffer_size(buffer),
                             .width = 4,
                             .buffer = buffer};
    return true;
}

void slices_save(const pass *p, checkpoint_list *out) {
    const slices_flow *f = slices_of(p);
    strbuf more = {0};
    checkpoint_part templates;
    describe(f, &more);
    // What could not be read is missed when it is loaded.
    if (!sim_state_list(&flow_state_kind, f->solver, p->host->device, p->label, strbuf_text(&more),
                        out))
        log_write(LOG_WARNING, "%s: %s", p->label, err_get());
    if (templates_part(p, &out->memory, &templates)) checkpoint_add(out, &templates);
    strbuf_free(&more);
}

bool slices_load(pass *p, checkpoint *from) {
    slices_flow *f = slices_of(p);
    gpu *device = p->host->device;
    strbuf more = {0};
    arena memory = {0};
    checkpoint_part templates;
    describe(f, &more);
    slices_restart(p);
    bool done =
        sim_state_load(&flow_state_kind, f->solver, device, p->label, strbuf_text(&more), from);
    if (done && templates_part(p, &memory, &templates)) {
        done = checkpoint_load(from, device, &templates);
        if (done) f->templates->set.fresh = false;
    }
    f->fresh = !done;
    strbuf_free(&more);
    arena_free(&memory);
    return done;
}
