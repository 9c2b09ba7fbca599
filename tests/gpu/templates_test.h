// A flow with templates and nothing else, without the pass `slices`: groups by name, steps, and
// what then lies on the device.
#pragma once
#include "pass/slices/slices_parts.h"
#include "pass/slices/slices_templates.h"
#include "pass/slices/slices_templates_parts.h"
#include "pass_test.h"
#include "sim/flow.h"

enum { TEMPLATES_ROWS = 4 };

typedef struct templates_world {
    pass_world w;
    slices_flow f;
    flow_desc desc;
    flow_numbers numbers;
    pass *groups[TEMPLATE_GROUPS];
    uint32_t group_count, total;
} templates_world;

typedef struct template_seen { // one on the device
    float x, y, half_side, factor;
    float cosine, sine, alpha, tile;
    float age, lifetime, life, side;
    float turn, put_x, put_y, put;
} template_seen;

// Cells of 1 / size[0] m: a slice is 1 m wide.
static inline void templates_open(templates_world *t, gpu *device, const flow_desc *desc,
                                  double step) {
    *t = (templates_world){.desc = *desc};
    world_open(&t->w, device);
    t->f.pass = world_add(&t->w, "slices", NULL, "flow");
    t->f.pass->state = &t->f;
    t->f.desc = (pass_slices_desc){.count = desc->slices,
                                   .size = {desc->size[0], desc->size[1]},
                                   .height = (double)desc->size[1] / desc->size[0],
                                   .time_step = step};
    t->f.width = 1;
    t->f.cell = 1.0 / desc->size[0];
    t->f.clock = (pass_steps){.step = step};
    t->numbers = (flow_numbers){.dt = (float)step, .cell = (float)t->f.cell, .tolerance = 1e-3f};
}

static inline pass *templates_add(templates_world *t, const picture *image, uint32_t count) {
    char label[32];
    snprintf(label, sizeof label, "templates%u", t->group_count);
    pass *p = world_add(&t->w, "slices_templates", NULL, label);
    gpu_test_ok(pass_declare(p));
    gpu_test_ok(slices_add_templates(t->f.pass, p, image, count));
    t->groups[t->group_count++] = p;
    t->total += count;
    return p;
}

static inline void templates_set(templates_world *t, pass *p, const char *name, float value) {
    gpu_test_ok(pass_set_uniform(p, name, number(&t->w, value)));
}

// Begins anew.
static inline void templates_reset(templates_world *t) {
    gpu *device = t->w.host.device;
    t->f.templates->set.fresh = true;
    gpu_test_ok(gpu_frame_begin(device) && flow_reset(t->f.solver, device) &&
                gpu_frame_end(device));
}

static inline void templates_build(templates_world *t) {
    const pass_host *host = &t->w.host;
    t->desc.templates = slices_has_pressing(t->f.pass);
    t->desc.sources = slices_has_pushing(t->f.pass);
    t->f.solver = flow_create(host->memory, &t->desc);
    gpu_test_ok(t->f.solver && pass_build(t->f.pass) && pass_allocate(t->f.pass));
    for (uint32_t i = 0; i < t->group_count; i++) gpu_test_ok(pass_allocate(t->groups[i]));
    templates_reset(t);
}

// `flows`: the solver steps too.
static inline void templates_run(templates_world *t, int steps, bool flows) {
    gpu *device = t->w.host.device;
    while (steps > 0) {
        gpu_test_ok(gpu_frame_begin(device));
        for (int i = 0; i < 20 && steps > 0; i++, steps--) {
            gpu_test_ok(slices_templates_run(&t->f));
            if (flows)
                gpu_test_ok(flow_step(t->f.solver, device, &t->numbers, i == 19 || steps == 1));
        }
        gpu_test_ok(gpu_frame_end(device));
    }
}

// All of a slice; free with mem_free.
static inline template_seen *templates_read(templates_world *t, uint32_t slice) {
    gpu_buffer *buffer = slices_templates_buffer(t->f.pass);
    size_t size = (size_t)gpu_buffer_size(buffer);
    float *values = mem_alloc(size);
    gpu_test_ok(gpu_buffer_read(t->w.host.device, buffer, 0, values, size));
    template_seen *out = mem_alloc(t->total * sizeof *out);
    for (uint32_t i = 0; i < t->total; i++)
        for (uint32_t row = 0; row < TEMPLATES_ROWS; row++)
            memcpy((float *)&out[i] + 4 * row,
                   values + 4 * ((row * t->desc.slices + slice) * t->total + i), 16);
    mem_free(values);
    return out;
}

// Of the solver, by the slot of its shaders; free with mem_free.
static inline float *templates_read_flow(templates_world *t, const char *slot) {
    gpu_buffer *buffer = flow_find(t->f.solver, slot);
    assert_non_null(buffer);
    size_t size = (size_t)gpu_buffer_size(buffer);
    float *out = mem_alloc(size);
    gpu_test_ok(gpu_buffer_read(t->w.host.device, buffer, 0, out, size));
    return out;
}

static inline void templates_close(templates_world *t) {
    world_close(&t->w);
}

// A picture of one colour, or its alpha alone.
static inline picture templates_picture(arena *memory, const float rgba[4]) {
    enum { SIDE = 16 };
    float *texels = arena_alloc(memory, 4 * SIDE * SIDE * sizeof *texels);
    for (int i = 0; i < SIDE * SIDE; i++) memcpy(texels + 4 * i, rgba, 4 * sizeof *texels);
    return (picture){SIDE, SIDE, 0, texels};
}
