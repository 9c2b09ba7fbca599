// Lattices for tests: made, set to a state by the host, stepped, and read back in full precision.
#pragma once
#include "base/maths.h"
#include "gpu_test.h"
#include "sim/lbm/lattice.glsl"
#include "sim/lbm_impl.h"
#include <math.h>
#include <string.h>

enum { SIM_MAX_Q = 27 };

typedef struct sim_set {
    int count, x[SIM_MAX_Q], y[SIM_MAX_Q], z[SIM_MAX_Q];
    double weight[SIM_MAX_Q];
} sim_set;

static inline sim_set sim_directions(int count) {
    sim_set s = {.count = count};
    static const double weights[3][4] = {
        {LBM_D3Q7_REST, LBM_D3Q7_AXIS, 0, 0},
        {LBM_D3Q19_REST, LBM_D3Q19_AXIS, LBM_D3Q19_EDGE, 0},
        {LBM_D3Q27_REST, LBM_D3Q27_AXIS, LBM_D3Q27_EDGE, LBM_D3Q27_CORNER}};
#define ADD(i, X, Y, Z)                                                                            \
    s.x[i] = X, s.y[i] = Y, s.z[i] = Z, s.x[i + 1] = -(X), s.y[i + 1] = -(Y), s.z[i + 1] = -(Z);
    LBM_D3Q27(ADD)
#undef ADD
    for (int i = 0; i < count; i++)
        s.weight[i] = weights[count == 7    ? 0
                              : count == 19 ? 1
                                            : 2][abs(s.x[i]) + abs(s.y[i]) + abs(s.z[i])];
    return s;
}

typedef struct sim_cell { // what a cell holds before collision
    double density, u[3], scalar[LBM_MAX_SCALARS];
} sim_cell;

typedef struct sim_world {
    gpu *device;
    arena memory;
    shader_library *library;
    lbm *lattice;
    lbm_desc desc;
    lbm_numbers numbers;
    size_t cells;
    sim_cell *state; // as sim_read found it
} sim_world;

static inline void sim_open(sim_world *w, gpu *device, const lbm_desc *desc) {
    char shaders[4096];
    snprintf(shaders, sizeof shaders, "%s/shaders", getenv("ROIL_SOURCE_DIR"));
    *w = (sim_world){.device = device, .desc = *desc};
    w->library = shader_library_create(&(shader_library_desc){.shader_root = shaders});
    w->lattice = lbm_create(&w->memory, desc);
    gpu_test_ok(w->lattice);
    gpu_test_ok(lbm_build(w->lattice, device, w->library, NULL));
    gpu_test_ok(lbm_allocate(w->lattice, device));
    w->numbers.tau = 0.8f;
    for (int s = 0; s < LBM_MAX_SCALARS; s++) w->numbers.scalar_tau[s] = 0.6f;
    w->cells = (size_t)desc->size[0] * desc->size[1] * desc->size[2];
    w->state = mem_alloc(w->cells * sizeof *w->state);
}

static inline void sim_close(sim_world *w) {
    lbm_destroy(w->lattice, w->device);
    shader_library_destroy(w->library);
    arena_free(&w->memory);
    mem_free(w->state);
}

static inline void sim_reset(sim_world *w) {
    gpu_test_ok(gpu_frame_begin(w->device));
    gpu_test_ok(lbm_reset(w->lattice, w->device, &w->numbers));
    gpu_test_ok(gpu_frame_end(w->device));
}

static inline void sim_run(sim_world *w, int steps) {
    while (steps > 0) {
        gpu_test_ok(gpu_frame_begin(w->device));
        for (int i = 0; i < 50 && steps > 0; i++, steps--)
            gpu_test_ok(lbm_step(w->lattice, w->device, &w->numbers, false));
        gpu_test_ok(gpu_frame_end(w->device));
    }
}

// ---- the layout, once more ----------------------------------------------------------------------

