// Burning gas for tests: made, set to a state by the host, stepped, and read back, in full
// precision unless its description says otherwise.
#pragma once
#include "base/maths.h"
#include "gpu_test.h"
#include "sim/pyro.h"
#include <math.h>
#include <string.h>

typedef struct pyro_world {
    gpu *device;
    arena memory;
    shader_library *library;
    pyro *solver;
    pyro_desc desc;
    pyro_numbers numbers;
    size_t cells;
    float (*velocity)[4]; // of the faces at the lower ends of each cell
    float (*gas)[4];      // warmth, fuel, burnt, soot
    float *pressure;      // m/s
    float *smoke;         // kg by those of the air of the surroundings, with desc.smoke
} pyro_world;

static inline void pyro_open(pyro_world *w, gpu *device, const pyro_desc *desc) {
    char shaders[4096];
    snprintf(shaders, sizeof shaders, "%s/shaders", getenv("ROIL_SOURCE_DIR"));
    *w = (pyro_world){.device = device, .desc = *desc};
    w->library = shader_library_create(&(shader_library_desc){.shader_root = shaders});
    w->solver = pyro_create(&w->memory, &w->desc);
    gpu_test_ok(w->solver);
    gpu_test_ok(pyro_build(w->solver, device, w->library, NULL));
    gpu_test_ok(pyro_allocate(w->solver, device));
    w->numbers = (pyro_numbers){.dt = 1.0f / 60,
                                .cell = 0.05f,
                                .ambient = 300,
                                .ignition = 600,
                                .heat = 3e7f,
                                .oxygen = 3.5f,
                                .molar_mass = 29,
                                .expansion = 1};
    w->cells = (size_t)desc->size[0] * desc->size[1] * desc->size[2];
    w->velocity = mem_alloc(w->cells * sizeof *w->velocity);
    w->gas = mem_alloc(w->cells * sizeof *w->gas);
    w->pressure = mem_alloc(w->cells * sizeof *w->pressure);
    w->smoke = mem_alloc(w->cells * sizeof *w->smoke);
    memset(w->smoke, 0, w->cells * sizeof *w->smoke);
    memset(w->velocity, 0, w->cells * sizeof *w->velocity);
    memset(w->gas, 0, w->cells * sizeof *w->gas);
    memset(w->pressure, 0, w->cells * sizeof *w->pressure);
    gpu_test_ok(gpu_frame_begin(device));
    gpu_test_ok(pyro_reset(w->solver, device, &w->numbers));
    gpu_test_ok(gpu_frame_end(device));
}

static inline void pyro_close(pyro_world *w) {
    pyro_destroy(w->solver, w->device);
    shader_library_destroy(w->library);
    arena_free(&w->memory);
    mem_free(w->velocity);
    mem_free(w->gas);
    mem_free(w->pressure);
    mem_free(w->smoke);
}

static inline void pyro_run_steps(pyro_world *w, int steps) {
    while (steps > 0) {
        gpu_test_ok(gpu_frame_begin(w->device));
        for (int i = 0; i < 10 && steps > 0; i++, steps--)
            gpu_test_ok(pyro_step(w->solver, w->device, &w->numbers, false));
        gpu_test_ok(gpu_frame_end(w->device));
    }
}

static inline pyro_report pyro_look_at(pyro_world *w) {
    pyro_report report = {0};
    gpu_test_ok(gpu_frame_begin(w->device));
    gpu_test_ok(pyro_watch(w->solver, w->device, &w->numbers));
    gpu_test_ok(gpu_frame_end(w->device));
    gpu_test_ok(gpu_idle(w->device));
    assert_true(pyro_read(w->solver, w->device, &report));
    assert_int_equal(report.step, pyro_steps(w->solver));
    return report;
}

// As shaders/sim/pyro/state.glsl packs it, and back.
static inline void pyro_pack_gas(pyro_world *w, bool pack) {
    const float ambient = w->numbers.ambient;
    for (size_t i = 0; i < w->cells; i++) {
        float *g = w->gas[i], air = pack ? ambient / (ambient + g[0]) : 1 - g[0];
        g[0] = pack ? 1 - air : ambient / air - ambient;
        for (int k = 1; k < 4; k++) g[k] = pack ? air * g[k] : g[k] / air;
    }
}

