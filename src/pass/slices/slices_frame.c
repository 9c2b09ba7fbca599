// What the pass type `slices` does in a frame: steps, then the grid as of the frame's time.
#include "base/error.h"
#include "pass/slices/slices_parts.h"

bool slices_update(pass *p) {
    const slices_flow *f = slices_of(p);
    const float size[3] = {(float)f->desc.size[0], (float)f->desc.size[1], (float)f->desc.count};
    pass_set(p, N_size, size, sizeof size);
    pass_set_float(p, N_blend, (float)slices_blend(f, p->host->context->time));
    return true;
}

bool slices_rehearse(pass *p) {
    slices_flow *f = slices_of(p);
    flow_numbers numbers;
    if (!slices_numbers(p, &numbers)) return false;
    for (size_t i = 0; i < f->part_count; i++) {
        pass *part = f->parts[i];
        if (!pass_rehearse(part)) return err_prefix("%s: ", part->label);
    }
    return true;
}

static void note_content(slices_flow *f) {
    f->grid.state.content++;
    for (uint32_t i = 0; i < f->desc.count; i++)
        if (f->only[i]) f->only[i]->state.content = f->grid.state.content;
}

// The images of the last two states.
static void bind_looks(const slices_flow *f, kernel *k) {
    static const int names[FLOW_LOOKS][2] = {{N_scalars_now, N_scalars_before},
                                             {N_velocity_now, N_velocity_before}};
    for (int look = 0; look < FLOW_LOOKS; look++) {
        gpu_image *now = flow_image(f->solver, (flow_look)look, 0);
        gpu_image *before = flow_image(f->solver, (flow_look)look, 1);
        gpu_image *both[2] = {now, before ? before : now};
        for (int i = 0; i < 2; i++)
            kernel_bind(k, names[look][i],
                        (gpu_binding){.image = both[i], .sampler = GPU_NEAREST_CLAMP});
    }
}

// The grid for the host's time, unless it is that already.
static bool show(pass *p, slices_flow *f) {
    double blend = slices_blend(f, p->host->context->time);
    uint64_t steps = flow_steps(f->solver);
    if (steps == f->shown_steps && blend == f->shown_blend && pass_has_content(p)) return true;
    f->shown_steps = steps;
    f->shown_blend = blend;
    note_content(f);
    if (f->fresh || !flow_image(f->solver, FLOW_SCALARS, 0)) return pass_clear_outputs(p);
    kernel *k = pass_use(p, SLICES_SHOW);
    if (!k) return false;
    bind_looks(f, k);
    return kernel_run(k, p->host->device, f->desc.size[0], f->desc.size[1], f->desc.count + 1);
}

bool slices_record(pass *p) {
    slices_flow *f = slices_of(p);
    f->last_steps = 0;
    if (!p->host->hold && !slices_advance(p)) return false;
    if (f->last_steps && !flow_watch(f->solver, p->host->device)) return false;
    gpu_pass_next(p->host->device, f->labels[SLICES_FIELDS]);
    return !pass_is_watched(p) || (pass_prepare(p) && show(p, f));
}