static inline size_t sim_index(const sim_world *w, int x, int y, int z) {
    const uint32_t *n = w->desc.size;
    int nx = (int)n[0], ny = (int)n[1], nz = (int)n[2];
    x = (x + nx) % nx, y = (y + ny) % ny, z = (z + nz) % nz;
    return (size_t)x + n[0] * ((size_t)y + n[1] * (size_t)z);
}

// Where a slot's value of a cell lies among all values of the state.
static inline size_t sim_place(const sim_world *w, int slot, size_t cell) {
    const lbm_layout *l = &w->lattice->layout;
    size_t plane = (size_t)w->desc.size[0] * w->desc.size[1], z = cell / plane;
    size_t layer = z % l->layers, span = l->layers / l->bundle;
    size_t element = l->bundle * (cell % plane + plane * (layer % span)) + layer / span;
    size_t run = l->run, own = (size_t)slot % run, first = (size_t)slot - own;
    size_t slots = l->slots - first < run ? l->slots - first : run;
    size_t in = l->block
                    ? element / l->block * l->block * slots + own * l->block + element % l->block
                    : own * l->places + element;
    return (first * l->places + in) * l->lanes + z / l->layers;
}

typedef struct sim_memory { // of all slots, one after the other
    unsigned char *bytes;
    size_t size;
} sim_memory;

static inline void sim_transfer(sim_world *w, sim_memory *m, bool write) {
    gpu_buffer *buffers[LBM_MAX_BUFFERS];
    size_t count = lbm_buffers(w->lattice, buffers, LBM_MAX_BUFFERS), offset = 0;
    for (size_t i = 0; i < count; i++) offset += gpu_buffer_size(buffers[i]);
    if (!m->bytes) *m = (sim_memory){mem_alloc(offset), offset};
    gpu_test_ok(gpu_idle(w->device));
    offset = 0;
    for (size_t i = 0; i < count; i++) {
        size_t size = gpu_buffer_size(buffers[i]);
        unsigned char *at = m->bytes + offset;
        gpu_test_ok(write ? gpu_buffer_write(w->device, buffers[i], 0, at, size)
                          : gpu_buffer_read(w->device, buffers[i], 0, at, size));
        offset += size;
    }
}

static inline void sim_put(const sim_world *w, sim_memory *m, int slot, size_t cell, double v,
                           double scale) {
    size_t place = sim_place(w, slot, cell);
    if (w->desc.precision == LBM_F16) {
        uint16_t half = half_from_float((float)(v * scale));
        memcpy(m->bytes + 2 * place, &half, 2);
    } else {
        float value = (float)v;
        memcpy(m->bytes + 4 * place, &value, 4);
    }
}

static inline double sim_get(const sim_world *w, const sim_memory *m, int slot, size_t cell,
                             double scale) {
    size_t place = sim_place(w, slot, cell);
    uint16_t half;
    float value;
    if (w->desc.precision == LBM_F16) {
        memcpy(&half, m->bytes + 2 * place, 2);
        return (double)half_to_float(half) / scale;
    }
    memcpy(&value, m->bytes + 4 * place, 4);
    return (double)value;
}

// The slot and the cell in which direction i of a cell arrives: its set has `first`, the slot of
// its direction 1, and `rest`.
static inline int sim_find(const sim_world *w, const sim_set *s, int first, int rest, int i, int x,
                           int y, int z, size_t *cell) {
    int odd = i % 2, parity = (int)lbm_parity(w->lattice), pair = (i - 1) / 2 * 2;
    *cell = sim_index(w, x, y, z);
    if (i == 0) return rest;
    if (odd) return first + pair + 1 - parity;
    *cell = sim_index(w, x - s->x[i], y - s->y[i], z - s->z[i]);
    return first + pair + parity;
}

typedef struct sim_part { // the air, or a scalar
    sim_set set;
    int first, rest;
    double scale;
} sim_part;

static inline sim_part sim_part_of(const sim_world *w, int scalar) { // -1: the air
    int air = w->desc.set == LBM_D3Q27 ? 27 : 19;
    int q = w->desc.scalar_set == LBM_SCALAR_D3Q27 ? 27 : 7, count = (int)w->desc.scalars;
    int rest = air - 1 + count * (q - 1);
    if (scalar < 0) return (sim_part){sim_directions(air), 0, rest, 32768};
    return (sim_part){sim_directions(q), air - 1 + scalar * (q - 1), rest + 1 + scalar, 16};
}

