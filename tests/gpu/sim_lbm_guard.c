// What the guard of a simulation reports.
#include "sim/lbm_guard.h"
#include "sim_bodies_test.h"

enum { NX = 12, NY = 8, NZ = 16 };

static void stirred(int x, int y, int z, sim_cell *cell) {
    cell->density = 1.001;
    if (x == 5 && y == 3 && z == 9) cell->u[1] = -0.12;
    if (x == 7 && y == 1 && z == 14) cell->u[2] = 0.08;
    cell->scalar[0] = x == 2 && y == 2 && z == 2 ? 4 : 0.5;
    cell->scalar[1] = x == 3 && y == 2 && z == 2 ? -3 : 0;
}

static void spoilt(int x, int y, int z, sim_cell *cell) {
    stirred(x, y, z, cell);
    if (x == 10 && y == 6 && z == 3) cell->density = (double)NAN;
    if (x == 11 && y == 6 && z == 3) cell->scalar[0] = 1e9;
}

static int corner(const float p[3], const void *user) {
    (void)user;
    return p[0] < 2 && p[1] < 2 && p[2] < 2;
}

typedef struct guarded {
    sim_world w;
    sim_bodies b;
    lbm_guard *guard;
} guarded;

static void open_guarded(guarded *t, gpu *g) {
    sim_open(&t->w, g, &(lbm_desc){.size = {NX, NY, NZ}, .scalars = 2, .bodies = true});
    sim_bodies_open(&t->w, &t->b);
    t->guard = lbm_guard_create(&t->w.memory, t->w.desc.size);
    gpu_test_ok(lbm_guard_compile(t->guard, t->w.library, NULL));
    gpu_test_ok(lbm_guard_allocate(t->guard, g));
}

static void close_guarded(guarded *t) {
    lbm_guard_destroy(t->guard, t->w.device);
    sim_bodies_close(&t->w, &t->b);
    sim_close(&t->w);
}

typedef void state_at(int x, int y, int z, sim_cell *cell);

// The report of the state that `at` says, of one frame, read when that is done.
static lbm_report report_within(guarded *t, state_at *at, lbm_guard_limits limits) {
    lbm_report report;
    sim_set_state(&t->w, at);
    lbm_guard_forget(t->guard);
    uint64_t frame = gpu_frame_begin(t->w.device);
    gpu_test_ok(frame);
    gpu_test_ok(lbm_guard_record(t->guard, t->w.device, t->w.lattice, limits)); // nothing is kept
    sim_bodies_set(&t->w, &t->b, corner, NULL);
    gpu_test_ok(lbm_step(t->w.lattice, t->w.device, &t->w.numbers, true));
    gpu_test_ok(lbm_guard_record(t->guard, t->w.device, t->w.lattice, limits));
    assert_false(lbm_guard_read(t->guard, t->w.device, &report)); // of an open frame
    gpu_test_ok(gpu_frame_end(t->w.device));
    gpu_test_ok(gpu_frame_wait(t->w.device, frame));
    gpu_test_ok(lbm_guard_read(t->guard, t->w.device, &report));
    return report;
}

static lbm_report report_of(guarded *t, state_at *at) {
    return report_within(t, at, (lbm_guard_limits){.speed = 1, .drift = 0.5f});
}

static bool near(float seen, double wanted, double by) {
    return fabs((double)seen - wanted) < by;
}

static void guard_tells_speed_mass_and_scalars(void **state) {
    guarded t;
    open_guarded(&t, *state);
    lbm_report r = report_of(&t, stirred);
    assert_int_equal(r.cells, NX * NY * NZ - 8);
    assert_int_equal(r.bad, 0);
    assert_int_equal(r.spoilt, 0);
    assert_int_equal(r.step, 1);
    assert_true(near(r.speed, 0.12, 1e-4));
    assert_int_equal(r.where[0], 5);
    assert_int_equal(r.where[1], 3);
    assert_int_equal(r.where[2], 9);
    assert_true(near(r.drift, 0.001, 2e-6));
    assert_true(near(r.least[0], 0.5, 1e-3) && near(r.most[0], 4, 1e-2));
    assert_true(near(r.least[1], -3, 1e-2) && near(r.most[1], 0, 1e-6));
    assert_true(near(r.sum[0], 0.5 * (NX * NY * NZ - 9) + 4, 0.5) && near(r.sum[1], -3, 1e-2));
    close_guarded(&t);
}

static void guard_counts_what_is_no_number(void **state) {
    guarded t;
    open_guarded(&t, *state);
    lbm_report r = report_of(&t, spoilt);
    assert_int_equal(r.bad, 2);
    assert_int_equal(r.spoilt, LBM_SPOILT_NUMBERS);
    assert_true(near(r.speed, 0.12, 1e-4) && near(r.most[0], 4, 1e-2)); // of the others
    close_guarded(&t);
}

static void thin(int x, int y, int z, sim_cell *cell) {
    stirred(x, y, z, cell);
    cell->density = 0.9;
}

// The speed is 0.12, the mass 0.001 more or 0.1 less: each limit by itself, a little above and
// below.
static void guard_says_by_what_air_is_spoilt(void **state) {
    static const struct {
        state_at *at;
        lbm_guard_limits limits;
        uint32_t spoilt;
    } rows[] = {
        {stirred, {0.121f, 0.0011f}, 0},
        {stirred, {0.119f, 0.0011f}, LBM_SPOILT_SPEED},
        {stirred, {0.121f, 0.0009f}, LBM_SPOILT_MASS},
        {thin, {1, 0.11f}, 0},
        {thin, {1, 0.09f}, LBM_SPOILT_MASS},
        {spoilt, {0.119f, 0.0009f}, LBM_SPOILT_NUMBERS | LBM_SPOILT_MASS | LBM_SPOILT_SPEED},
    };
    guarded t;
    open_guarded(&t, *state);
    for (size_t i = 0; i < COUNT_OF(rows); i++)
        assert_int_equal(report_within(&t, rows[i].at, rows[i].limits).spoilt, rows[i].spoilt);
    close_guarded(&t);
}

// Many frames, never waited for: each report is of a frame that is done, and they come in order.
static void guard_never_waits(void **state) {
    guarded t;
    open_guarded(&t, *state);
    sim_set_state(&t.w, stirred);
    uint64_t last = 0;
    for (int i = 0; i < 40; i++) {
        lbm_report r;
        gpu_test_ok(gpu_frame_begin(t.w.device));
        if (i == 0) sim_bodies_set(&t.w, &t.b, corner, NULL);
        gpu_test_ok(lbm_step(t.w.lattice, t.w.device, &t.w.numbers, true));
        gpu_test_ok(lbm_guard_record(t.guard, t.w.device, t.w.lattice,
                                     (lbm_guard_limits){.speed = 1, .drift = 0.5f}));
        if (lbm_guard_read(t.guard, t.w.device, &r)) {
            assert_true(r.step >= last && r.step <= (uint64_t)i);
            assert_int_equal(r.cells, NX * NY * NZ - 8);
            last = r.step;
        }
        gpu_test_ok(gpu_frame_end(t.w.device));
    }
    assert_true(last >= 40 - GPU_FRAMES_IN_FLIGHT);
    close_guarded(&t);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(guard_tells_speed_mass_and_scalars),
        cmocka_unit_test(guard_counts_what_is_no_number),
        cmocka_unit_test(guard_says_by_what_air_is_spoilt),
        cmocka_unit_test(guard_never_waits),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
