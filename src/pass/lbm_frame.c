// What the pass type `lbm` does in a frame: steps, then the grid as of the frame's time.
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/lbm_parts.h"
#include <string.h>

static const double air_density = 1.2; // kg/m^3

double lbm_air_pascals(const lbm_air *a) {
    double speed = a->units.cell / a->units.step;
    return air_density * speed * speed / 3;
}

bool lbm_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const lbm_air *a = lbm_air_of(p);
    const float size[3] = {(float)a->desc.size[0], (float)a->desc.size[1], (float)a->desc.size[2]};
    float speed = (float)(a->units.cell / a->units.step);
    float pressure = (float)lbm_air_pascals(a);
    float blend = (float)lbm_air_blend(a, p->host->context->time);
    pass_write_member(binary, block, "size", size, sizeof size);
    pass_write_member(binary, block, "blend", &blend, sizeof blend);
    pass_write_member(binary, block, "speed", &speed, sizeof speed);
    pass_write_member(binary, block, "pressure", &pressure, sizeof pressure);
    pass_write_box(binary, block, a->grid.box);
    return true;
}

bool lbm_rehearse(pass *p) {
    const lbm_air *a = lbm_air_of(p);
    lbm_numbers numbers;
    if (!lbm_air_numbers(p, &numbers)) return false;
    for (size_t i = 0; i < a->source_count; i++)
        if (!pass_rehearse(a->sources[i])) return err_prefix("%s: ", a->sources[i]->label);
    return true;
}

static bool show_nothing(pass *p) {
    static const float zero[4] = {0};
    for (size_t i = 0; i < p->face->image_count; i++) {
        gpu_image *image = graph_get_image(p->host->graph, p->images[i]);
        if (image) gpu_image_clear(p->host->device, image, zero);
    }
    return true;
}

static bool has_content(const pass *p) {
    for (size_t i = 0; i < p->face->image_count; i++) {
        graph_image image = p->images[i];
        if (graph_get_image(p->host->graph, image) && !graph_has_content(p->host->graph, image))
            return false;
    }
    return true;
}

// The grid for the host's time, unless it is that already.
static bool show(pass *p, lbm_air *a) {
    gpu_buffer *now = lbm_moments(a->solver, 0), *before = lbm_moments(a->solver, 1);
    double blend = lbm_air_blend(a, p->host->context->time);
    uint64_t steps = lbm_steps(a->solver);
    if (steps == a->shown_steps && blend == a->shown_blend && has_content(p)) return true;
    a->shown_steps = steps;
    a->shown_blend = blend;
    a->grid.state.content++;
    gpu_buffer *seen = lbm_guard_newest(a->guard);
    if (!now || !seen || a->fresh) return show_nothing(p);
    if (!has_content(p) && !show_nothing(p)) return false; // it may stay as it is
    const pass_override overrides[] = {{"Moments", {.buffer = now}},
                                       {"MomentsBefore", {.buffer = before ? before : now}},
                                       {"Guard", {.buffer = seen}}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc dispatch = {.pipeline = p->pipeline, .bindings = bindings};
    memcpy(dispatch.threads, a->desc.size, sizeof dispatch.threads);
    return pass_bind(p, &p->binary, p->block, overrides, COUNT_OF(overrides), bindings,
                     &dispatch.binding_count) &&
           gpu_dispatch(p->host->device, &dispatch);
}

bool lbm_record(pass *p) {
    lbm_air *a = lbm_air_of(p);
    a->last_steps = 0;
    if (!p->host->hold && !a->stopped && !lbm_air_advance(p)) return false;
    gpu_pass_next(p->host->device, a->labels[LBM_FIELDS]);
    return lbm_air_watch(p) && (!pass_is_watched(p) || (pass_prepare(p) && show(p, a)));
}
