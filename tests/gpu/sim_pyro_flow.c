// How burning gas flows, without any fire: a vortex ring against Kelvin's speed, and how much
// energy each way of carrying keeps.
#include "long_test.h"
#include "pyro_test.h"

static const double pi = 3.14159265358979;

// ---- a vortex ring ----------------------------------------------------------------------------

enum { SIDE = 48, LONG = 72 };
static const double ring_radius = 11, core = 2.5; // cells

// The vector potential of a thin core is along the ring. Velocities are its curl, by differences of
// its values on edges, so that they have no divergence: A is found by adding up parts of the ring.
typedef struct ring {
    double z;                      // cells
    double (*potential)[SIDE + 1]; // around the axis: [height][distance], by half cells
} ring;

// Around the axis, of a ring of circulation 1 and radius R at height 0: Gaussian cores as the sum
// of threads that are softened by the core.
static double potential_of(double r, double z) {
    enum { PARTS = 128 };
    double sum = 0;
    for (int i = 0; i < PARTS; i++) {
        const double a = 2 * pi * (i + 0.5) / PARTS;
        const double d2 = r * r + ring_radius * ring_radius - 2 * r * ring_radius * cos(a) + z * z;
        // Rosenhead and Moore: the core is spread over `core`.
        sum += cos(a) * ring_radius / sqrt(d2 + core * core);
    }
    return sum * 2 * pi / PARTS / (4 * pi);
}

// A at the middle of an edge along x (0) or y (1).
static double edge(const ring *g, const double p[3], int axis) {
    const double x = p[0] - SIDE / 2.0, y = p[1] - SIDE / 2.0, r = sqrt(x * x + y * y);
    if (r < 1e-9) return 0;
    const double a = potential_of(r, p[2] - g->z);
    return axis == 0 ? -y / r * a : x / r * a;
}

// By Stokes: what goes around a face is what flows through it. All for a circulation of 1.
static void stir_ring(pyro_world *w, const int c[3], void *data) {
    const ring *g = data;
    const double x = c[0], y = c[1], z = c[2];
    float *v[3];
    for (int i = 0; i < 3; i++) v[i] = pyro_face_at(w, i, c);
    *v[0] = (float)(edge(g, (double[3]){x, y + 0.5, z}, 1) -
                    edge(g, (double[3]){x, y + 0.5, z + 1}, 1));
    *v[1] = (float)(edge(g, (double[3]){x + 0.5, y, z + 1}, 0) -
                    edge(g, (double[3]){x + 0.5, y, z}, 0));
    *v[2] = (float)(edge(g, (double[3]){x + 1, y + 0.5, z}, 1) -
                    edge(g, (double[3]){x, y + 0.5, z}, 1) -
                    edge(g, (double[3]){x + 0.5, y + 1, z}, 0) +
                    edge(g, (double[3]){x + 0.5, y, z}, 0));
}

typedef struct seen {
    double sum, at;
} seen;

// Where vorticity is, by its square.
static void look(pyro_world *w, const int c[3], void *data) {
    seen *s = data;
    for (int i = 0; i < 3; i++)
        if (c[i] < 2 || c[i] > (int)w->desc.size[i] - 3) return;
    double q = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        int back_j[3] = {c[0], c[1], c[2]}, back_k[3] = {c[0], c[1], c[2]};
        back_j[j]--, back_k[k]--;
        const double curl = (double)(*pyro_face_at(w, k, c) - *pyro_face_at(w, k, back_j) -
                                     *pyro_face_at(w, j, c) + *pyro_face_at(w, j, back_k));
        q += curl * curl;
    }
    s->sum += q;
    s->at += q * (c[2] + 0.5);
}

static double height(pyro_world *w) {
    seen s = {0, 0};
    pyro_transfer(w, false);
    pyro_for_each(w, look, &s);
    return s.at / s.sum;
}

// Cells of a step that moves gas in the core by about half a cell.
static double speed_of_ring(gpu *g, pyro_advection advection) {
    pyro_world w;
    enum { SETTLE = 10, STEPS = 40 };
    pyro_open(&w, g, &(pyro_desc){.size = {SIDE, SIDE, LONG}, .advection = advection});
    w.numbers.gravity = 0;
    w.numbers.cell = 1;
    w.numbers.dt = 10;
    ring r = {.z = 26};
    pyro_for_each(&w, stir_ring, &r);
    pyro_transfer(&w, true);
    pyro_run_steps(&w, SETTLE);
    const double before = height(&w);
    pyro_run_steps(&w, STEPS);
    const double speed = (height(&w) - before) / (STEPS * 10.0);
    pyro_close(&w);
    return speed;
}

