// What burning gas tells of itself, and its checkpoints.
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include "pass/air/pyro_parts.h"
#include "sim/state.h"

static const float worst_residual = 0.05f; // of the greatest speed
static const double most_courant = 3;      // cells of the velocity a step

static double courant(const pyro_air *a) {
    const double cell = a->air.units.cell * pyro_ratio(pyro_get_desc(a->solver));
    return (double)a->report.speed * a->air.units.step / cell;
}

// What the report shows that is wrong; false: nothing.
static bool tell_report(pyro_air *a) {
    char *out = a->air.trouble, change[64];
    const size_t size = sizeof a->air.trouble;
    if (!a->air.reported) return false;
    if (a->air.desc.time_step > 0)
        snprintf(change, sizeof change, "'time_step' below %.3g s", a->air.desc.time_step);
    else
        snprintf(change, sizeof change, "'speed' above %.3g m/s", a->air.desc.speed);
    if (a->report.bad)
        snprintf(out, size, "the gas has stopped, in %u cells it is no number any more: set %s",
                 a->report.bad, change);
    else if (courant(a) > most_courant)
        snprintf(out, size, "gas at %.3g m/s crosses %.2g cells a step, and detail is lost: set %s",
                 (double)a->report.speed, courant(a), change);
    else if (a->report.residual > worst_residual * a->report.speed && courant(a) > 0.5)
        snprintf(out, size, "%.2g %% of the flow out of a cell is left to the next step: set %s%s",
                 100 * (double)(a->report.residual / a->report.speed), change,
                 a->air.solids.count ? ", or take colliders thicker than a few cells" : "");
    else
        return false;
    return true;
}

void pyro_air_look(pyro_air *a) {
    pyro_report report;
    if (pyro_read(a->solver, a->air.pass->host->device, &report)) {
        a->report = report;
        a->air.reported = true;
        a->air.stopped = report.bad > 0;
    }
    a->air.trouble[0] = '\0';
    if (!tell_report(a)) air_tell_absent(&a->air);
}

static const char *pyro_air_trouble(const pass *p) {
    pyro_air *a = pyro_air_of(p);
    pyro_air_look(a);
    return a->air.trouble[0] ? a->air.trouble : NULL;
}

static size_t pyro_air_readouts(const pass *p, pass_readout *out, size_t capacity) {
    pyro_air *a = pyro_air_of(p);
    pyro_air_look(a);
    const pyro_report *r = &a->report;
    const double cells = (double)a->air.desc.size[0] * a->air.desc.size[1] * a->air.desc.size[2];
    const double residual = r->speed > 0 ? (double)(r->residual / r->speed) : 0;
    const pass_readout all[] = {
        {"power", "MW", (double)r->power / 1e6},
        {"hottest", "K", (double)r->hottest},
        {"fuel", "kg", (double)r->fuel},
        {"fuel burnt", "kg", (double)r->burnt},
        {"soot", "kg", (double)r->soot},
        {"speed", "m/s", (double)r->speed},
        {"Courant number", "", courant(a)},
        {"residual", "%", 100 * residual},
        {"time step", "s", a->air.units.step},
        {"steps", "", (double)pyro_steps(a->solver)},
        {"cells", "", cells},
    };
    for (size_t i = 0; i < COUNT_OF(all) && i < capacity; i++) out[i] = all[i];
    return COUNT_OF(all);
}

// ---- checkpoints ------------------------------------------------------------------------------

static void pyro_air_save(const pass *p, checkpoint_list *out) {
    const pyro_air *a = pyro_air_of(p);
    strbuf more = {0};
    air_describe(&a->air, &more);
    // What could not be read is missed when it is loaded.
    if (!sim_state_list(&pyro_state_kind, a->solver, p->host->device, p->label, strbuf_text(&more),
                        out))
        log_write(LOG_WARNING, "%s: %s", p->label, err_get());
    air_save_templates(&a->air, out);
    strbuf_free(&more);
}

static bool pyro_air_load(pass *p, checkpoint *from) {
    pyro_air *a = pyro_air_of(p);
    strbuf more = {0};
    air_describe(&a->air, &more);
    air_restart(p);
    a->air.fresh = !sim_state_load(&pyro_state_kind, a->solver, p->host->device, p->label,
                                   strbuf_text(&more), from) ||
                   !air_load_templates(&a->air, from);
    strbuf_free(&more);
    return !a->air.fresh;
}

const pass_simulation pyro_simulation = {
    .left = air_left,
    .most = air_most,
    .reached = air_reached,
    .restart = air_restart,
    .save = pyro_air_save,
    .load = pyro_air_load,
    .readouts = pyro_air_readouts,
    .work = air_work,
    .trouble = pyro_air_trouble,
};
