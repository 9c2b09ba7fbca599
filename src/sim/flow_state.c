#include "sim/flow_state.h"
#include "base/str.h"
#include "sim/flow_impl.h"
#include "sim/state.h"

static void flow_describe(const flow_desc *desc, const char *more, strbuf *out) {
    static const char *const faces[] = {"left", "right", "bottom", "top"};
    static const char *const kinds[] = {"closed", "open", "periodic"};
    strbuf_add(out, "size = %u x %u\n", desc->size[0], desc->size[1]);
    strbuf_add(out, "slices = %u\n", desc->slices);
    for (int i = 0; i < 4; i++) strbuf_add(out, "%s = %s\n", faces[i], kinds[desc->faces[i]]);
    strbuf_add(out, "%s", more);
}

static bool state_reset(void *solver, gpu *g) {
    return flow_reset(solver, g);
}

static sim_state state_of(flow *f, const char *lines) {
    sim_state s = {.kind = "flow",
                   .lines = lines,
                   .steps = &f->steps,
                   .kept = &f->kept,
                   .buffer_count = FLOW_STATE_BUFFERS,
                   .image_count = FLOW_LOOKS,
                   .buffer_names = {"velocity", "scalars", "pressure"},
                   .image_names = {"scalars", "velocity"},
                   .reset = state_reset,
                   .solver = f};
    flow_buffers(f, s.buffers);
    for (flow_look i = 0; i < FLOW_LOOKS; i++) {
        s.image_descs[i] = flow_describe_look(f, i);
        for (int which = 0; which < 2; which++) s.images[which][i] = &f->looks[which][i];
    }
    return s;
}

bool flow_state_list(flow *f, gpu *g, const char *label, const char *more, checkpoint_list *out) {
    strbuf text = {0};
    flow_describe(&f->desc, more, &text);
    const sim_state s = state_of(f, strbuf_text(&text));
    bool done = sim_state_list(&s, g, label, out);
    strbuf_free(&text);
    return done;
}

bool flow_state_load(flow *f, gpu *g, const char *label, const char *more, checkpoint *c) {
    strbuf text = {0};
    flow_describe(&f->desc, more, &text);
    // A reset goes back to the first buffers of each pair, into which the state is loaded.
    const uint32_t current = f->current;
    f->current = 0;
    const sim_state s = state_of(f, strbuf_text(&text));
    bool done = sim_state_load(&s, g, label, c);
    if (!done) f->current = current;
    strbuf_free(&text);
    return done;
}
