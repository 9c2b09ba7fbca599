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

// The speed left after a time, of that at the start; `error`: of the shape, of the speed left.
static double vortex_left(gpu *g, flow_advection advection, float viscosity, float dt, int steps,
                          double *error) {
    flow_world w;
    flow_open(&w, g,
              &(flow_desc){.size = {VORTEX, VORTEX},
                           .slices = 1,
                           .faces = {FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC},
                           .advection = advection,
                           .solver = FLOW_MULTIGRID});
    w.numbers.viscosity = viscosity;
    w.numbers.dt = dt;
    flow_transfer(&w, false);
    for (int y = 0; y < VORTEX; y++)
        for (int x = 0; x < VORTEX; x++)
            for (int axis = 0; axis < 2; axis++)
                *flow_face_at(&w, x, y, 0, axis) = (float)vortex_velocity(
                    (x + (axis ? 0.5 : 0)) / VORTEX, (y + (axis ? 0 : 0.5)) / VORTEX, axis);
    flow_transfer(&w, true);
    flow_run_steps(&w, steps);
    flow_transfer(&w, false);
    double along = 0, all = 0, wanted = 0;
    for (int y = 0; y < VORTEX; y++)
        for (int x = 0; x < VORTEX; x++) {
            const double was = vortex_velocity((double)x / VORTEX, (y + 0.5) / VORTEX, 0);
            const double is = (double)*flow_face_at(&w, x, y, 0, 0);
            along += was * is, wanted += was * was, all += is * is;
        }
    *error = sqrt(fmax(0, all / (along * along / wanted) - 1));
    flow_close(&w);
    return along / wanted;
}

static void vortices_decay_by_their_viscosity(void **state) {
    static const struct {
        const char *name;
        flow_advection advection;
        float viscosity, dt;
        int steps;
        double bound;
    } rows[] = {
        {"semi-Lagrangian", FLOW_SEMI_LAGRANGIAN, 0.005f, 1.0f / 128, 64, 0.15},
        {"MacCormack", FLOW_MACCORMACK, 0.005f, 1.0f / 128, 64, 0.04},
        {"MacCormack, in stages", FLOW_MACCORMACK, 0.05f, 1.0f / 128, 16, 0.02},
    };
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        double shape, k = 2 * pi;
        const double time = (double)rows[i].dt * rows[i].steps;
        const double left = vortex_left(*state, rows[i].advection, rows[i].viscosity, rows[i].dt,
                                        rows[i].steps, &shape);
        const double wanted = exp(-2 * k * k * (double)rows[i].viscosity * time);
        print_message("%s: %.4f of the speed are left (theory %.4f), shape off by %.2e\n",
                      rows[i].name, left, wanted, shape);
        assert_true(fabs(left / wanted - 1) < rows[i].bound && shape < 0.02);
    }
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
        cmocka_unit_test(a_lid_drives_a_cavity),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