// U = G / (4 pi R) (ln(8 R / a) - 1), a being what softens the threads: each is a vortex of
// velocity G r / (2 pi (r^2 + a^2)), for which Saffman's constant (Vortex Dynamics, section 10.2)
// is -1 / 2.
static void a_ring_moves_by_its_circulation(void **state) {
    const double wanted = 1 / (4 * pi * ring_radius) * (log(8 * ring_radius / core) - 1);
    const double seen_ = speed_of_ring(*state, PYRO_PARABOLIC);
    print_message("a ring moves at %.6f, theory %.6f: %+.1f %%\n", seen_, wanted,
                  100 * (seen_ / wanted - 1));
    assert_true(fabs(seen_ / wanted - 1) < 0.03);
}

// ---- energy -----------------------------------------------------------------------------------

static void swirl(pyro_world *w, const int c[3], void *data) {
    (void)data;
    const double k = 2 * pi / 32;
    *pyro_face_at(w, 0, c) = (float)(sin(k * c[0]) * cos(k * (c[1] + 0.5)) * cos(k * (c[2] + 0.5)));
    *pyro_face_at(w, 1, c) =
        (float)(-cos(k * (c[0] + 0.5)) * sin(k * c[1]) * cos(k * (c[2] + 0.5)));
}

static double energy(pyro_world *w) {
    double sum = 0;
    pyro_transfer(w, false);
    for (size_t i = 0; i < w->cells; i++)
        for (int k = 0; k < 3; k++) sum += (double)w->velocity[i][k] * (double)w->velocity[i][k];
    return sum;
}

// A Taylor-Green vortex of 32 cells, without viscosity, until its parts have turned once: what is
// lost is the scheme's.
static double kept(gpu *g, pyro_advection advection) {
    pyro_world w;
    pyro_open(
        &w, g,
        &(pyro_desc){.size = {32, 32, 32}, .faces = {3, 3, 3, 3, 3, 3}, .advection = advection});
    w.numbers.gravity = 0;
    w.numbers.cell = 1;
    w.numbers.dt = 0.5f;
    pyro_for_each(&w, swirl, NULL);
    pyro_transfer(&w, true);
    const double before = energy(&w);
    pyro_run_steps(&w, 30); // 3 of the times by which dissipation is told; it begins at 4
    const double share = energy(&w) / before;
    pyro_close(&w);
    return share;
}

static void parabolas_keep_more_energy(void **state) {
    const double even = kept(*state, PYRO_UPWIND), bent = kept(*state, PYRO_PARABOLIC);
    const double reflected = kept(*state, PYRO_REFLECTION);
    print_message("energy kept: upwind %.3f, by parabolas %.3f, with reflection %.4f\n", even, bent,
                  reflected);
    assert_true(bent > 0.9 && bent < 1.001 && even < 0.75);
    assert_true(reflected > 0.985 && reflected < 1.001);
}

// ---- momentum ---------------------------------------------------------------------------------

// A jet along x in still air, and a swirl that is not symmetrical to it.
static void stir_jet(pyro_world *w, const int c[3], void *data) {
    const double k = 2 * pi / 32, r2 = pow(c[1] - 13.0, 2) + pow(c[2] - 17.0, 2);
    (void)data;
    swirl(w, c, NULL);
    *pyro_face_at(w, 0, c) += (float)(2 * exp(-r2 / 18));
    *pyro_face_at(w, 2, c) += (float)(0.5 * sin(k * (c[0] + 0.5)) + 0.2);
}

static void sum_velocities(pyro_world *w, double out[3]) {
    memset(out, 0, 3 * sizeof *out);
    pyro_transfer(w, false);
    for (size_t i = 0; i < w->cells; i++)
        for (int k = 0; k < 3; k++) out[k] += (double)w->velocity[i][k] / (double)w->cells;
}

static void check_momentum(gpu *g, pyro_advection advection) {
    pyro_world w;
    pyro_open(&w, g,
              &(pyro_desc){.size = {32, 32, 32},
                           .faces = {3, 3, 3, 3, 3, 3},
                           .advection = advection,
                           .cycles = 6});
    w.numbers.gravity = 0;
    w.numbers.cell = 1;
    w.numbers.dt = 0.5f;
    double before[3], after[3];
    pyro_for_each(&w, stir_jet, NULL);
    pyro_transfer(&w, true);
    sum_velocities(&w, before);
    pyro_run_steps(&w, 30);
    sum_velocities(&w, after);
    for (int k = 0; k < 3; k++) {
        print_message("momentum along %c: %.5f, then %.5f m/s\n", "xyz"[k], before[k], after[k]);
        assert_true(fabs(after[k] - before[k]) < 2e-4);
    }
    pyro_close(&w);
}

static void momentum_stays(void **state) {
    check_momentum(*state, PYRO_PARABOLIC);
    if (sim_long_tests("momentum with reflection")) check_momentum(*state, PYRO_REFLECTION);
}

