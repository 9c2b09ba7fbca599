// What the air carries: it spreads as its diffusion says, goes where the air goes, decays, and
// stays within its bounds.
#include "sim_test.h"

enum { SIZE = 40 };

static const double width = 4.5; // cells; of the smooth blob at first
static double velocity[3];
static bool sharp; // a ball with a hard edge instead

static void blob(int x, int y, int z, sim_cell *cell) {
    double d[3] = {x - SIZE / 2, y - SIZE / 2, z - SIZE / 2};
    double r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    for (int k = 0; k < 3; k++) cell->u[k] = velocity[k];
    cell->scalar[0] = sharp ? r2 < 64 : exp(-r2 / (2 * width * width));
}

typedef struct shape { // of a blob
    double sum, centre[3], variance[3], least, most;
} shape;

static void add(shape *s, double v, const double d[3]) {
    s->sum += v;
    s->least = fmin(s->least, v);
    s->most = fmax(s->most, v);
    for (int k = 0; k < 3; k++) {
        s->centre[k] += v * d[k];
        s->variance[k] += v * d[k] * d[k];
    }
}

// `from`: where the blob ought to be. Distances go round.
static shape measure(sim_world *w, const double from[3]) {
    shape s = {.least = 1e9, .most = -1e9};
    sim_read(w);
    for (size_t c = 0; c < w->cells; c++) {
        size_t p[3] = {c % SIZE, c / SIZE % SIZE, c / SIZE / SIZE};
        double d[3];
        for (int k = 0; k < 3; k++) d[k] = remainder((double)p[k] - from[k], SIZE);
        add(&s, w->state[c].scalar[0], d);
    }
    for (int k = 0; k < 3; k++) {
        s.centre[k] /= s.sum;
        s.variance[k] = s.variance[k] / s.sum - s.centre[k] * s.centre[k];
    }
    return s;
}

static void open_world(sim_world *w, gpu *g, lbm_scalar_set set, double diffusion) {
    sim_open(w, g,
             &(lbm_desc){.size = {SIZE, SIZE, SIZE},
                         .scalars = 1,
                         .scalar_set = set,
                         .collision = LBM_CENTRAL_MOMENTS});
    w->numbers.scalar_tau[0] = (float)(0.5 + diffusion / (double)lbm_scalar_speed(set));
}

static const char *const names[] = {"D3Q7", "D3Q27"};

static void a_blob_spreads_as_its_diffusion_says(void **state) {
    const double centre[3] = {SIZE / 2, SIZE / 2, SIZE / 2}, diffusion = 0.02;
    sharp = false;
    memset(velocity, 0, sizeof velocity);
    for (int set = 0; set < 2; set++) {
        sim_world w;
        open_world(&w, *state, (lbm_scalar_set)set, diffusion);
        sim_set_state(&w, blob);
        sim_run(&w, 50); // what the start had too little of flux settles
        shape before = measure(&w, centre);
        sim_run(&w, 120);
        shape after = measure(&w, centre);
        double found = (after.variance[0] - before.variance[0]) / (2 * 120);
        print_message("blob, %s: diffusion off by %.3f %%\n", names[set],
                      100 * (found / diffusion - 1));
        assert_true(fabs(found / diffusion - 1) < 0.005);
        assert_true(fabs(after.variance[2] / after.variance[0] - 1) < 1e-4);
        assert_true(fabs(after.sum / before.sum - 1) < 1e-5);
        sim_close(&w);
    }
}

static void a_blob_goes_where_the_air_goes(void **state) {
    const int steps = 150;
    for (int set = 0; set < 2; set++)
        for (int edge = 0; edge < 2; edge++) {
            sim_world w;
            sharp = edge;
            for (int k = 0; k < 3; k++) velocity[k] = 0.03 * (k + 1);
            open_world(&w, *state, (lbm_scalar_set)set, 0.002);
            sim_set_state(&w, blob);
            sim_run(&w, steps);
            double to[3];
            for (int k = 0; k < 3; k++) to[k] = SIZE / 2 + steps * velocity[k];
            shape s = measure(&w, to);
            print_message("%s blob, %s: off by %.3f %.3f %.3f cells, from %.4f to %.4f, variances "
                          "%.2f %.2f %.2f\n",
                          edge ? "sharp" : "smooth", names[set], s.centre[0], s.centre[1],
                          s.centre[2], s.least, s.most, s.variance[0], s.variance[1],
                          s.variance[2]);
            for (int k = 0; k < 3; k++) {
                assert_true(fabs(s.centre[k]) < 0.012);
                assert_true(fabs(s.variance[k] / s.variance[0] - 1) < 0.006); // it stays round
            }
            assert_true(s.least >= (set == LBM_SCALAR_D3Q7 ? 0 : -0.1));
            assert_true(s.most < (edge ? 1.25 : 1.001));
            sim_close(&w);
        }
}

static void what_decays_is_gone_in_time(void **state) {
    const double centre[3] = {SIZE / 2, SIZE / 2, SIZE / 2};
    sharp = false;
    memset(velocity, 0, sizeof velocity);
    for (int set = 0; set < 2; set++) {
        sim_world w;
        open_world(&w, *state, (lbm_scalar_set)set, 0.01);
        w.numbers.decay[0] = 0.01f;
        w.numbers.ambient[0] = 0.25f;
        sim_set_state(&w, blob);
        double before = measure(&w, centre).sum - 0.25 * (double)w.cells;
        sim_run(&w, 100);
        double after = measure(&w, centre).sum - 0.25 * (double)w.cells;
        assert_true(fabs(after / before / pow(0.99, 100) - 1) < 1e-4);
        sim_close(&w);
    }
}

static void warm(int x, int y, int z, sim_cell *cell) {
    (void)x, (void)y, (void)z;
    cell->scalar[0] = 10000;
}

// Heat may be kelvin: 16 bits hold the 10,000 that a source may give.
static void what_is_large_stays(void **state) {
    for (int i = 0; i < 4; i++) {
        sim_world w;
        sim_open(&w, *state,
                 &(lbm_desc){.size = {16, 16, 16},
                             .scalar_set = i % 2 ? LBM_SCALAR_D3Q27 : LBM_SCALAR_D3Q7,
                             .precision = LBM_F16,
                             .lanes = i / 2 ? 2 : 4,
                             .scalars = 1});
        sim_set_state(&w, warm);
        sim_run(&w, 20);
        sim_read(&w);
        for (size_t c = 0; c < w.cells; c++) {
            assert_true(fabs(w.state[c].scalar[0] / 10000 - 1) < 2e-3);
            for (int k = 0; k < 3; k++) assert_true(fabs(w.state[c].u[k]) < 1e-6);
        }
        sim_close(&w);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_blob_spreads_as_its_diffusion_says),
        cmocka_unit_test(a_blob_goes_where_the_air_goes),
        cmocka_unit_test(what_decays_is_gone_in_time),
        cmocka_unit_test(what_is_large_stays),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
