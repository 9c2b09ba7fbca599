// Flows for tests: made, set to a state by the host, stepped, and read back in full precision.
#pragma once
#include "gpu_test.h"
#include "sim/flow.h"
#include <math.h>
#include <string.h>

typedef struct flow_world {
    gpu *device;
    arena memory;
    shader_library *library;
    flow *flow;
    flow_desc desc;
    flow_numbers numbers;
    size_t cells, corners, row; // of all slices; of velocities
    float (*velocity)[2];       // as flow_read_state found them
    float (*scalars)[4];
    float *pressure; // times dt / cell
} flow_world;

static inline void flow_open(flow_world *w, gpu *device, const flow_desc *desc) {
    char shaders[4096];
    snprintf(shaders, sizeof shaders, "%s/shaders", getenv("ROIL_SOURCE_DIR"));
    *w = (flow_world){.device = device, .desc = *desc};
    w->library = shader_library_create(&(shader_library_desc){.shader_root = shaders});
    w->flow = flow_create(&w->memory, desc);
    gpu_test_ok(w->flow);
    gpu_test_ok(flow_build(w->flow, device, w->library, NULL));
    gpu_test_ok(flow_allocate(w->flow, device));
    w->numbers = (flow_numbers){.dt = 1.0f / 60, .cell = 1.0f / (float)desc->size[0]};
    w->cells = (size_t)desc->size[0] * desc->size[1] * desc->slices;
    w->row = (desc->size[0] + 4) / 4 * 4;
    w->corners = w->row * (desc->size[1] + 1) * desc->slices;
    w->velocity = mem_alloc(w->corners * sizeof *w->velocity);
    w->scalars = mem_alloc(w->cells * sizeof *w->scalars);
    w->pressure = mem_alloc(w->cells * sizeof *w->pressure);
    gpu_test_ok(gpu_frame_begin(device));
    gpu_test_ok(flow_reset(w->flow, device));
    gpu_test_ok(gpu_frame_end(device));
}

static inline void flow_close(flow_world *w) {
    flow_destroy(w->flow, w->device);
    shader_library_destroy(w->library);
    arena_free(&w->memory);
    mem_free(w->velocity);
    mem_free(w->scalars);
    mem_free(w->pressure);
}

static inline void flow_run_steps(flow_world *w, int steps) {
    while (steps > 0) {
        gpu_test_ok(gpu_frame_begin(w->device));
        for (int i = 0; i < 20 && steps > 0; i++, steps--)
            gpu_test_ok(flow_step(w->flow, w->device, &w->numbers, false));
        gpu_test_ok(gpu_frame_end(w->device));
    }
}

static inline void flow_transfer(flow_world *w, bool write) {
    gpu_buffer *buffers[FLOW_STATE_BUFFERS];
    void *const bytes[FLOW_STATE_BUFFERS] = {w->velocity, w->scalars, w->pressure};
    flow_buffers(w->flow, buffers);
    gpu_test_ok(gpu_idle(w->device));
    for (int i = 0; i < FLOW_STATE_BUFFERS; i++) {
        const size_t size = gpu_buffer_size(buffers[i]);
        gpu_test_ok(write ? gpu_buffer_write(w->device, buffers[i], 0, bytes[i], size)
                          : gpu_buffer_read(w->device, buffers[i], 0, bytes[i], size));
    }
}

static inline size_t flow_cell_at(const flow_world *w, int x, int y, int slice) {
    return ((size_t)slice * w->desc.size[1] + (size_t)y) * w->desc.size[0] + (size_t)x;
}

// The velocity of the left (0) or bottom (1) face of a cell; beyond the last one too.
static inline float *flow_face_at(flow_world *w, int x, int y, int slice, int axis) {
    if (w->desc.faces[0] == FLOW_PERIODIC) x %= (int)w->desc.size[0];
    if (w->desc.faces[2] == FLOW_PERIODIC) y %= (int)w->desc.size[1];
    return &w->velocity[((size_t)slice * (w->desc.size[1] + 1) + (size_t)y) * w->row + (size_t)x]
                       [axis];
}

static inline double flow_divergence(flow_world *w, int x, int y, int slice) {
    return (double)*flow_face_at(w, x + 1, y, slice, 0) - (double)*flow_face_at(w, x, y, slice, 0) +
           (double)*flow_face_at(w, x, y + 1, slice, 1) - (double)*flow_face_at(w, x, y, slice, 1);
}

// Writes one of the inputs: `size` bytes for each cell, as flow_find finds it.
static inline void flow_write_input(flow_world *w, const char *slot, const void *data,
                                    size_t size) {
    gpu_buffer *buffer = flow_find(w->flow, slot);
    assert_non_null(buffer);
    assert_int_equal(gpu_buffer_size(buffer), w->cells * size);
    gpu_test_ok(gpu_idle(w->device));
    gpu_test_ok(gpu_buffer_write(w->device, buffer, 0, data, w->cells * size));
}
