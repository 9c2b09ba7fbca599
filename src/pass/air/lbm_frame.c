// What the pass type `lbm` does in a frame: steps, then the grid as of the frame's time.
#include "pass/air/lbm_parts.h"

static const double air_density = 1.2; // kg/m^3

double lbm_air_pascals(const lbm_air *a) {
    double speed = a->air.units.cell / a->air.units.step;
    return air_density * speed * speed / 3;
}

bool lbm_air_update(pass *p) {
    const lbm_air *a = lbm_air_of(p);
    air_set_frame(p, &a->air);
    pass_set_float(p, N_speed, (float)(a->air.units.cell / a->air.units.step));
    pass_set_float(p, N_pressure, (float)lbm_air_pascals(a));
    return true;
}

bool lbm_air_rehearse(pass *p) {
    lbm_numbers numbers;
    return lbm_air_numbers(p, &numbers) && air_rehearse_sources(air_of(p));
}

// The grid for the host's time, unless it is that already.
static bool show(pass *p, lbm_air *a) {
    gpu_buffer *now = lbm_moments(a->solver, 0), *before = lbm_moments(a->solver, 1);
    if (air_is_shown(p, &a->air)) return true;
    gpu_buffer *seen = lbm_guard_newest(a->guard);
    if (!now || !seen || a->air.fresh) return pass_clear_outputs(p);
    if (!pass_has_content(p) && !pass_clear_outputs(p)) return false; // it may stay as it is
    kernel *k = pass_use(p, AIR_SHOW);
    if (!k) return false;
    const uint32_t *n = a->air.desc.size;
    kernel_bind_buffer(k, N_Moments, now);
    kernel_bind_buffer(k, N_MomentsBefore, before ? before : now);
    kernel_bind_buffer(k, N_Guard, seen);
    return kernel_run(k, p->host->device, n[0], n[1], n[2]);
}

bool lbm_air_record(pass *p) {
    lbm_air *a = lbm_air_of(p);
    a->air.last_steps = 0;
    if (!p->host->hold && !a->air.stopped && !air_advance(p)) return false;
    gpu_pass_next(p->host->device, a->air.labels[AIR_FIELDS]);
    return lbm_air_watch(p) && (!pass_is_watched(p) || (pass_prepare(p) && show(p, a)));
}
