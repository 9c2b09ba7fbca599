#include "sim/pyro_impl.h"
#include "sim/state.h"

static void pyro_describe(const void *solver, strbuf *out) {
    static const char *const faces[] = {"left", "right", "front", "back", "bottom", "top"};
    static const char *const kinds[] = {"open", "wall", "inflow", "periodic"};
    static const char *const precisions[] = {"f32", "f16"};
    const pyro_desc *desc = &((const pyro *)solver)->desc;
    strbuf_add(out, "size = %u x %u x %u\n", desc->size[0], desc->size[1], desc->size[2]);
    strbuf_add(out, "precision = %s\n", precisions[desc->precision]);
    strbuf_add(out, "velocity = %s\n", desc->half_velocity ? "half" : "full");
    if (desc->smoke) strbuf_add(out, "smoke = yes\n");
    for (int i = 0; i < 6; i++) strbuf_add(out, "%s = %s\n", faces[i], kinds[desc->faces[i]]);
}

// All that it would set is overwritten.
static bool state_reset(void *solver, gpu *g) {
    return pyro_reset(solver, g, &(pyro_numbers){.ambient = 300});
}

static void pyro_find_state(void *solver, sim_state *out) {
    pyro *p = solver;
    *out = (sim_state){.steps = &p->steps,
                       .kept = &p->kept,
                       .buffer_names = {"velocity", "gas", "pressure", "smoke"},
                       .image_names = {"gas", "flow", "smoke"}};
    out->buffer_count = pyro_buffers(p, out->buffers);
    for (pyro_look i = 0; i < PYRO_LOOKS && pyro_has_look(p, i); i++) {
        out->image_count++;
        out->image_descs[i] = pyro_describe_image(p, i);
        for (int which = 0; which < 2; which++) out->images[which][i] = &p->looks[which][i];
    }
}

const sim_state_kind pyro_state_kind = {"pyro", pyro_describe, pyro_find_state, state_reset};
