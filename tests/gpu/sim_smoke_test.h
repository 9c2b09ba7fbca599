// Smoke around balls, for tests: where it is, and how much of it.
#pragma once
#include "sim_bodies_test.h"

typedef struct seen { // over cells of air
    double least, most, smoke, mass, fastest;
    size_t count;
} seen;

// A step that keeps the moments, and what these come to where `wanted` says so. Smoke is a part of
// the air, which is pressed together before a body.
static inline seen look(sim_world *w, bool (*wanted)(const float p[3], const void *user),
                        const void *user) {
    gpu_test_ok(gpu_frame_begin(w->device));
    gpu_test_ok(lbm_step(w->lattice, w->device, &w->numbers, true));
    gpu_test_ok(gpu_frame_end(w->device));
    uint16_t(*moments)[8] = mem_alloc(w->cells * sizeof *moments);
    gpu_test_ok(gpu_buffer_read(w->device, lbm_moments(w->lattice, 0), 0, moments,
                                w->cells * sizeof *moments));
    seen s = {.least = 1e9, .most = -1e9};
    for (size_t i = 0; i < w->cells; i++) {
        float p[3], v[8];
        sim_centre(w, i, p);
        for (int k = 0; k < 8; k++) v[k] = half_to_float(moments[i][k]);
        if (v[7] != 0 || (wanted && !wanted(p, user))) continue;
        double smoke = (double)v[4] / (1 + (double)v[3]);
        s.least = fmin(s.least, smoke);
        s.most = fmax(s.most, smoke);
        s.smoke += (double)v[4];
        s.mass += 1 + (double)v[3];
        s.fastest = fmax(s.fastest, (double)fmaxf(fabsf(v[0]), fmaxf(fabsf(v[1]), fabsf(v[2]))));
        s.count++;
    }
    mem_free(moments);
    return s;
}

typedef struct ball {
    double centre[3], radius;
} ball;

static inline int in_ball(const float p[3], const void *user) {
    const ball *b = user;
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += ((double)p[k] - b->centre[k]) * ((double)p[k] - b->centre[k]);
    return sum < b->radius * b->radius;
}

static inline bool away_from_ball(const float p[3], const void *user) {
    ball wide = *(const ball *)user;
    wide.radius += 2;
    return !in_ball(p, &wide);
}

static inline void smoke(int x, int y, int z, sim_cell *cell) {
    (void)x, (void)y, (void)z;
    cell->scalar[0] = 1;
}
