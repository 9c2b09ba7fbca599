// The air of a solver against what theory says of it.
#include "sim_test.h"

static const double PI = 3.14159265358979;

// ---- decay of a vortex ------------------------------------------------------------------------

enum { VORTEX = 64 };
static const double vortex_speed = 0.02;

static void vortex(int x, int y, int z, sim_cell *cell) {
    double k = 2 * PI / VORTEX, a = k * x, b = k * y;
    (void)z;
    cell->u[0] = vortex_speed * sin(a) * cos(b);
    cell->u[1] = -vortex_speed * cos(a) * sin(b);
    cell->density = 1 + 0.75 * vortex_speed * vortex_speed * (cos(2 * a) + cos(2 * b));
}

static double energy(const sim_world *w) {
    double sum = 0;
    for (size_t i = 0; i < w->cells; i++)
        for (int k = 0; k < 3; k++) sum += w->state[i].u[k] * w->state[i].u[k];
    return sum;
}

// The relative error of the rate at which a Taylor-Green vortex of 64 x 64 cells decays.
static double vortex_error(gpu *g, lbm_set set, lbm_collision collision) {
    sim_world w;
    sim_open(&w, g, &(lbm_desc){.size = {VORTEX, VORTEX, 16}, .set = set, .collision = collision});
    w.numbers.tau = 0.65f;
    sim_set_state(&w, vortex);
    sim_run(&w, 100); // what the start had of sound and stress settles
    sim_read(&w);
    double before = energy(&w);
    sim_run(&w, 400);
    sim_read(&w);
    double k = 2 * PI / VORTEX, viscosity = ((double)w.numbers.tau - 0.5) / 3;
    double rate = log(before / energy(&w)) / (400 * 4 * viscosity * k * k);
    sim_close(&w);
    return rate - 1;
}

static void a_vortex_decays_as_its_viscosity_says(void **state) {
    static const char *const sets[] = {"D3Q19", "D3Q27"}, *const ways[] = {"BGK", "TRT", "moments"};
    for (int set = 0; set < 2; set++)
        for (int way = 0; way < 3; way++) {
            double error = vortex_error(*state, (lbm_set)set, (lbm_collision)way);
            print_message("vortex, %s %s: rate off by %.4f %%\n", sets[set], ways[way],
                          100 * error);
            assert_true(fabs(error) < 1e-3);
        }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_vortex_decays_as_its_viscosity_says),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
