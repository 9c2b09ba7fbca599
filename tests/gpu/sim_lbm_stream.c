// Smoke in air that flows past a ball that stands still.
#include "long_test.h"
#include "sim_smoke_test.h"

static const float wind = 0.05f;

static bool beside_ball(const float p[3], const void *user) {
    return !away_from_ball(p, user);
}

static void smoke_in_wind(int x, int y, int z, sim_cell *cell) {
    smoke(x, y, z, cell);
    cell->u[0] = (double)wind;
}

// A ball that stands still.
static void stand(sim_world *w, sim_bodies *b, const ball *at) {
    sim_bodies_open(w, b);
    gpu_test_ok(gpu_frame_begin(w->device));
    sim_bodies_set(w, b, in_ball, at);
    gpu_test_ok(gpu_frame_end(w->device));
}

// Smoke that is the same everywhere flows past a ball: so it stays, within `near` beside the ball.
static void flow(gpu *g, lbm_set set, lbm_precision precision, double near) {
    sim_world w;
    sim_bodies b;
    const ball at = {{14.2, 14.1, 11.7}, 5};
    sim_open(&w, g,
             &(lbm_desc){.size = {40, 28, 24},
                         .set = set,
                         .scalar_set = set == LBM_D3Q27 ? LBM_SCALAR_D3Q27 : LBM_SCALAR_D3Q7,
                         .collision = LBM_CENTRAL_MOMENTS,
                         .precision = precision,
                         .faces = {LBM_INFLOW, LBM_OPEN},
                         .scalars = 1,
                         .bodies = true});
    w.numbers.tau = 0.52f;
    w.numbers.scalar_tau[0] = 0.52f;
    w.numbers.ambient[0] = w.numbers.inflow_scalar[0][0] = 1;
    w.numbers.inflow[0][0] = w.numbers.inflow[1][0] = wind;
    sim_set_state(&w, smoke_in_wind);
    stand(&w, &b, &at);
    sim_run(&w, 1200);
    seen by = look(&w, beside_ball, &at);
    print_message("stream, %s, %d bits: smoke beside the ball %.4f to %.4f, speed %.3f\n",
                  set == LBM_D3Q27 ? "D3Q27" : "D3Q19", precision == LBM_F16 ? 16 : 32, by.least,
                  by.most, by.fastest);
    assert_true(by.least > 1 - near && by.most < 1 + near);
    assert_true(by.fastest > (double)wind);
    sim_bodies_close(&w, &b);
    sim_close(&w);
}

static void even_smoke_stays_even_beside_a_ball(void **state) {
    flow(*state, LBM_D3Q19, LBM_F16, 0.04); // halves round small changes away
    if (!sim_long_tests("a ball in single precision, and in the larger velocity set")) return;
    flow(*state, LBM_D3Q19, LBM_F32, 0.02);
    flow(*state, LBM_D3Q27, LBM_F32, 0.03);
}

static void smoke_in_half(int x, int y, int z, sim_cell *cell) {
    (void)y, (void)z;
    cell->scalar[0] = x < 8;
    cell->u[0] = (double)wind;
}

// Of all that is in the lattice: what is on its way back from solids lies in their cells.
static double sum_of_smoke(sim_world *w) {
    double sum = 0;
    sim_read(w);
    for (size_t i = 0; i < w->cells; i++) sum += w->state[i].scalar[0];
    return sum;
}

// A front of smoke goes round and round past a ball between walls.
static void a_still_ball_keeps_smoke(void **state) {
    for (int half = 0; half < 2; half++) {
        sim_world w;
        sim_bodies b;
        const ball at = {{12.2, 8.1, 5.7}, 4}; // reaches into a wall
        sim_open(&w, *state,
                 &(lbm_desc){.size = {32, 16, 16},
                             .collision = LBM_CENTRAL_MOMENTS,
                             .precision = half ? LBM_F16 : LBM_F32,
                             .faces = {[4] = LBM_WALL, LBM_WALL},
                             .scalars = 1,
                             .bodies = true});
        w.numbers.tau = 0.51f;
        w.numbers.scalar_tau[0] = 0.501f;
        w.numbers.acceleration[0] = 1e-5f;
        sim_set_state(&w, smoke_in_half);
        stand(&w, &b, &at);
        double before = sum_of_smoke(&w);
        sim_run(&w, 400);
        double change = sum_of_smoke(&w) / before - 1;
        seen all = look(&w, NULL, NULL);
        print_message("front, %d bits: %.1e of the smoke more, from %.4f to %.4f\n", half ? 16 : 32,
                      change, all.least, all.most);
        assert_true(fabs(change) < (half ? 1e-3 : 1e-6));
        assert_true(all.least >= 0 && all.most < 1.3);
        sim_bodies_close(&w, &b);
        sim_close(&w);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_smoke_stays_even_beside_a_ball),
        cmocka_unit_test(a_still_ball_keeps_smoke),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
