// What slices tell of themselves.
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/slices_parts.h"

static double work(const pass *p) {
    const slices_flow *f = slices_of(p);
    return (double)f->last_steps * f->desc.size[0] * f->desc.size[1] * f->desc.count;
}

static size_t readouts(const pass *p, pass_readout *out, size_t capacity) {
    const slices_flow *f = slices_of(p);
    flow_numbers now;
    if (!slices_numbers(p, &now)) now = (flow_numbers){0};
    double speed = (double)pass_evaluate(p, "speed"), viscosity = (double)now.viscosity;
    double cells = (double)f->desc.size[0] * f->desc.size[1] * f->desc.count;
    const pass_readout all[] = {
        {"Reynolds", "", viscosity > 0 ? speed * f->desc.height / viscosity : 0},
        {"viscosity", "m^2/s", viscosity},
        {"time step", "s", f->clock.step},
        {"steps", "", (double)flow_steps(f->solver)},
        {"cells", "", cells},
    };
    for (size_t i = 0; i < COUNT_OF(all) && i < capacity; i++) out[i] = all[i];
    return COUNT_OF(all);
}

static const char *trouble(const pass *p) {
    (void)p;
    return NULL;
}

const pass_simulation slices_simulation = {
    .left = slices_left,
    .most = slices_most,
    .reached = slices_reached,
    .restart = slices_restart,
    .save = slices_save,
    .load = slices_load,
    .readouts = readouts,
    .work = work,
    .trouble = trouble,
};