// ---- states -----------------------------------------------------------------------------------

static inline double sim_equilibrium(const sim_set *s, int i, double value, const double u[3]) {
    double along = s->x[i] * u[0] + s->y[i] * u[1] + s->z[i] * u[2];
    double same = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    if (s->count == 7) return s->weight[i] * value * (1 + 4 * along);
    return s->weight[i] * value * (1 + 3 * along + 4.5 * along * along - 1.5 * same);
}

// Equilibrium of what `at` says of each cell, whose cell is rest before.
static inline void sim_set_state(sim_world *w, void (*at)(int x, int y, int z, sim_cell *cell)) {
    sim_memory m = {0};
    const int *n = (const int *)w->desc.size;
    sim_reset(w);
    sim_transfer(w, &m, false);
    for (int scalar = -1; scalar < (int)w->desc.scalars; scalar++) {
        sim_part part = sim_part_of(w, scalar);
        for (size_t c = 0; c < w->cells; c++) {
            int x = (int)c % n[0], y = (int)c / n[0] % n[1], z = (int)c / n[0] / n[1];
            sim_cell cell = {.density = 1};
            at(x, y, z, &cell);
            for (int i = 0; i < part.set.count; i++) {
                size_t where;
                int slot = sim_find(w, &part.set, part.first, part.rest, i, x, y, z, &where);
                double value = scalar < 0 ? cell.density : cell.scalar[scalar];
                double f = sim_equilibrium(&part.set, i, value, cell.u);
                if (scalar < 0) f -= part.set.weight[i];
                sim_put(w, &m, slot, where, f, part.scale);
            }
        }
    }
    sim_transfer(w, &m, true);
    mem_free(m.bytes);
}

// Into w->state. Velocities are without the half of a force.
static inline void sim_read(sim_world *w) {
    sim_memory m = {0};
    const int *n = (const int *)w->desc.size;
    sim_transfer(w, &m, false);
    memset(w->state, 0, w->cells * sizeof *w->state);
    for (int scalar = -1; scalar < (int)w->desc.scalars; scalar++) {
        sim_part part = sim_part_of(w, scalar);
        for (size_t c = 0; c < w->cells; c++) {
            int x = (int)c % n[0], y = (int)c / n[0] % n[1], z = (int)c / n[0] / n[1];
            sim_cell *cell = &w->state[c];
            double sum = 0, u[3] = {0};
            for (int i = 0; i < part.set.count; i++) {
                size_t where;
                int slot = sim_find(w, &part.set, part.first, part.rest, i, x, y, z, &where);
                double f = sim_get(w, &m, slot, where, part.scale);
                sum += f;
                u[0] += part.set.x[i] * f, u[1] += part.set.y[i] * f, u[2] += part.set.z[i] * f;
            }
            if (scalar >= 0) {
                cell->scalar[scalar] = sum;
                continue;
            }
            cell->density = 1 + sum;
            for (int k = 0; k < 3; k++) cell->u[k] = u[k] / cell->density;
        }
    }
    mem_free(m.bytes);
}

// ---- a state for many tests -------------------------------------------------------------------

static const double swirl_speed = 0.05;

// Around 16 cells along each axis: a flow in all directions, sound, and a scalar.
static inline void swirl(int x, int y, int z, sim_cell *cell) {
    const double k = 2 * 3.14159265358979 / 16;
    cell->u[0] = swirl_speed * (sin(k * y) + cos(k * z));
    cell->u[1] = swirl_speed * (sin(k * z) + cos(k * x));
    cell->u[2] = swirl_speed * (sin(k * x) + cos(k * y));
    cell->density = 1 + 0.01 * sin(k * (x + 2 * y - z));
    cell->scalar[0] = 1 + sin(k * x) * cos(k * z);
}
