// Flows in a cavity and through spheres, against what is known of them. With
// ROIL_LONG_TESTS=1 finer.
#include "cavity_test.h"
#include "sim_bodies_test.h"

// ---- a cavity under a lid ---------------------------------------------------------------------

enum { LID = 1 };

static int in_lid(const float p[3], const void *user) {
    const int cells = *(const int *)user;
    return p[2] > (float)(cells - 1) && p[0] > 1 && p[0] < (float)(cells - 1) ? LID : 0;
}

// Of the line through the middle, along x.
static double cavity_velocity(const sim_world *w, int cells, double height) {
    double z = height * (cells - 2) + 0.5, part = z - floor(z), u[2];
    for (int k = 0; k < 2; k++) {
        int row = (int)floor(z) + k;
        u[k] = 0.5 * (w->state[sim_index(w, cells / 2 - 1, 1, row)].u[0] +
                      w->state[sim_index(w, cells / 2, 1, row)].u[0]);
    }
    return (1 - part) * u[0] + part * u[1];
}

typedef struct cavity {
    int cells; // with the walls
    double reynolds, times, bound;
} cavity;

// Greatest difference to the table as a part of the lid's velocity.
static double cavity_error(gpu *g, int cells, double reynolds, double times) {
    sim_world w;
    sim_bodies b;
    const double speed = 0.1;
    sim_open(&w, g,
             &(lbm_desc){.size = {(uint32_t)cells, 4, (uint32_t)cells},
                         .collision = LBM_TRT,
                         .faces = {LBM_WALL, LBM_WALL, [4] = LBM_WALL, LBM_WALL},
                         .bodies = true});
    w.numbers.tau = (float)(0.5 + 3 * speed * (cells - 2) / reynolds);
    sim_bodies_open(&w, &b);
    b.body[LID - 1].linear[0] = (float)speed;
    sim_reset(&w);
    gpu_test_ok(gpu_frame_begin(w.device));
    sim_bodies_set(&w, &b, in_lid, &cells);
    gpu_test_ok(gpu_frame_end(w.device));
    sim_run(&w, (int)(times * (cells - 2) / speed));
    sim_read(&w);
    double error = 0;
    for (size_t i = 0; i < COUNT_OF(ghia); i++) {
        const ghia_row *row = &ghia[i];
        double wanted = ghia_value(row, reynolds);
        // What the lid pushes is not yet in what arrives at the cells below it.
        if (row->height * (cells - 2) > cells - 4) continue;
        error = fmax(error, fabs(cavity_velocity(&w, cells, row->height) / speed - wanted));
    }
    sim_bodies_close(&w, &b);
    sim_close(&w);
    return error;
}

static void hold_cavities_to_table(gpu *g, const cavity *rows, size_t count) {
    for (size_t i = 0; i < count; i++) {
        double error = cavity_error(g, rows[i].cells, rows[i].reynolds, rows[i].times);
        print_message("cavity of %d cells, Re %.0f: within %.2f %% of the lid\n", rows[i].cells - 2,
                      rows[i].reynolds, 100 * error);
        assert_true(error < rows[i].bound);
    }
}

static void a_lid_drives_a_cavity(void **state) {
    static const cavity rows[] = {{40, 100, 16, 0.012}, {40, 400, 30, 0.03}};
    static const cavity finer[] = {
        {56, 1000, 40, 0.04}, {64, 100, 20, 0.01}, {64, 400, 40, 0.015}, {96, 1000, 60, 0.02}};
    hold_cavities_to_table(*state, rows, COUNT_OF(rows));
    if (sim_long_tests("finer cavities")) hold_cavities_to_table(*state, finer, COUNT_OF(finer));
}

// ---- a lattice of spheres ---------------------------------------------------------------------

typedef struct sphere {
    double centre[3], radius;
} sphere;

static int in_sphere(const float p[3], const void *user) {
    const sphere *s = user;
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double d = (double)p[k] - s->centre[k];
        sum += d * d;
    }
    return sum < s->radius * s->radius;
}

// What the air gives to the solid in a step, along x: twice what comes back from it.
static double exchanged(sim_world *w, const sim_bodies *b) {
    sim_memory m = {0};
    const sim_part part = sim_part_of(w, -1);
    const int *n = (const int *)w->desc.size;
    double sum = 0;
    sim_transfer(w, &m, false);
    for (size_t c = 0; c < w->cells; c++) {
        int x = (int)c % n[0], y = (int)c / n[0] % n[1], z = (int)c / n[0] / n[1];
        for (int i = 1; !b->cells[c] && i < part.set.count; i++) {
            size_t where;
            const int from[3] = {x - part.set.x[i], y - part.set.y[i], z - part.set.z[i]};
            if (!b->cells[sim_index(w, from[0], from[1], from[2])]) continue;
            int slot = sim_find(w, &part.set, part.first, part.rest, i, x, y, z, &where);
            sum -= 2 * part.set.x[i] * sim_get(w, &m, slot, where, part.scale);
        }
    }
    mem_free(m.bytes);
    return sum;
}

// Creeping flow through a cubic lattice of spheres: Hasimoto, "On the periodic fundamental
// solutions of the Stokes equations and their application to viscous flow past a cubic array of
// spheres", 1959.
static void spheres_hold_the_air_back(void **state) {
    sim_world w;
    sim_bodies b;
    enum { SIDE = 24, STEPS = 2000 };
    const double force = 1e-5;
    const sphere s = {{12.1, 11.9, 12.2}, 4.6};
    sim_open(&w, *state,
             &(lbm_desc){.size = {SIDE, SIDE, SIDE}, .collision = LBM_TRT, .bodies = true});
    w.numbers.tau = 1.2f;
    w.numbers.acceleration[0] = (float)force;
    sim_bodies_open(&w, &b);
    sim_reset(&w);
    gpu_test_ok(gpu_frame_begin(w.device));
    sim_bodies_set(&w, &b, in_sphere, &s);
    gpu_test_ok(gpu_frame_end(w.device));
    sim_run(&w, STEPS);
    sim_read(&w);
    double flow = 0, air = 0, pi = acos(-1);
    for (size_t i = 0; i < w.cells; i++) {
        if (b.cells[i]) continue;
        flow += w.state[i].u[0] + force / 2;
        air++;
    }
    double solid = 1 - air / (double)w.cells, radius = cbrt(3 * solid * (double)w.cells / (4 * pi));
    double viscosity = ((double)w.numbers.tau - 0.5) / 3, mean = flow / (double)w.cells;
    double drag = force * (double)w.cells / (6 * pi * viscosity * radius * mean);
    double wanted = 1 / (1 - 1.7601 * cbrt(solid) + solid - 1.5593 * solid * solid);
    double taken = exchanged(&w, &b) / (force * air);
    print_message("spheres: drag %.4f, theory %.4f (%.2f %%); the solid takes %.5f of the force\n",
                  drag, wanted, 100 * (drag / wanted - 1), taken);
    assert_true(fabs(drag / wanted - 1) < 0.03);
    assert_true(fabs(taken - 1) < 0.005);
    sim_bodies_close(&w, &b);
    sim_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lid_drives_a_cavity),
        cmocka_unit_test(spheres_hold_the_air_back),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
