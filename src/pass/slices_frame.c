// What the pass type `slices` does in a frame: steps, then the grid as of the frame's time.
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/slices_parts.h"

bool slices_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const slices_flow *f = slices_of(p);
    const float size[3] = {(float)f->desc.size[0], (float)f->desc.size[1], (float)f->desc.count};
    const float blend = (float)slices_blend(f, p->host->context->time);
    pass_write_member(binary, block, "size", size, sizeof size);
    pass_write_member(binary, block, "blend", &blend, sizeof blend);
    return true;
}

bool slices_rehearse(pass *p) {
    slices_flow *f = slices_of(p);
    flow_numbers numbers;
    if (!slices_numbers(p, &numbers)) return false;
    for (size_t i = 0; i < f->part_count; i++) {
        pass *part = f->parts[i];
        if (!slices_is_template(part) && !pass_rehearse(part))
            return err_prefix("%s: ", part->label);
    }
    return !f->templates || !f->templates->rehearse || f->templates->rehearse(f);
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

static void note_content(slices_flow *f) {
    f->grid.state.content++;
    for (uint32_t i = 0; i < f->desc.count; i++)
        if (f->only[i]) f->only[i]->state.content = f->grid.state.content;
}

// The images of the last two states.
static size_t looks(const slices_flow *f, pass_override out[2 * FLOW_LOOKS]) {
    static const char *const names[FLOW_LOOKS][2] = {{"scalars_now", "scalars_before"},
                                                     {"velocity_now", "velocity_before"}};
    size_t count = 0;
    for (int look = 0; look < FLOW_LOOKS; look++) {
        gpu_image *now = flow_image(f->solver, (flow_look)look, 0);
        gpu_image *before = flow_image(f->solver, (flow_look)look, 1);
        gpu_image *both[2] = {now, before ? before : now};
        for (int i = 0; i < 2; i++)
            out[count++] =
                (pass_override){names[look][i], {.image = both[i], .sampler = GPU_NEAREST_CLAMP}};
    }
    return count;
}

// The grid for the host's time, unless it is that already.
static bool show(pass *p, slices_flow *f) {
    double blend = slices_blend(f, p->host->context->time);
    uint64_t steps = flow_steps(f->solver);
    if (steps == f->shown_steps && blend == f->shown_blend && has_content(p)) return true;
    f->shown_steps = steps;
    f->shown_blend = blend;
    note_content(f);
    if (f->fresh || !flow_image(f->solver, FLOW_SCALARS, 0)) return show_nothing(p);
    pass_override overrides[2 * FLOW_LOOKS];
    size_t count = looks(f, overrides);
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc dispatch = {
        .pipeline = p->pipeline,
        .bindings = bindings,
        .threads = {f->desc.size[0], f->desc.size[1], f->desc.count + 1},
    };
    return pass_bind(p, &p->binary, p->block, overrides, count, bindings,
                     &dispatch.binding_count) &&
           gpu_dispatch(p->host->device, &dispatch);
}

bool slices_record(pass *p) {
    slices_flow *f = slices_of(p);
    f->last_steps = 0;
    if (!p->host->hold && !slices_advance(p)) return false;
    if (f->last_steps && !flow_watch(f->solver, p->host->device)) return false;
    gpu_pass_next(p->host->device, f->labels[SLICES_FIELDS]);
    return !pass_is_watched(p) || (pass_prepare(p) && show(p, f));
}
