// What the pass type `lbm` does in a frame: steps, then the grid as of the frame's time.
#include "base/error.h"
#include "pass/air/lbm_parts.h"

static const double air_density = 1.2; // kg/m^3

double lbm_air_pascals(const lbm_air *a) {
    double speed = a->units.cell / a->units.step;
    return air_density * speed * speed / 3;
}

bool lbm_air_update(pass *p) {
    const lbm_air *a = lbm_air_of(p);
    const float size[3] = {(float)a->desc.size[0], (float)a->desc.size[1], (float)a->desc.size[2]};
    pass_set(p, N_size, size, sizeof size);
    pass_set_float(p, N_blend, (float)lbm_air_blend(a, p->host->context->time));
    pass_set_float(p, N_speed, (float)(a->units.cell / a->units.step));
    pass_set_float(p, N_pressure, (float)lbm_air_pascals(a));
    pass_set_box(p, a->grid.box);
    return true;
}

bool lbm_air_rehearse(pass *p) {
    const lbm_air *a = lbm_air_of(p);
    lbm_numbers numbers;
    if (!lbm_air_numbers(p, &numbers)) return false;
    for (size_t i = 0; i < a->source_count; i++)
        if (!pass_rehearse(a->sources[i])) return err_prefix("%s: ", a->sources[i]->label);
    return true;
}

// The grid for the host's time, unless it is that already.
static bool show(pass *p, lbm_air *a) {
    gpu_buffer *now = lbm_moments(a->solver, 0), *before = lbm_moments(a->solver, 1);
    double blend = lbm_air_blend(a, p->host->context->time);
    uint64_t steps = lbm_steps(a->solver);
    if (steps == a->shown_steps && blend == a->shown_blend && pass_has_content(p)) return true;
    a->shown_steps = steps;
    a->shown_blend = blend;
    a->grid.state.content++;
    gpu_buffer *seen = lbm_guard_newest(a->guard);
    if (!now || !seen || a->fresh) return pass_clear_outputs(p);
    if (!pass_has_content(p) && !pass_clear_outputs(p)) return false; // it may stay as it is
    kernel *k = pass_use(p, LBM_SHOW);
    if (!k) return false;
    kernel_bind_buffer(k, N_Moments, now);
    kernel_bind_buffer(k, N_MomentsBefore, before ? before : now);
    kernel_bind_buffer(k, N_Guard, seen);
    return kernel_run(k, p->host->device, a->desc.size[0], a->desc.size[1], a->desc.size[2]);
}

bool lbm_air_record(pass *p) {
    lbm_air *a = lbm_air_of(p);
    a->last_steps = 0;
    if (!p->host->hold && !a->stopped && !lbm_air_advance(p)) return false;
    gpu_pass_next(p->host->device, a->labels[LBM_FIELDS]);
    return lbm_air_watch(p) && (!pass_is_watched(p) || (pass_prepare(p) && show(p, a)));
}
