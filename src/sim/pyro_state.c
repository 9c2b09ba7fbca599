#include "sim/pyro_state.h"
#include "base/str.h"
#include "sim/pyro_impl.h"
#include "sim/state.h"

static void pyro_describe(const pyro_desc *desc, const char *more, strbuf *out) {
    static const char *const faces[] = {"left", "right", "front", "back", "bottom", "top"};
    static const char *const kinds[] = {"open", "wall", "inflow", "periodic"};
    static const char *const precisions[] = {"f32", "f16"};
    strbuf_add(out, "size = %u x %u x %u\n", desc->size[0], desc->size[1], desc->size[2]);
    strbuf_add(out, "precision = %s\n", precisions[desc->precision]);
    strbuf_add(out, "velocity = %s\n", desc->half_velocity ? "half" : "full");
    if (desc->smoke) strbuf_add(out, "smoke = yes\n");
    for (int i = 0; i < 6; i++) strbuf_add(out, "%s = %s\n", faces[i], kinds[desc->faces[i]]);
    strbuf_add(out, "%s", more);
}

// All that it would set is overwritten.
static bool state_reset(void *solver, gpu *g) {
    return pyro_reset(solver, g, &(pyro_numbers){.ambient = 300});
}

static sim_state state_of(pyro *p, const char *lines) {
    sim_state s = {.kind = "pyro",
                   .lines = lines,
                   .steps = &p->steps,
                   .kept = &p->kept,
                   .buffer_names = {"velocity", "gas", "pressure", "smoke"},
                   .image_names = {"gas", "flow", "smoke"},
                   .reset = state_reset,
                   .solver = p};
    s.buffer_count = pyro_buffers(p, s.buffers);
    for (pyro_look i = 0; i < PYRO_LOOKS && pyro_has_look(p, i); i++) {
        s.image_count++;
        s.image_descs[i] = pyro_describe_image(p, i);
        for (int which = 0; which < 2; which++) s.images[which][i] = &p->looks[which][i];
    }
    return s;
}

bool pyro_state_list(pyro *p, gpu *g, const char *label, const char *more, checkpoint_list *out) {
    strbuf text = {0};
    pyro_describe(&p->desc, more, &text);
    const sim_state s = state_of(p, strbuf_text(&text));
    bool done = sim_state_list(&s, g, label, out);
    strbuf_free(&text);
    return done;
}

bool pyro_state_load(pyro *p, gpu *g, const char *label, const char *more, checkpoint *c) {
    strbuf text = {0};
    pyro_describe(&p->desc, more, &text);
    // A reset goes back to the first buffers of each pair, into which the state is loaded.
    const uint32_t current = p->current;
    p->current = 0;
    const sim_state s = state_of(p, strbuf_text(&text));
    bool done = sim_state_load(&s, g, label, c);
    if (!done) p->current = current;
    strbuf_free(&text);
    return done;
}
