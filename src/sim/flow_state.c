#include "sim/flow_impl.h"
#include "sim/state.h"

static void flow_describe(const void *solver, strbuf *out) {
    static const char *const faces[] = {"left", "right", "bottom", "top"};
    static const char *const kinds[] = {"closed", "open", "periodic"};
    const flow_desc *desc = &((const flow *)solver)->desc;
    strbuf_add(out, "size = %u x %u\n", desc->size[0], desc->size[1]);
    strbuf_add(out, "slices = %u\n", desc->slices);
    for (int i = 0; i < 4; i++) strbuf_add(out, "%s = %s\n", faces[i], kinds[desc->faces[i]]);
}

static bool state_reset(void *solver, gpu *g) {
    return flow_reset(solver, g);
}

static void flow_find_state(void *solver, sim_state *out) {
    flow *f = solver;
    *out = (sim_state){.steps = &f->steps,
                       .kept = &f->kept,
                       .buffer_count = FLOW_STATE_BUFFERS,
                       .image_count = FLOW_LOOKS,
                       .buffer_names = {"velocity", "scalars", "pressure"},
                       .image_names = {"scalars", "velocity"}};
    flow_buffers(f, out->buffers);
    for (flow_look i = 0; i < FLOW_LOOKS; i++) {
        out->image_descs[i] = flow_describe_look(f, i);
        for (int which = 0; which < 2; which++) out->images[which][i] = &f->looks[which][i];
    }
}

const sim_state_kind flow_state_kind = {"flow", flow_describe, flow_find_state, state_reset};
