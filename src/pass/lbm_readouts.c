// What simulated air tells of itself, and the guard: what the device noticed some frames ago.
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include "pass/builtin.h"
#include "pass/lbm_parts.h"
#include <math.h>
#include <string.h>

static double measured(const lbm_air *a) { // m/s
    return (double)a->report.speed * a->units.cell / a->units.step;
}

// Air that is as fast as it may be would be faster.
static bool is_held_back(const lbm_air *a) {
    return !a->stops && (double)a->report.speed * sqrt(3) > 0.99 * SIM_MACH_MAX;
}

// What the guard saw; false: nothing.
static bool tell_report(lbm_air *a, const sim_flow *flow) {
    char *out = a->trouble;
    const size_t capacity = sizeof a->trouble;
    if (!a->reported) return false;
    if (!a->report.bad && !is_held_back(a))
        return sim_advise_speed(&a->units, flow, measured(a), out, capacity);
    if (a->report.bad)
        snprintf(out, capacity,
                 "the air in %u cells is no number any more: set 'speed' above %.3g m/s, or "
                 "'collision' to \"central_moments\"",
                 a->report.bad, a->desc.speed);
    else
        snprintf(out, capacity,
                 "air is held back at %.3g m/s, Mach %g on the lattice: set 'speed' above that (it "
                 "is %.3g)",
                 measured(a), SIM_MACH_MAX, a->desc.speed);
    return true;
}

static void tell(lbm_air *a) {
    sim_flow flow = lbm_air_flow(a->pass);
    if (!tell_report(a, &flow) && !sim_advise(&a->units, &flow, a->trouble, sizeof a->trouble))
        a->trouble[0] = '\0';
}

// What stops air: that it is beyond help, or, if that is wanted, that it is too fast.
static bool must_stop(const lbm_air *a) {
    return a->report.bad || (a->stops && (double)a->report.speed * sqrt(3) > SIM_MACH_MAX);
}

// What has come back from the device by now.
static void look(lbm_air *a) {
    lbm_report report;
    if (lbm_guard_read(a->guard, a->pass->host->device, &report)) {
        a->report = report;
        a->reported = true;
        a->stopped = must_stop(a);
    }
    tell(a);
}

bool lbm_air_watch(pass *p) {
    lbm_air *a = lbm_air_of(p);
    look(a);
    return !a->last_steps || lbm_guard_record(a->guard, p->host->device, a->solver);
}

const char *lbm_air_trouble(const pass *p) {
    lbm_air *a = lbm_air_of(p);
    look(a);
    return a->trouble[0] ? a->trouble : NULL;
}

double lbm_air_work(const pass *p) {
    const lbm_air *a = lbm_air_of(p);
    return (double)a->last_steps * a->desc.size[0] * a->desc.size[1] * a->desc.size[2];
}

size_t lbm_air_readouts(const pass *p, pass_readout *out, size_t capacity) {
    lbm_air *a = lbm_air_of(p);
    look(a);
    sim_flow flow = lbm_air_flow(p);
    if (a->reported) flow.speed = measured(a);
    sim_readout now = sim_judge(&a->units, &flow);
    double cells = (double)a->desc.size[0] * a->desc.size[1] * a->desc.size[2];
    const pass_readout all[] = {
        {"tau", "", now.tau},
        {"Mach", "", now.mach},
        {"Reynolds", "", now.reynolds},
        {"speed", "m/s", flow.speed},
        {"time step", "s", a->units.step},
        {"steps", "", (double)lbm_steps(a->solver)},
        {"cells", "", cells},
        {"mass drift", "%", a->reported ? 100 * (double)a->report.drift : 0},
    };
    for (size_t i = 0; i < COUNT_OF(all) && i < capacity; i++) out[i] = all[i];
    return COUNT_OF(all);
}

const pass_simulation lbm_simulation = {
    .left = lbm_air_left,
    .most = lbm_air_most,
    .reached = lbm_air_reached,
    .restart = lbm_air_restart,
    .save = lbm_air_save,
    .load = lbm_air_load,
    .readouts = lbm_air_readouts,
    .work = lbm_air_work,
    .trouble = lbm_air_trouble,
};
