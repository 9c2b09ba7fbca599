// Bodies for tests of lattices: cells that a function fills with ids.
#pragma once
#include "long_test.h"
#include "sim_test.h"

enum { SIM_BODIES = 70000 }; // more than 16 bits count

typedef struct sim_bodies {
    gpu_buffer *ids;
    uint32_t *cells; // what is in `ids`
    lbm_body *body;  // SIM_BODIES
} sim_bodies;

static inline void sim_bodies_open(sim_world *w, sim_bodies *b) {
    *b = (sim_bodies){.cells = mem_alloc(w->cells * sizeof *b->cells),
                      .body = mem_alloc(SIM_BODIES * sizeof *b->body)};
    b->ids = gpu_buffer_create(w->device, &(gpu_buffer_desc){.label = "ids", .size = 4 * w->cells});
    gpu_test_ok(b->ids);
}

static inline void sim_bodies_close(sim_world *w, sim_bodies *b) {
    gpu_buffer_destroy(w->device, b->ids);
    mem_free(b->cells);
    mem_free(b->body);
}

static inline void sim_centre(const sim_world *w, size_t cell, float out[3]) {
    const uint32_t *n = w->desc.size;
    out[0] = (float)(cell % n[0]) + 0.5f;
    out[1] = (float)(cell / n[0] % n[1]) + 0.5f;
    out[2] = (float)(cell / n[0] / n[1]) + 0.5f;
}

// Inside a frame. `fill`: the id of a cell whose centre is at p; NULL: as they were.
static inline void sim_bodies_set(sim_world *w, sim_bodies *b,
                                  int (*fill)(const float p[3], const void *user),
                                  const void *user) {
    for (size_t c = 0; fill && c < w->cells; c++) {
        float p[3];
        sim_centre(w, c, p);
        b->cells[c] = (uint32_t)fill(p, user);
    }
    if (fill) gpu_test_ok(gpu_buffer_write(w->device, b->ids, 0, b->cells, 4 * w->cells));
    gpu_test_ok(lbm_set_bodies(
        w->lattice, w->device, &w->numbers,
        &(lbm_bodies){
            .ids = b->ids, .changed = fill != NULL, .bodies = b->body, .count = SIM_BODIES}));
}
