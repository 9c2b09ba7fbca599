// Bodies that move through still smoke: what they push, cover and leave.
#include "long_test.h"
#include "sim_smoke_test.h"

static void step_with(sim_world *w, sim_bodies *b, int (*fill)(const float p[3], const void *user),
                      const void *user) {
    gpu_test_ok(gpu_frame_begin(w->device));
    sim_bodies_set(w, b, fill, user);
    gpu_test_ok(lbm_step(w->lattice, w->device, &w->numbers, false));
    gpu_test_ok(gpu_frame_end(w->device));
}

// ---- a ball -----------------------------------------------------------------------------------

static int in_last_ball(const float p[3], const void *user) {
    return in_ball(p, user) ? SIM_BODIES : 0;
}

// A ball speeds up and flies through smoke that is the same everywhere: so it stays, within `near`
// beside the ball and `far` from it.
static void fly(gpu *g, const lbm_desc *desc, double near, double far) {
    sim_world w;
    sim_bodies b;
    const double speed = 0.05;
    sim_open(&w, g, desc);
    w.numbers.tau = 0.52f;
    w.numbers.scalar_tau[0] = 0.52f;
    sim_bodies_open(&w, &b);
    sim_set_state(&w, smoke);
    ball at = {{8.2, 8.1, 7.7}, 3.7};
    for (int i = 0; at.centre[0] < 17; i++) {
        double now = speed * fmin(1, i / 200.0);
        lbm_body *body = &b.body[SIM_BODIES - 1];
        body->linear[0] = (float)now;
        for (int k = 0; k < 3; k++) body->centre[k] = (float)at.centre[k];
        step_with(&w, &b, in_last_ball, &at);
        at.centre[0] += now;
    }
    seen all = look(&w, NULL, NULL), away = look(&w, away_from_ball, &at);
    print_message("ball: smoke %.4f to %.4f, away %.4f to %.4f; mean density %.5f, speed %.3f\n",
                  all.least, all.most, away.least, away.most, all.mass / (double)all.count,
                  all.fastest);
    assert_true(all.least > 1 - near && all.most < 1 + near);
    assert_true(away.least > 1 - far && away.most < 1 + far);
    assert_true(fabs(all.mass / (double)all.count - 1) < 0.002);
    assert_true(all.fastest > 0.04 && all.fastest < 0.12);
    sim_bodies_close(&w, &b);
    sim_close(&w);
}

static void a_ball_leaves_no_trail(void **state) {
    lbm_desc desc = {.size = {32, 16, 16},
                     .collision = LBM_CENTRAL_MOMENTS,
                     .precision = LBM_F16,
                     .lanes = 2, // as on GPUs
                     .scalars = 1,
                     .bodies = true};
    fly(*state, &desc, 0.04, 0.03);
    if (!sim_long_tests("a ball in single precision, and in the larger velocity set")) return;
    desc.precision = LBM_F32;
    desc.lanes = 0;
    fly(*state, &desc, 0.03, 0.025);
    desc.set = LBM_D3Q27;
    desc.scalar_set = LBM_SCALAR_D3Q27;
    fly(*state, &desc, 0.02, 0.015);
    desc.precision = LBM_F16;
    desc.lanes = 2;
    fly(*state, &desc, 0.03, 0.025);
}

// ---- a thin plate -----------------------------------------------------------------------------

typedef struct sheet {
    double at;
    bool tilted;
} sheet;

static double beyond_sheet(const float p[3], const sheet *s) {
    double x = (double)p[0];
    return s->tilted ? (x + 0.5 * ((double)p[2] - 8) - s->at) / sqrt(1.25) : x - s->at;
}

static int in_sheet(const float p[3], const void *user) {
    return fabs(beyond_sheet(p, user)) <= (((const sheet *)user)->tilted ? 0.9 : 0.5);
}

static bool behind_sheet(const float p[3], const void *user) {
    return beyond_sheet(p, user) < -1;
}

static sheet first_sheet;

static void smoke_ahead(int x, int y, int z, sim_cell *cell) {
    const float p[3] = {(float)x + 0.5f, (float)y + 0.5f, (float)z + 0.5f};
    cell->scalar[0] = beyond_sheet(p, &first_sheet) > 0;
}

// Sweeps smoke out of a duct, as fast as sound nearly allows, and looks behind. `most`: as fast as
// air may be; 0: any.
static void sweep(gpu *g, bool tilted, lbm_precision precision, double speed, double most) {
    sim_world w;
    sim_bodies b;
    sim_open(&w, g,
             &(lbm_desc){.size = {48, 4, 16},
                         .collision = LBM_CENTRAL_MOMENTS,
                         .precision = precision,
                         .faces = {LBM_OPEN, LBM_OPEN, [4] = LBM_WALL, LBM_WALL},
                         .scalars = 1,
                         .bodies = true});
    w.numbers.tau = 0.55f;
    w.numbers.scalar_tau[0] = 0.51f;
    w.numbers.max_speed = (float)most;
    sim_bodies_open(&w, &b);
    sheet s = first_sheet = (sheet){14, tilted};
    sim_set_state(&w, smoke_ahead);
    double swept = 0;
    for (int i = 0; s.at < 34; i++) {
        double now = speed * fmin(1, i / 40.0);
        b.body[0].linear[0] = (float)now;
        step_with(&w, &b, in_sheet, &s);
        s.at += now;
        swept += now * 4 * 16;
    }
    seen behind = look(&w, behind_sheet, &s), all = look(&w, NULL, NULL);
    print_message(
        "%s plate: %.2e of the smoke that it swept is behind it; most %.3f, fastest %.3f\n",
        tilted ? "tilted" : "thin", behind.smoke / swept, all.most, all.fastest);
    assert_true(fabs(behind.smoke / swept) < 1e-4 && behind.most < 1e-2);
    assert_true(all.fastest < (most > 0 ? 1.01 * most : 2 * speed));
    // What halves round to differs by device.
    assert_true(all.most < (precision == LBM_F16 ? 1.3 : 1.25));
    sim_bodies_close(&w, &b);
    sim_close(&w);
}

static void nothing_leaks_through_a_thin_fast_plate(void **state) {
    sweep(*state, false, LBM_F32, 0.25, 0);
    if (sim_long_tests("a tilted plate in half precision")) sweep(*state, true, LBM_F16, 0.15, 0);
}

static void a_plate_faster_than_air_may_be_bursts_nothing(void **state) {
    sweep(*state, true, LBM_F32, 0.6, 0.17);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_leaves_no_trail),
        cmocka_unit_test(nothing_leaks_through_a_thin_fast_plate),
        cmocka_unit_test(a_plate_faster_than_air_may_be_bursts_nothing),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
