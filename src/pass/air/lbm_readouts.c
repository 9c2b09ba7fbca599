// What simulated air tells of itself, and the guard: what the device noticed some frames ago. Its
// state in a checkpoint, and what its time and place must be.
#include "base/memory.h"
#include "base/str.h"
#include "pass/air/lbm_parts.h"
#include "sim/lbm_state.h"
#include <math.h>

// Of the air's mass, either way: more is not air that was blown or drawn, but a solver that fails.
static const float spoilt_drift = 0.5f;

static double measured(const lbm_air *a) { // m/s
    return (double)a->report.speed * a->air.units.cell / a->air.units.step;
}

static double mach(const lbm_air *a) {
    return (double)a->report.speed * sqrt(3);
}

// Air that is as fast as it may be would be faster.
static bool is_held_back(const lbm_air *a) {
    return !a->stops && mach(a) > 0.99 * SIM_MACH_MAX;
}

// Beyond help, however fast it is.
static bool is_ruined(const lbm_air *a) {
    return a->report.spoilt & (LBM_SPOILT_NUMBERS | LBM_SPOILT_MASS);
}

// Air that burst tells nothing of how fast it should have been.
static void tell_burst(lbm_air *a) {
    char what[128], change[64];
    if (a->report.bad)
        snprintf(what, sizeof what, "in %u cells it is no number any more", a->report.bad);
    else if (is_ruined(a) && fabsf(a->report.drift) > 1)
        snprintf(what, sizeof what, "its mass is that of no air any more");
    else if (is_ruined(a))
        snprintf(what, sizeof what, "its mass changed by %.3g %%", 100 * (double)a->report.drift);
    else
        snprintf(what, sizeof what, "it became Mach %.2g on the lattice", mach(a));
    if (a->air.desc.time_step > 0)
        snprintf(change, sizeof change, "'time_step' below %.3g s", a->air.desc.time_step);
    else
        snprintf(change, sizeof change, "'speed' above %.3g m/s", a->air.desc.speed);
    bool sturdy = lbm_get_desc(a->solver)->collision == LBM_CENTRAL_MOMENTS;
    snprintf(a->air.trouble, sizeof a->air.trouble,
             "the air burst and has stopped, %s: set %s, for the fastest that sources, forces and "
             "meshes make it%s",
             what, change, sturdy ? "" : ", or 'collision' to \"central_moments\"");
}

// As fast as it may be, and when it was that: now, or in passing.
static void tell_held_back(lbm_air *a, const char *when) {
    char change[64];
    if (a->air.desc.time_step > 0)
        snprintf(change, sizeof change, "'time_step' below %.3g s", a->air.desc.time_step);
    else
        snprintf(change, sizeof change, "'speed' above that (it is %.3g)", a->air.desc.speed);
    snprintf(a->air.trouble, sizeof a->air.trouble,
             "air %s held back at %.3g m/s, Mach %g on the lattice: set %s", when,
             SIM_MACH_MAX / sqrt(3) * a->air.units.cell / a->air.units.step, SIM_MACH_MAX, change);
}

// What is over is still in the smoke.
static bool tell_was_held_back(lbm_air *a) {
    char when[64];
    if (isnan(a->held)) return false;
    snprintf(when, sizeof when, "was, from %.3g s on,", a->held);
    tell_held_back(a, when);
    return true;
}

// What the guard saw; false: nothing.
static bool tell_report(lbm_air *a, const sim_flow *flow) {
    if (!a->air.reported) return false;
    if (is_ruined(a) || (a->stops && mach(a) > 1))
        tell_burst(a);
    else if (is_held_back(a))
        tell_held_back(a, "is");
    else
        return sim_advise_speed(&a->air.units, flow, measured(a), a->air.trouble,
                                sizeof a->air.trouble);
    return true;
}

// What the air never met is most likely in the wrong place.
static void tell_absent(lbm_air *a) {
    if (!air_tell_absent(&a->air)) a->air.trouble[0] = '\0';
}

