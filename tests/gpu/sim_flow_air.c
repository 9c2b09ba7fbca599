// What air does, against what is known of it. With ROIL_LONG_TESTS=1 faster too.
#include "cavity_test.h"
#include "flow_test.h"
#include "long_test.h"

// ---- decay ------------------------------------------------------------------------------------

static const double pi = 3.14159265358979323846;
enum { VORTEX = 64 };

// Taylor and Green's vortices: they stand still and decay, whatever their speed.
static double vortex_velocity(double x, double y, int axis) {
    const double k = 2 * pi;
    return axis ? -cos(k * x) * sin(k * y) : sin(k * x) * cos(k * y);
}

typedef struct vortices { // a run of them
    flow_advection advection;
    double viscosity, dt; // m^2/s, s
    int steps;
    double wind[2]; // m/s, in which they drift
} vortices;

// The speed left after a time, of that at the start; `error`: of the shape, of the speed left.
static double vortex_left(gpu *g, const vortices *v, double *error) {
    flow_world w;
    flow_open(&w, g,
              &(flow_desc){.size = {VORTEX, VORTEX},
                           .slices = 1,
                           .faces = {FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC},
                           .advection = v->advection,
                           .solver = FLOW_MULTIGRID});
    w.numbers.viscosity = (float)v->viscosity;
    w.numbers.dt = (float)v->dt;
    flow_transfer(&w, false);
    for (int y = 0; y < VORTEX; y++)
        for (int x = 0; x < VORTEX; x++)
            for (int axis = 0; axis < 2; axis++)
                *flow_face_at(&w, x, y, 0, axis) =
                    (float)(v->wind[axis] + vortex_velocity((x + (axis ? 0.5 : 0)) / VORTEX,
                                                            (y + (axis ? 0 : 0.5)) / VORTEX, axis));
    flow_transfer(&w, true);
    flow_run_steps(&w, v->steps);
    flow_transfer(&w, false);
    const double time = v->dt * v->steps;
    double along = 0, all = 0, wanted = 0;
    for (int y = 0; y < VORTEX; y++)
        for (int x = 0; x < VORTEX; x++) {
            const double was = vortex_velocity((double)x / VORTEX - v->wind[0] * time,
                                               (y + 0.5) / VORTEX - v->wind[1] * time, 0);
            const double is = (double)*flow_face_at(&w, x, y, 0, 0) - v->wind[0];
            along += was * is, wanted += was * was, all += is * is;
        }
    *error = sqrt(fmax(0, all / (along * along / wanted) - 1));
    flow_close(&w);
    return along / wanted;
}

// Advection blurs, and splitting a step into parts takes speed too: both are there without
// viscosity as well. What of the speed left without it is left with it is the viscosity's.
static void vortices_decay_by_their_viscosity(void **state) {
    static const struct {
        const char *name;
        vortices run;
        double blur, bound; // most that is lost without viscosity; of the viscosity's part
    } rows[] = {
        {"semi-Lagrangian", {FLOW_SEMI_LAGRANGIAN, 0.005, 1.0 / 128, 64, {0}}, 0.13, 0.02},
        {"MacCormack", {FLOW_MACCORMACK, 0.005, 1.0 / 128, 64, {0}}, 0.045, 0.015},
        {"MacCormack, half a step", {FLOW_MACCORMACK, 0.005, 1.0 / 256, 128, {0}}, 0.025, 0.008},
        {"MacCormack, tough", {FLOW_MACCORMACK, 0.05, 1.0 / 128, 16, {0}}, 0.015, 0.002},
    };
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        double shape, k = 2 * pi;
        vortices run = rows[i].run;
        const double left = vortex_left(*state, &run, &shape);
        const double theory = exp(-2 * k * k * run.viscosity * run.dt * run.steps);
        run.viscosity = 0;
        double inviscid_shape, inviscid = vortex_left(*state, &run, &inviscid_shape);
        print_message("%s: without viscosity %.4f of the speed are left; of these with it %.4f "
                      "(theory %.4f), shape off by %.2e\n",
                      rows[i].name, inviscid, left / inviscid, theory, shape);
        assert_true(1 - inviscid < rows[i].blur && inviscid < 1.001);
        assert_true(fabs(left / inviscid / theory - 1) < rows[i].bound && shape < 0.02);
    }
}

// In a wind the same happens as in air that stands still.
static void vortices_do_not_know_of_the_wind(void **state) {
    vortices run = {FLOW_MACCORMACK, 0.005, 1.0 / 128, 64, {0}};
    double shape, drifting_shape;
    const double still = vortex_left(*state, &run, &shape);
    run.wind[0] = 0.7, run.wind[1] = -0.4;
    const double drifting = vortex_left(*state, &run, &drifting_shape);
    print_message("in a wind %.4f of the speed are left, without %.4f; shape off by %.2e, %.2e\n",
                  drifting, still, drifting_shape, shape);
    assert_true(fabs(drifting / still - 1) < 0.002 && drifting_shape < 0.08);
}

// ---- a cavity under a lid ---------------------------------------------------------------------

// Greatest difference to the table, of the lid's velocity.
static double cavity_error(gpu *g, int cells, double reynolds, double time, float dt) {
    flow_world w;
    flow_open(&w, g,
              &(flow_desc){.size = {(uint32_t)cells, (uint32_t)cells},
                           .slices = 1,
                           .advection = FLOW_MACCORMACK,
                           .solver = FLOW_MULTIGRID,
                           .max_iterations = 3});
    w.numbers.viscosity = (float)(1 / reynolds);
    w.numbers.wall_velocity[3][0] = 1;
    w.numbers.friction = 1;
    w.numbers.dt = dt;
    flow_run_steps(&w, (int)(time / (double)dt));
    flow_transfer(&w, false);
    double error = 0;
    for (size_t i = 0; i < COUNT_OF(ghia); i++) {
        const double y = ghia[i].height * cells - 0.5, part = y - floor(y);
        const int row = (int)floor(y);
        const double above = row + 1 < cells ? (double)*flow_face_at(&w, cells / 2, row + 1, 0, 0)
                                             : 2 - (double)*flow_face_at(&w, cells / 2, row, 0, 0);
        const double u =
            (1 - part) * (double)*flow_face_at(&w, cells / 2, row, 0, 0) + part * above;
        error = fmax(error, fabs(u - ghia_value(&ghia[i], reynolds)));
    }
    flow_close(&w);
    return error;
}

static void a_lid_drives_a_cavity(void **state) {
    double error = cavity_error(*state, 32, 100, 12, 0.02f);
    print_message("cavity of 32 cells, Re 100: within %.2f %% of the lid\n", 100 * error);
    assert_true(error < 0.02);
    if (!sim_long_tests("a finer cavity, Re 1000")) return;
    error = cavity_error(*state, 64, 100, 20, 0.01f);
    print_message("cavity of 64 cells, Re 100: within %.2f %% of the lid\n", 100 * error);
    assert_true(error < 0.01);
    error = cavity_error(*state, 128, 1000, 60, 0.0075f);
    print_message("cavity of 128 cells, Re 1000: within %.2f %% of the lid\n", 100 * error);
    assert_true(error < 0.02);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(vortices_decay_by_their_viscosity),
        cmocka_unit_test(vortices_do_not_know_of_the_wind),
        cmocka_unit_test(a_lid_drives_a_cavity),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