// ---- turbulence below the cells ---------------------------------------------------------------

static void shear(pyro_world *w, const int c[3], void *data) {
    *pyro_face_at(w, 0, c) = (float)(*(const double *)data * sin(2 * pi / 32 * (c[1] + 0.5)));
}

// What one step adds to gas that goes along x, so fast, by where it is along y: the velocity's.
static void open_sheared(pyro_world *w, gpu *g, double speed, float turbulence,
                         pyro_advection advection) {
    pyro_open(w, g,
              &(pyro_desc){.size = {32, 32, 32},
                           .faces = {3, 3, 3, 3, 3, 3},
                           .advection = advection,
                           .cycles = 6,
                           .turbulence = true});
    w->numbers.gravity = 0;
    w->numbers.cell = 0.1f;
    w->numbers.dt = 0.05f;
    w->numbers.turbulence = turbulence;
    pyro_for_each(w, shear, &speed);
    pyro_transfer(w, true);
    pyro_run_steps(w, 1);
}

// The mean square of each component is that of h |S| sqrt(|S| dt), of which h |S| is the difference
// of velocities across a cell: as the cosine's cube 4 / (3 pi) of its greatest.
static void check_turbulence(gpu *g, pyro_advection advection) {
    const double speed = 1, amount = 0.3;
    pyro_world still, pushed;
    open_sheared(&still, g, speed, 0, advection);
    open_sheared(&pushed, g, speed, (float)amount, advection);
    pyro_transfer(&still, false);
    pyro_transfer(&pushed, false);
    const double across = speed * sin(4 * pi / 32) / 2, reach = 0.05 / 0.1;
    const double wanted = amount * amount * pow(across, 3) * reach * 4 / (3 * pi);
    for (int k = 0; k < 3; k++) {
        double sum = 0;
        for (size_t i = 0; i < still.cells; i++)
            sum += pow((double)(pushed.velocity[i][k] - still.velocity[i][k]), 2);
        const double seen_ = sum / (double)still.cells;
        print_message("turbulence along %c: %.4g m/s, theory %.4g\n", "xyz"[k], sqrt(seen_),
                      sqrt(wanted));
        assert_true(fabs(sqrt(seen_ / wanted) - 1) < 0.06);
    }
    const pyro_report r = pyro_look_at(&pushed);
    print_message("divergence %.2g m/s\n", (double)r.residual);
    assert_true((double)r.residual < 2e-8);
    pyro_close(&still);
    pyro_close(&pushed);
}

static void turbulence_is_by_shear(void **state) {
    check_turbulence(*state, PYRO_PARABOLIC);
    if (sim_long_tests("turbulence with reflection")) check_turbulence(*state, PYRO_REFLECTION);
}

// Energy that a swirl has after a while, when turbulence is as rough as it may be.
static double stirred(gpu *g, pyro_advection advection, float turbulence) {
    pyro_world w;
    pyro_open(&w, g,
              &(pyro_desc){.size = {32, 32, 32},
                           .faces = {3, 3, 3, 3, 3, 3},
                           .advection = advection,
                           .turbulence = true});
    w.numbers.gravity = 0;
    w.numbers.cell = 1;
    w.numbers.dt = 0.5f;
    w.numbers.turbulence = turbulence;
    pyro_for_each(&w, swirl, NULL);
    pyro_transfer(&w, true);
    const double before = energy(&w);
    pyro_run_steps(&w, 100);
    const double after = energy(&w) / before;
    pyro_close(&w);
    return after;
}

static void check_stirred(gpu *g, pyro_advection advection) {
    const double left = stirred(g, advection, 1);
    print_message("%s: with turbulence of 1 %.3f of the energy is left\n",
                  pyro_advection_names[advection], left);
    assert_true(left < 1);
}

static void turbulence_does_not_feed_itself(void **state) {
    check_stirred(*state, PYRO_PARABOLIC);
    if (sim_long_tests("stirring with reflection")) check_stirred(*state, PYRO_REFLECTION);
}

static void even_flow_has_none(void **state) {
    pyro_world w;
    open_sheared(&w, *state, 0, 1, PYRO_PARABOLIC);
    pyro_transfer(&w, false);
    for (size_t i = 0; i < w.cells; i++)
        for (int k = 0; k < 3; k++) assert_true(w.velocity[i][k] == 0);
    pyro_close(&w);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ring_moves_by_its_circulation),
        cmocka_unit_test(parabolas_keep_more_energy),
        cmocka_unit_test(momentum_stays),
        cmocka_unit_test(turbulence_is_by_shear),
        cmocka_unit_test(even_flow_has_none),
        cmocka_unit_test(turbulence_does_not_feed_itself),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
