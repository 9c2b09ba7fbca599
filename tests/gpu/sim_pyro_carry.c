// What the gas carries keeps its mass and its shape, however it moves.
#include "base/memory.h"
#include "long_test.h"
#include "pyro_test.h"

static const double pi = 3.14159265358979;

// ---- what moves -------------------------------------------------------------------------------

static void fill_patch(pyro_world *w, const int c[3], void *data) {
    (void)data;
    const double r = hypot(c[0] + 0.5 - w->desc.size[0] / 2.0, c[1] + 0.5 - w->desc.size[1] / 2.0);
    if (c[2] < 3 && r < 5) w->gas[pyro_cell_at(w, c)][0] = 200;
}

// It draws air in along the floor, and rises.
static void check_patch(gpu *g, bool half) {
    pyro_world w;
    pyro_open(&w, g,
              &(pyro_desc){.size = {32, 32, 32},
                           .faces = {[4] = PYRO_WALL},
                           .advection = PYRO_PARABOLIC,
                           .half_velocity = half});
    w.numbers.gravity = 9.81f;
    pyro_for_each(&w, fill_patch, NULL);
    pyro_transfer(&w, true);
    const double before = pyro_sum_up(&w).heat;
    pyro_run_steps(&w, 60);
    const pyro_sums after = pyro_sum_up(&w);
    print_message("a warm patch on the floor keeps %.4f of its heat; hottest %.0f K\n",
                  after.heat / before, after.hottest);
    assert_true(fabs(after.heat / before - 1) < 0.003);
    assert_true(after.hottest < 450); // it has risen, and mixed
    pyro_close(&w);
}

static void a_warm_patch_on_the_floor_keeps_its_heat(void **state) {
    check_patch(*state, false);
    if (sim_long_tests("a patch with half the velocity")) check_patch(*state, true);
}

// ---- around a box ------------------------------------------------------------------------------

static void fill_drop(pyro_world *w, const int c[3], void *data) {
    (void)data;
    double r2 = 0;
    for (int i = 0; i < 3; i++) r2 += pow(c[i] + 0.5 - w->desc.size[i] / 2.0, 2);
    w->gas[pyro_cell_at(w, c)][3] = (float)exp(-r2 / (2 * 2.5 * 2.5));
}

static void set_wind(pyro_world *w, const float wind[3]) {
    for (size_t i = 0; i < w->cells; i++) memcpy(w->velocity[i], wind, 3 * sizeof *wind);
}

// A drop of soot, 2.5 cells to its standard deviation, goes across the box and is where it was.
// Returns how much of it is elsewhere.
static double carry_around(gpu *g, pyro_advection advection, float cells_a_step) {
    pyro_world w;
    pyro_open(
        &w, g,
        &(pyro_desc){.size = {32, 32, 32}, .faces = {3, 3, 3, 3, 3, 3}, .advection = advection});
    w.numbers.gravity = 0;
    const float step = w.numbers.cell / w.numbers.dt, one = cells_a_step * step;
    const float wind[3] = {one, -one, one};
    pyro_for_each(&w, fill_drop, NULL);
    set_wind(&w, wind);
    pyro_transfer(&w, true);
    float *was = mem_copy(w.gas, w.cells * sizeof *w.gas);
    pyro_run_steps(&w, (int)(32 / cells_a_step + 0.5f));
    pyro_transfer(&w, false);
    double sum = 0, all = 0, elsewhere = 0;
    for (size_t i = 0; i < w.cells; i++) {
        sum += (double)w.gas[i][3];
        all += (double)was[4 * i + 3];
        elsewhere += fabs((double)w.gas[i][3] - (double)was[4 * i + 3]) / 2;
    }
    print_message("%.1f cells a step along each axis: %.5f kept, %.3f of it elsewhere\n",
                  (double)cells_a_step, sum / all, elsewhere / all);
    assert_true(fabs(sum / all - 1) < 5e-4);
    mem_free(was);
    pyro_close(&w);
    return elsewhere / all;
}

static void a_drop_keeps_its_shape(void **state) {
    const double slow = carry_around(*state, PYRO_PARABOLIC, 0.8f);
    const double fast = carry_around(*state, PYRO_PARABOLIC, 3.2f);
    const double coarse = carry_around(*state, PYRO_UPWIND, 0.8f);
    assert_true(slow < 0.075 && fast < 0.02);
    assert_true(coarse > 2 * slow);
}

static void fill_hot(pyro_world *w, const int c[3], void *data) {
    (void)data;
    float *g = w->gas[pyro_cell_at(w, c)];
    g[0] = 300;
    g[3] = 0.1f;
}

static void fill_cells(pyro_world *w, const int c[3], void *data) {
    const float *speed = data;
    const double x = 2 * pi * c[0] / 32, y = 2 * pi * c[1] / 32, z = 2 * pi * c[2] / 32,
                 h = pi / 32;
    float *v[3] = {pyro_face_at(w, 0, c), pyro_face_at(w, 1, c), pyro_face_at(w, 2, c)};
    *v[0] = *speed * (float)(sin(x) * cos(y + h) * cos(z + h));
    *v[1] = *speed * (float)(cos(x + h) * sin(y) * cos(z + h));
    *v[2] = *speed * (float)(-2 * cos(x + h) * cos(y + h) * sin(z));
}

// Gas that is the same everywhere stays so, however it is stirred: up to 4 cells a step, which
// differ by 0.8 from cell to cell.
static void stirring_does_not_change_even_gas(void **state) {
    pyro_world w;
    pyro_open(&w, *state,
              &(pyro_desc){
                  .size = {32, 32, 32}, .faces = {3, 3, 3, 3, 3, 3}, .advection = PYRO_PARABOLIC});
    w.numbers.gravity = 0;
    float speed = 2 * w.numbers.cell / w.numbers.dt;
    pyro_for_each(&w, fill_hot, NULL);
    pyro_for_each(&w, fill_cells, &speed);
    pyro_transfer(&w, true);
    pyro_run_steps(&w, 1);
    pyro_transfer(&w, false);
    double most = 0;
    for (size_t i = 0; i < w.cells; i++) {
        most = fmax(most, fabs((double)w.gas[i][0] / 300 - 1));
        most = fmax(most, fabs((double)w.gas[i][3] / 0.1 - 1));
    }
    print_message("even gas, stirred: wrong by %.2e at most\n", most);
    assert_true(most < 1e-3);
    pyro_close(&w);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_warm_patch_on_the_floor_keeps_its_heat),
        cmocka_unit_test(a_drop_keeps_its_shape),
        cmocka_unit_test(stirring_does_not_change_even_gas),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
