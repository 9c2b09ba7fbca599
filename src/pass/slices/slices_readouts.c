// What slices tell of themselves: what the device noticed some frames ago, and, to a checkpoint,
// their whole state.
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include "pass/slices/slices_templates_parts.h"
#include "sim/state.h"

// Cells that the flow may cross in a step before it is told of: beyond it, what is carried is
// guessed rather than followed.
static const double most_cells = 8;
// Times the tolerance that may be left of the divergence.
static const double most_left = 10;

static double courant(const slices_flow *f) {
    return (double)f->report.speed * f->clock.step / f->cell;
}

static void tell(const pass *p, slices_flow *f) {
    char *out = f->trouble;
    const size_t capacity = sizeof f->trouble;
    float tolerance[4];
    *out = '\0';
    if (!f->reported || !pass_evaluate_now(p, N_tolerance, tolerance)) return;
    if (courant(f) > most_cells)
        snprintf(
            out, capacity,
            "the flow crosses %.3g cells a step: set 'time_step' below %.2g s (it is %.2g), or "
            "'max_speed'",
            courant(f), f->clock.step * most_cells / courant(f), f->clock.step);
    else if ((double)f->report.residual > most_left * (double)tolerance[0])
        snprintf(out, capacity,
                 "the pressure leaves %.2g of the divergence, after %u iterations: set "
                 "'max_iterations' above that, or 'solver' to \"multigrid\"",
                 (double)f->report.residual, f->report.iterations);
}

// What has come back from the device by now.
static void look(const pass *p) {
    slices_flow *f = slices_of(p);
    if (!f->fresh && flow_read(f->solver, p->host->device, &f->report)) f->reported = true;
    tell(p, f);
}

static double work(const pass *p) {
    const slices_flow *f = slices_of(p);
    return (double)f->last_steps * f->desc.size[0] * f->desc.size[1] * f->desc.count;
}

static size_t readouts(const pass *p, pass_readout *out, size_t capacity) {
    const slices_flow *f = slices_of(p);
    flow_numbers now;
    look(p);
    if (!slices_numbers(p, &now)) now = (flow_numbers){0};
    float fastest[4];
    pass_evaluate_now(p, N_speed, fastest);
    double speed = (double)fastest[0], viscosity = (double)now.viscosity;
    double cells = (double)f->desc.size[0] * f->desc.size[1] * f->desc.count;
    const pass_readout all[] = {
        {"Reynolds", "", viscosity > 0 ? speed * f->desc.height / viscosity : 0},
        {"viscosity", "m^2/s", viscosity},
        {"time step", "s", f->clock.step},
        {"steps", "", (double)flow_steps(f->solver)},
        {"cells", "", cells},
        {"speed", "m/s", f->reported ? (double)f->report.speed : 0},
        {"Courant", "", f->reported ? courant(f) : 0},
        {"iterations", "", f->reported ? f->report.iterations : 0},
        {"residual", "", f->reported ? (double)f->report.residual : 0},
    };
    for (size_t i = 0; i < COUNT_OF(all) && i < capacity; i++) out[i] = all[i];
    return COUNT_OF(all);
}

static const char *trouble(const pass *p) {
    slices_flow *f = slices_of(p);
    look(p);
    return f->trouble[0] ? f->trouble : NULL;
}

// ---- in a checkpoint --------------------------------------------------------------------------

// The state of the solver and of the templates, and what the time and height must be.
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

static void slices_save(const pass *p, checkpoint_list *out) {
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

static bool slices_load(pass *p, checkpoint *from) {
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
