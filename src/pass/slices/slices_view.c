// What tools see of the flow in slices: the state after the last kept step, as it lies there.
#include "base/error.h"
#include "base/maths.h"
#include "base/memory.h"
#include "pass/slices/slices_parts.h"
#include <math.h>

const pass_slices_desc *pass_slices_get_desc(const pass *p) {
    return &slices_of(p)->desc;
}

const char *pass_slices_variable(const pass *p) {
    const char *label = slices_of(p)->grid.label;
    return label ? label : p->label;
}

gpu_image *pass_slices_look(const pass *p, int index, int *channel) {
    const slices_flow *f = slices_of(p);
    bool velocity = index == PASS_FLUID_VELOCITY;
    *channel = velocity ? 0 : index;
    gpu_image *image = f->fresh || !f->solver
                           ? NULL
                           : flow_image(f->solver, velocity ? FLOW_VELOCITY : FLOW_SCALARS, 0);
    if (!image) err_set("%s: nothing has flowed yet", p->label);
    return image;
}

bool pass_slices_greatest(const pass *p, int index, uint32_t slice, float *out) {
    const slices_flow *f = slices_of(p);
    int channel;
    gpu_image *image = pass_slices_look(p, index, &channel);
    if (!image) return false;
    bool velocity = index == PASS_FLUID_VELOCITY;
    size_t cells = (size_t)f->desc.size[0] * f->desc.size[1], channels = velocity ? 2 : 4;
    size_t size = cells * f->desc.count * channels * sizeof(uint16_t);
    uint16_t *halves = mem_alloc(size);
    bool done = gpu_image_read(p->host->device, image, halves, size);
    const uint16_t *at = halves + cells * slice * channels + channel;
    *out = 0;
    for (size_t i = 0; i < cells && done; i++, at += channels) {
        float value = fabsf(half_to_float(at[0]));
        if (velocity) value = hypotf(value, half_to_float(at[1]));
        *out = fmaxf(*out, value);
    }
    mem_free(halves);
    return done;
}