static bool is_buried(const lbm_air *a, const pass *source) {
    const uint32_t *notes = a->report.notes;
    return (notes[0] & ~notes[1] & air_source_of(source)->note) != 0;
}

// What gives nothing since solids are where it would.
static void tell_buried(lbm_air *a) {
    for (size_t i = 0; i < a->air.source_count; i++) {
        if (!is_buried(a, a->air.sources[i])) continue;
        snprintf(a->air.trouble, sizeof a->air.trouble,
                 "%s lies within colliders or walls, and has given the air nothing so far: move "
                 "it, or them",
                 pass_label(a->air.sources[i]));
        return;
    }
}

static void tell(lbm_air *a) {
    sim_flow flow = lbm_air_flow(a->air.pass);
    if (!tell_report(a, &flow) &&
        !sim_advise(&a->air.units, &flow, a->air.trouble, sizeof a->air.trouble) &&
        !tell_was_held_back(a))
        tell_absent(a);
    if (!a->air.trouble[0]) tell_buried(a);
}

// What has come back from the device by now.
static void look(lbm_air *a) {
    lbm_report report;
    if (lbm_guard_read(a->guard, a->air.pass->host->device, &report)) {
        a->report = report;
        a->air.reported = true;
        a->air.stopped = report.spoilt != 0;
        if (is_held_back(a) && isnan(a->held)) a->held = air_step_time(&a->air, report.step);
    }
    tell(a);
}

bool lbm_air_watch(pass *p) {
    lbm_air *a = lbm_air_of(p);
    look(a);
    // A state that was taken over has not been looked at yet.
    if (!a->air.last_steps && (a->air.fresh || lbm_guard_newest(a->guard))) return true;
    return lbm_guard_record(
        a->guard, p->host->device, a->solver,
        (lbm_guard_limits){.speed = lbm_air_spoilt_speed(a), .drift = spoilt_drift});
}

static const char *lbm_air_trouble(const pass *p) {
    lbm_air *a = lbm_air_of(p);
    look(a);
    return a->air.trouble[0] ? a->air.trouble : NULL;
}

static size_t lbm_air_readouts(const pass *p, pass_readout *out, size_t capacity) {
    lbm_air *a = lbm_air_of(p);
    look(a);
    sim_flow flow = lbm_air_flow(p);
    if (a->air.reported) flow.speed = measured(a);
    sim_readout now = sim_judge(&a->air.units, &flow);
    double cells = (double)a->air.desc.size[0] * a->air.desc.size[1] * a->air.desc.size[2];
    const pass_readout all[] = {
        {"tau", "", now.tau},
        {"Mach", "", now.mach},
        {"Reynolds", "", now.reynolds},
        {"speed", "m/s", flow.speed},
        {"time step", "s", a->air.units.step},
        {"steps", "", (double)lbm_steps(a->solver)},
        {"cells", "", cells},
        {"mass drift", "%", a->air.reported ? 100 * (double)a->report.drift : 0},
    };
    for (size_t i = 0; i < COUNT_OF(all) && i < capacity; i++) out[i] = all[i];
    return COUNT_OF(all);
}

// ---- in a checkpoint --------------------------------------------------------------------------

static void lbm_air_save(const pass *p, checkpoint_list *out) {
    const lbm_air *a = lbm_air_of(p);
    strbuf more = {0};
    air_describe(&a->air, &more);
    lbm_state_list(a->solver, p->label, strbuf_text(&more), out);
    air_save_templates(&a->air, out);
    strbuf_free(&more);
}

static bool lbm_air_load(pass *p, checkpoint *from) {
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

const pass_simulation lbm_simulation = {
    .left = air_left,
    .most = air_most,
    .reached = air_reached,
    .restart = air_restart,
    .save = lbm_air_save,
    .load = lbm_air_load,
    .readouts = lbm_air_readouts,
    .work = air_work,
    .trouble = lbm_air_trouble,
};
