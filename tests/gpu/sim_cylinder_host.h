// The cylinder's drag by another solver, on the host: a plane lattice of nine directions in
// doubles, two relaxation times (Ginzburg, Verhaeghe and d'Humieres 2008), half-way bounce-back at
// once, inflow by bounce-back and an outflow of constant pressure by anti-bounce-back. It has
// nothing in common with the solver of the device but the cells that are solid.
#pragma once
#include "base/memory.h"
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct host_tunnel {
    int wide, high;    // cells of air; walls that air slides along are on their outer faces
    double speed, tau; // of the inflow; of what is viscous
    double pairs;      // (tau - 1/2) times the same of the other relaxation time
    bool *solid;
    double *now, *next; // 9 populations minus their weights, each as a whole
} host_tunnel;

static const int host_x[9] = {0, 1, 0, -1, 0, 1, -1, -1, 1};
static const int host_y[9] = {0, 0, 1, 0, -1, 1, 1, -1, -1};
static const int host_back[9] = {0, 3, 4, 1, 2, 7, 8, 5, 6};
static const int host_mirrored[9] = {0, 1, 4, 3, 2, 8, 7, 6, 5};

static inline double host_weight(int i) {
    return i == 0 ? 4.0 / 9 : i < 5 ? 1.0 / 9 : 1.0 / 36;
}

static inline double host_equilibrium(int i, double excess, double u, double v) {
    const double along = host_x[i] * u + host_y[i] * v;
    return host_weight(i) * (excess + 3 * along + 4.5 * along * along - 1.5 * (u * u + v * v));
}

static inline size_t host_at(const host_tunnel *t, int i, int x, int y) {
    return ((size_t)i * (size_t)t->high + (size_t)y) * (size_t)t->wide + (size_t)x;
}

static inline void host_momentum(const host_tunnel *t, int x, int y, double out[2]) {
    out[0] = out[1] = 0;
    for (int i = 1; i < 9; i++) {
        out[0] += host_x[i] * t->now[host_at(t, i, x, y)];
        out[1] += host_y[i] * t->now[host_at(t, i, x, y)];
    }
}

static inline void host_open(host_tunnel *t) {
    const size_t cells = (size_t)t->wide * (size_t)t->high;
    t->solid = mem_alloc(cells * sizeof *t->solid);
    t->now = mem_alloc(9 * cells * sizeof *t->now);
    t->next = mem_alloc(9 * cells * sizeof *t->next);
}

static inline void host_close(host_tunnel *t) {
    mem_free(t->solid);
    mem_free(t->now);
    mem_free(t->next);
}

static inline void host_collide(host_tunnel *t, int x, int y) {
    const double even = 1 / t->tau, odd = 1 / (0.5 + t->pairs / (t->tau - 0.5));
    double f[9], excess = 0, u[2];
    for (int i = 0; i < 9; i++) excess += f[i] = t->now[host_at(t, i, x, y)];
    host_momentum(t, x, y, u);
    for (int i = 0; i < 9; i++) {
        const int j = host_back[i];
        const double off = f[i] - host_equilibrium(i, excess, u[0], u[1]);
        const double off_back = f[j] - host_equilibrium(j, excess, u[0], u[1]);
        t->now[host_at(t, i, x, y)] -= 0.5 * even * (off + off_back) + 0.5 * odd * (off - off_back);
    }
}

// What arrives at a cell; adds what a solid is given.
static inline void host_stream(host_tunnel *t, int x, int y, double given[2]) {
    double edge[2] = {0}, inner[2] = {0}; // at the outflow
    if (x == t->wide - 1) host_momentum(t, x, y, edge), host_momentum(t, x - 1, y, inner);
    for (int i = 0; i < 9; i++) {
        const int a = x - host_x[i], b = y - host_y[i], j = host_back[i];
        const double back = t->now[host_at(t, j, x, y)];
        double f;
        if (a < 0) {
            f = back + 6 * host_weight(i) * host_x[i] * t->speed;
        } else if (a >= t->wide) {
            const double u = 1.5 * edge[0] - 0.5 * inner[0], v = 1.5 * edge[1] - 0.5 * inner[1];
            const double along = host_x[i] * u + host_y[i] * v;
            f = 2 * host_weight(i) * (4.5 * along * along - 1.5 * (u * u + v * v)) - back;
        } else if (b < 0 || b >= t->high) {
            f = t->now[host_at(t, host_mirrored[i], a, y)];
        } else if (t->solid[(size_t)b * (size_t)t->wide + (size_t)a]) {
            f = back;
            given[0] -= 2 * host_x[i] * back, given[1] -= 2 * host_y[i] * back;
        } else {
            f = t->now[host_at(t, i, a, b)];
        }
        t->next[host_at(t, i, x, y)] = f;
    }
}

// A step. `given`: along and across the tunnel, the momentum that the solid gets in it.
static inline void host_step(host_tunnel *t, double given[2]) {
    given[0] = given[1] = 0;
    for (int y = 0; y < t->high; y++)
        for (int x = 0; x < t->wide; x++)
            if (!t->solid[(size_t)y * (size_t)t->wide + (size_t)x]) host_collide(t, x, y);
    for (int y = 0; y < t->high; y++)
        for (int x = 0; x < t->wide; x++)
            if (!t->solid[(size_t)y * (size_t)t->wide + (size_t)x]) host_stream(t, x, y, given);
    double *swapped = t->now;
    t->now = t->next, t->next = swapped;
}