// Of the state's buffers, velocity and gas are halves where it is stored so.
static inline void pyro_transfer_halves(pyro_world *w, gpu_buffer *buffer, float *values,
                                        bool write) {
    const size_t count = gpu_buffer_size(buffer) / sizeof(uint16_t);
    uint16_t *halves = mem_alloc(count * sizeof *halves);
    for (size_t i = 0; write && i < count; i++) halves[i] = half_from_float(values[i]);
    gpu_test_ok(write ? gpu_buffer_write(w->device, buffer, 0, halves, count * sizeof *halves)
                      : gpu_buffer_read(w->device, buffer, 0, halves, count * sizeof *halves));
    for (size_t i = 0; !write && i < count; i++) values[i] = half_to_float(halves[i]);
    mem_free(halves);
}

static inline void pyro_transfer(pyro_world *w, bool write) {
    gpu_buffer *buffers[PYRO_STATE_BUFFERS];
    void *const bytes[PYRO_STATE_BUFFERS] = {w->velocity, w->gas, w->pressure, w->smoke};
    const size_t count = pyro_buffers(w->solver, buffers);
    gpu_test_ok(gpu_idle(w->device));
    if (write) pyro_pack_gas(w, true);
    for (size_t i = 0; i < count; i++) {
        const size_t size = gpu_buffer_size(buffers[i]);
        if (w->desc.precision == PYRO_F16 && i < 2) {
            pyro_transfer_halves(w, buffers[i], bytes[i], write);
            continue;
        }
        gpu_test_ok(write ? gpu_buffer_write(w->device, buffers[i], 0, bytes[i], size)
                          : gpu_buffer_read(w->device, buffers[i], 0, bytes[i], size));
    }
    pyro_pack_gas(w, false);
}

static inline size_t pyro_place(const uint32_t size[3], const int c[3]) {
    const size_t bricks[3] = {size[0] / 8, size[1] / 8, size[2] / 8};
    const size_t b[3] = {(size_t)c[0] / 8, (size_t)c[1] / 8, (size_t)c[2] / 8};
    const size_t brick = b[0] + bricks[0] * (b[1] + bricks[1] * b[2]);
    return 512 * brick + (size_t)(c[0] % 8 + 8 * (c[1] % 8) + 64 * (c[2] % 8));
}

// Where a cell of the gas lies in memory.
static inline size_t pyro_cell_at(const pyro_world *w, const int c[3]) {
    return pyro_place(w->desc.size, c);
}

// Cells of the velocity along an axis.
static inline int pyro_flow_cells_along(const pyro_world *w, int axis) {
    return (int)(w->desc.size[axis] / pyro_ratio(&w->desc));
}

// Component `axis` of the face at the lower end of a cell of the velocity.
static inline float *pyro_face_at(pyro_world *w, int axis, const int c[3]) {
    const uint32_t n[3] = {(uint32_t)pyro_flow_cells_along(w, 0),
                           (uint32_t)pyro_flow_cells_along(w, 1),
                           (uint32_t)pyro_flow_cells_along(w, 2)};
    return &w->velocity[pyro_place(n, c)][axis];
}

// Calls `each` for all cells.
typedef void pyro_visit(pyro_world *w, const int c[3], void *data);
static inline void pyro_for_each(pyro_world *w, pyro_visit *each, void *data) {
    int c[3];
    for (c[2] = 0; c[2] < (int)w->desc.size[2]; c[2]++)
        for (c[1] = 0; c[1] < (int)w->desc.size[1]; c[1]++)
            for (c[0] = 0; c[0] < (int)w->desc.size[0]; c[0]++) each(w, c, data);
}

// ---- sums over all cells --------------------------------------------------------------------

typedef struct pyro_sums {
    double fuel, burnt, soot, heat; // by the mass of the air around: heat in K
    double hottest;
} pyro_sums;

// By mass: a cell that is warm has less.
static inline void pyro_add(pyro_world *w, const int c[3], void *data) {
    pyro_sums *s = data;
    const float *g = w->gas[pyro_cell_at(w, c)];
    const double ambient = (double)w->numbers.ambient, t = ambient + (double)g[0],
                 mass = ambient / t;
    s->fuel += mass * (double)g[1];
    s->burnt += mass * (double)g[2];
    s->soot += mass * (double)g[3];
    s->heat += mass * (double)g[0];
    s->hottest = fmax(s->hottest, t);
}

static inline pyro_sums pyro_sum_up(pyro_world *w) {
    pyro_sums s = {0};
    pyro_transfer(w, false);
    pyro_for_each(w, pyro_add, &s);
    return s;
}
