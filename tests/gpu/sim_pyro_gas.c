// Burning gas against theory: how much fuel burns, how warm it becomes, how far it expands, what is
// kept, and how fast warm gas rises.
#include "long_test.h"
#include "pyro_test.h"

static const double pi = 3.14159265358979;

// ---- a cell that burns ------------------------------------------------------------------------

typedef struct even {
    float warmth, fuel;
} even;

static void fill(pyro_world *w, const int c[3], void *data) {
    const even *e = data;
    w->gas[pyro_cell_at(w, c)][0] = e->warmth;
    w->gas[pyro_cell_at(w, c)][1] = e->fuel;
}

// Gas that is the same everywhere, in a box that is around: nothing moves, all burns.
static pyro_sums burn_evenly(gpu *g, even e, float burn_time, float dt, int steps) {
    pyro_world w;
    pyro_open(&w, g, &(pyro_desc){.size = {16, 16, 16}, .faces = {3, 3, 3, 3, 3, 3}});
    w.numbers.burn_time = burn_time;
    w.numbers.soot_yield = 0.05f;
    w.numbers.dt = dt;
    w.numbers.gravity = 0;
    pyro_for_each(&w, fill, &e);
    pyro_transfer(&w, true);
    pyro_run_steps(&w, steps);
    pyro_sums s = pyro_sum_up(&w);
    const float *one = w.gas[100];
    const double t = (double)w.numbers.ambient + (double)one[0];
    s = (pyro_sums){(double)one[1], (double)one[2], (double)one[3], (double)one[0], t};
    pyro_close(&w);
    return s;
}

static void fuel_burns_as_far_as_oxygen_goes(void **state) {
    // Poor: all fuel burns. Rich: as much as 0.232 kg of oxygen in 1 kg of air take.
    const pyro_sums poor = burn_evenly(*state, (even){500, 0.02f}, 0, 0.01f, 1);
    const pyro_sums rich = burn_evenly(*state, (even){500, 0.5f}, 0, 0.01f, 1);
    const pyro_sums cold = burn_evenly(*state, (even){200, 0.02f}, 0, 0.01f, 10);
    print_message("poor: %.5f burnt, %.1f K; rich: %.5f burnt, %.1f K\n", poor.burnt, poor.hottest,
                  rich.burnt, rich.hottest);
    assert_true(fabs(poor.burnt - 0.02) < 1e-6 && fabs(poor.fuel) < 1e-6);
    assert_true(fabs(poor.soot - 0.05 * 0.02) < 1e-7);
    assert_true(fabs(poor.hottest - (800 + 3e7 * 0.02 / 1150 / 1.02)) < 0.5);
    assert_true(fabs(rich.burnt - 0.232 / 3.5) < 1e-6);
    assert_true(fabs(rich.hottest - (800 + 3e7 * rich.burnt / 1150 / 1.5)) < 0.5);
    assert_true(cold.burnt == 0);
}

static void fuel_burns_at_the_rate_at_which_it_mixes(void **state) {
    // What is left after a time t is exp(-t / burn_time), whatever the steps.
    const pyro_sums coarse = burn_evenly(*state, (even){500, 0.02f}, 0.1f, 0.02f, 5);
    const pyro_sums fine = burn_evenly(*state, (even){500, 0.02f}, 0.1f, 0.005f, 20);
    print_message("left after a burn time: %.5f and %.5f\n", coarse.fuel / 0.02, fine.fuel / 0.02);
    assert_true(fabs(coarse.fuel / 0.02 - exp(-1)) < 1e-4);
    assert_true(fabs(fine.fuel / 0.02 - exp(-1)) < 1e-4);
}

static void hot_gas_cools_by_the_fourth_power(void **state) {
    pyro_world w;
    pyro_open(&w, *state, &(pyro_desc){.size = {16, 16, 16}, .faces = {3, 3, 3, 3, 3, 3}});
    w.numbers.cooling = 400;
    w.numbers.gravity = 0;
    w.numbers.dt = 0.02f;
    even e = {1700, 0};
    pyro_for_each(&w, fill, &e);
    pyro_transfer(&w, true);
    pyro_run_steps(&w, 50);
    pyro_transfer(&w, false);
    double t = 2000;
    for (int i = 0; i < 100000; i++) t -= 1e-5 * 400 * (pow(t, 4) - pow(300, 4)) / pow(1500, 4);
    print_message("after 1 s: %.1f K, theory %.1f K\n", 300 + (double)w.gas[5][0], t);
    assert_true(fabs(300 + (double)w.gas[5][0] - t) < 0.005 * t);
    pyro_close(&w);
}

// ---- expansion --------------------------------------------------------------------------------

typedef struct ball {
    double radius; // cells
    float warmth, fuel;
    bool lumpy; // each second cell has twice the fuel, the others have none
} ball;

static void fill_ball(pyro_world *w, const int c[3], void *data) {
    const ball *b = data;
    double r2 = 0;
    for (int i = 0; i < 3; i++) r2 += pow(c[i] + 0.5 - w->desc.size[i] / 2.0, 2);
    const float in = (float)fmin(1, fmax(0, (b->radius - sqrt(r2)) / 4 + 0.5));
    w->gas[pyro_cell_at(w, c)][0] = b->warmth * in;
    const float lump = !b->lumpy ? 1 : (c[0] + c[1] + c[2]) % 2 == 0 ? 2 : 0;
    w->gas[pyro_cell_at(w, c)][1] = b->fuel * in * lump;
}

// What flows out of a box within the grid, m^3/s.
static double outflow(pyro_world *w, int margin) {
    const int n[3] = {pyro_flow_cells_along(w, 0), pyro_flow_cells_along(w, 1),
                      pyro_flow_cells_along(w, 2)};
    double sum = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int i = margin; i < n[(axis + 1) % 3] - margin; i++)
            for (int k = margin; k < n[(axis + 2) % 3] - margin; k++) {
                int c[3];
                c[(axis + 1) % 3] = i, c[(axis + 2) % 3] = k;
                c[axis] = margin;
                sum -= (double)*pyro_face_at(w, axis, c);
                c[axis] = n[axis] - margin;
                sum += (double)*pyro_face_at(w, axis, c);
            }
    return sum * pow((double)w->numbers.cell * pyro_ratio(&w->desc), 2);
}

// What burns at a known power makes so much room: div u = power / (density x heat capacity x
// temperature), the same for all gas at this pressure.
static void check_room(gpu *g, pyro_advection advection, bool half) {
    pyro_world w;
    pyro_open(
        &w, g,
        &(pyro_desc){
            .size = {32, 32, 32}, .advection = advection, .cycles = 6, .half_velocity = half});
    w.numbers.gravity = 0;
    w.numbers.dt = 1e-4f; // so short that nothing moves
    w.numbers.burn_time = 0.1f;
    ball b = {8, 600, 0.02f, false};
    pyro_for_each(&w, fill_ball, &b);
    pyro_transfer(&w, true);
    pyro_run_steps(&w, 1);
    const pyro_report r = pyro_look_at(&w);
    pyro_transfer(&w, false);
    const double flow = outflow(&w, 2);
    // The report's power is of the state after the step: all but the same.
    const double wanted = (double)r.power / (353 * 1150) / 1.02; // fuel is warmed, too
    print_message("%.1f kW make %.4f m^3/s; theory %.4f\n", (double)r.power / 1e3, flow, wanted);
    assert_true(fabs(flow / wanted - 1) < 0.01);
    pyro_close(&w);
}

static void heat_makes_room(void **state) {
    check_room(*state, PYRO_UPWIND, false);
    check_room(*state, PYRO_REFLECTION, false);
}

static void heat_makes_room_for_half_the_velocity(void **state) {
    check_room(*state, PYRO_REFLECTION, true);
}

// A ball that burns in still air and pushes it away: fuel and heat are where they were, or burnt.
static void check_balance(gpu *g, bool half, bool lumpy, pyro_precision precision) {
    pyro_world w;
    pyro_open(&w, g,
              &(pyro_desc){.size = {32, 32, 32},
                           .advection = PYRO_PARABOLIC,
                           .precision = precision,
                           .half_velocity = half});
    w.numbers.gravity = 0;
    w.numbers.burn_time = 0.05f;
    w.numbers.dt = 0.004f;
    ball b = {6, 400, 0.03f, lumpy};
    pyro_for_each(&w, fill_ball, &b);
    pyro_transfer(&w, true);
    const pyro_sums before = pyro_sum_up(&w);
    pyro_run_steps(&w, 40); // 3 burn times
    const pyro_sums after = pyro_sum_up(&w);
    const double mass = before.fuel, burnt = after.burnt + after.fuel;
    print_message("fuel and burnt: %.2f of %.2f; hottest %.0f K\n", burnt, mass, after.hottest);
    assert_true(fabs(burnt / mass - 1) < 0.006);
    // Each kg of burnt fuel warms by heat / capacity, less what it is mixed with.
    const double wanted = before.heat + 3e7 * after.burnt / 1150 / 1.03;
    print_message("heat %.0f of %.0f K cells\n", after.heat, wanted);
    assert_true(fabs(after.heat / wanted - 1) < 0.004);
    pyro_close(&w);
}

static void a_ball_keeps_what_it_has(void **state) {
    check_balance(*state, false, false, PYRO_F16);
    if (sim_long_tests("a ball in single precision")) check_balance(*state, false, false, PYRO_F32);
}

static void a_ball_keeps_what_it_has_with_half_the_velocity(void **state) {
    check_balance(*state, true, true, PYRO_F32);
    if (sim_long_tests("half the velocity in halves")) check_balance(*state, true, false, PYRO_F16);
}

// Runs a ball that burns and rises. `everywhere`: the solver is never told where there is gas.
static float *run_ball(gpu *g, bool everywhere, size_t *bytes) {
    pyro_world w;
    pyro_open(
        &w, g,
        &(pyro_desc){.size = {32, 32, 32}, .advection = PYRO_PARABOLIC, .half_velocity = true});
    w.numbers.gravity = 9.81f;
    w.numbers.burn_time = 0.05f;
    ball b = {5, 700, 0.05f, false};
    pyro_for_each(&w, fill_ball, &b);
    pyro_transfer(&w, true);
    for (int i = 0; i < 12; i++) {
        gpu_buffer *buffers[PYRO_STATE_BUFFERS];
        if (everywhere) pyro_buffers(w.solver, buffers);
        pyro_run_steps(&w, 1);
    }
    pyro_transfer(&w, false);
    *bytes = w.cells * sizeof *w.gas;
    float *gas = mem_copy(w.gas, *bytes);
    pyro_close(&w);
    return gas;
}

static void clean_air_is_left_as_it_is(void **state) {
    size_t bytes;
    float *all = run_ball(*state, true, &bytes), *some = run_ball(*state, false, &bytes);
    assert_memory_equal(all, some, bytes);
    mem_free(all);
    mem_free(some);
}

// ---- a premixed flame --------------------------------------------------------------------------

typedef struct mixture {
    float fuel, warmth; // of the mixture; of what has burnt
    double length;      // of that, cells from the closed end
} mixture;

static void fill_mixture(pyro_world *w, const int c[3], void *data) {
    const mixture *m = data;
    const float burnt = (float)fmin(1, fmax(0, (m->length - c[0]) / 2));
    float *g = w->gas[pyro_cell_at(w, c)];
    g[0] = m->warmth * burnt;
    g[1] = m->fuel * (1 - burnt);
    g[2] = m->fuel * burnt;
}

// How far it has burnt, from the mass of burnt fuel, in cells.
static double burnt_length(pyro_world *w, const mixture *m) {
    const double ambient = (double)w->numbers.ambient, t = ambient + (double)m->warmth;
    const double section = (double)w->desc.size[1] * w->desc.size[2];
    return pyro_sum_up(w).burnt / ((double)m->fuel * ambient / t) / section;
}

// A flame leaves the closed end of a tube. What has burnt takes `lighter` times as much room, so
// the front moves so much faster than the flame does into mixture.
static void check_flame(gpu *g, bool half) {
    pyro_world w;
    const pyro_desc tube = {
        .size = {96, 16, 16},
        .faces = {PYRO_WALL, PYRO_OPEN, PYRO_WALL, PYRO_WALL, PYRO_WALL, PYRO_WALL},
        .advection = PYRO_PARABOLIC,
        .premixed = true,
        .half_velocity = half,
    };
    pyro_open(&w, g, &tube);
    w.numbers.gravity = 0;
    w.numbers.flame_speed = 1;
    w.numbers.dt = 0.005f;
    mixture m = {.fuel = 0.03f, .length = 12};
    m.warmth = w.numbers.heat * m.fuel / 1150 / (1 + m.fuel);
    pyro_for_each(&w, fill_mixture, &m);
    pyro_transfer(&w, true);
    pyro_run_steps(&w, 20);
    const double begin = burnt_length(&w, &m);
    pyro_run_steps(&w, 80);
    const double end = burnt_length(&w, &m);
    const double lighter = 1 + (double)(m.warmth / w.numbers.ambient);
    const double seen = (end - begin) * 0.05 / (80 * 0.005);
    print_message("a flame of 1 m/s from %.1f to %.1f cells: %.3f m/s; theory %.3f\n", begin, end,
                  seen, lighter);
    assert_true(fabs(seen / lighter - 1) < 0.01);
    pyro_close(&w);
}

static void a_flame_moves_into_mixture_at_its_speed(void **state) {
    check_flame(*state, false);
}

static void and_so_it_does_with_half_the_velocity(void **state) {
    if (sim_long_tests("a flame with half the velocity")) check_flame(*state, true);
}

// ---- warm gas rises ---------------------------------------------------------------------------

static void columns(pyro_world *w, const int c[3], void *data) {
    const float *warmth = data;
    w->gas[pyro_cell_at(w, c)][0] = *warmth * (float)cos(2 * pi * (c[0] + 0.5) / w->desc.size[0]);
}

// Columns that are warm and cold by turns: g dT / T.
static void check_columns(gpu *g, const pyro_desc *desc) {
    pyro_world w;
    pyro_open(&w, g, desc);
    w.numbers.gravity = 9.81f;
    w.numbers.dt = 0.01f;
    float warmth = 3;
    pyro_for_each(&w, columns, &warmth);
    pyro_transfer(&w, true);
    pyro_run_steps(&w, 10);
    pyro_transfer(&w, false);
    const int n = pyro_flow_cells_along(&w, 0);
    double rise = 0;
    for (int x = 0; x < n; x++) {
        const int c[3] = {x, 5, 9};
        rise += 2 * (double)*pyro_face_at(&w, 2, c) * cos(2 * pi * (x + 0.5) / n) / n;
    }
    const double wanted = 9.81 * 3 / 300 * 0.1;
    print_message("rises at %.5f m/s, theory %.5f\n", rise, wanted);
    assert_true(fabs(rise / wanted - 1) < 0.02);
    pyro_close(&w);
}

static void a_warm_column_rises_by_its_warmth(void **state) {
    static const pyro_advection ways[] = {PYRO_UPWIND, PYRO_REFLECTION};
    for (size_t i = 0; i < COUNT_OF(ways); i++)
        check_columns(
            *state,
            &(pyro_desc){.size = {32, 16, 32}, .faces = {3, 3, 3, 3, 3, 3}, .advection = ways[i]});
}

static void and_with_half_the_velocity(void **state) {
    check_columns(*state, &(pyro_desc){.size = {64, 32, 48},
                                       .faces = {PYRO_WALL, PYRO_WALL, PYRO_WALL, PYRO_WALL},
                                       .half_velocity = true});
}

// ---- light gas among heavy gas ------------------------------------------------------------------

static void hot_columns(pyro_world *w, const int c[3], void *data) {
    const float *warmth = data;
    w->gas[pyro_cell_at(w, c)][0] =
        *warmth * (float)(0.5 + 0.5 * cos(2 * pi * (c[0] + 0.5) / w->desc.size[0]));
}

// Hot columns, up to three times as light, that are as high as the box is around: g (1 / r - 1).
static void a_hot_column_rises_by_its_density(void **state) {
    pyro_world w;
    float warmth = 600;
    pyro_open(
        &w, *state,
        &(pyro_desc){.size = {32, 16, 32}, .faces = {3, 3, 3, 3, 3, 3}, .variable_density = true});
    w.numbers.gravity = 9.81f;
    w.numbers.dt = 1e-3f;
    pyro_for_each(&w, hot_columns, &warmth);
    pyro_transfer(&w, true);
    pyro_run_steps(&w, 10);
    pyro_transfer(&w, false);
    double worst = 0;
    for (int x = 0; x < 32; x++) {
        const int c[3] = {x, 5, 9};
        const double wanted = 9.81 * (double)w.gas[pyro_cell_at(&w, c)][0] / 300 * 0.01;
        worst = fmax(worst, fabs((double)*pyro_face_at(&w, 2, c) - wanted));
    }
    print_message("hot columns rise by up to 0.1962 m/s, wrong by %.1e\n", worst);
    assert_true(worst < 5e-4);
    pyro_close(&w);
}

static void light_half(pyro_world *w, const int c[3], void *data) {
    (void)data;
    if (c[0] >= 16) return;
    w->gas[pyro_cell_at(w, c)][0] = 900;
    *pyro_face_at(w, 0, c) = 0.1f;
}

// Half of a tube that is around holds gas a quarter as dense, which moves. Pressure makes all of it
// move alike, by the momentum that there was: each face has the mean mass of two cells.
static void light_gas_pushes_little(void **state) {
    pyro_world w;
    pyro_open(&w, *state,
              &(pyro_desc){.size = {32, 16, 16},
                           .faces = {3, 3, 3, 3, 3, 3},
                           .variable_density = true,
                           .cycles = 8});
    w.numbers.gravity = 0;
    w.numbers.dt = 1e-3f;
    pyro_for_each(&w, light_half, NULL);
    pyro_transfer(&w, true);
    pyro_run_steps(&w, 3);
    pyro_transfer(&w, false);
    const double momentum = 0.1 * (15 * 0.25 + 0.625), mass = 15 * 0.25 + 15 + 2 * 0.625;
    double worst = 0;
    for (int x = 0; x < 32; x++)
        worst = fmax(worst,
                     fabs((double)*pyro_face_at(&w, 0, (int[3]){x, 5, 9}) * mass / momentum - 1));
    print_message("half of a tube is light and moves: all move at %.4f, wrong by %.1e of it\n",
                  momentum / mass, worst);
    assert_true(worst < 0.003);
    pyro_close(&w);
}

static void fill_soot(pyro_world *w, const int c[3], void *data) {
    w->gas[pyro_cell_at(w, c)][3] = *(const float *)data;
}

// What an image lets out of each place flows out of the box, and is the same gas: what is even
// stays.
static void check_outflow(gpu *g, bool half, float each) {
    pyro_world w;
    float soot = 0.01f;
    pyro_open(&w, g,
              &(pyro_desc){.size = {32, 32, 32},
                           .half_velocity = half,
                           .advection = PYRO_PARABOLIC,
                           .force = true,
                           .outflow = true});
    gpu_image *image = gpu_image_create(g, &(gpu_image_desc){.label = "outflow",
                                                             .format = GPU_RGBA32F,
                                                             .width = 1,
                                                             .height = 1,
                                                             .depth = 1,
                                                             .use = GPU_USE_SAMPLED});
    gpu_test_ok(gpu_image_write(g, image, 0, (float[4]){0, 0, 0, each}, 16));
    pyro_set_force(w.solver, image);
    w.numbers.gravity = 0;
    pyro_for_each(&w, fill_soot, &soot);
    pyro_transfer(&w, true);
    pyro_run_steps(&w, 6);
    pyro_transfer(&w, false);
    const int margin = pyro_flow_cells_along(&w, 0) / 4;
    const double expected = (double)each * pow(0.5 * 32 * (double)w.numbers.cell, 3);
    const double seen = outflow(&w, margin);
    const float middle = w.gas[pyro_cell_at(&w, (int[3]){16, 15, 17})][3];
    print_message("%s velocity, %g 1/s: %.5f m^3/s, theory %.5f; soot %.6f of 0.01\n",
                  half ? "half" : "full", (double)each, seen, expected, (double)middle);
    assert_true(fabs(seen / expected - 1) < 6e-5);
    assert_true(fabsf(middle - soot) < 1e-5f * soot);
    gpu_image_destroy(g, image);
    pyro_close(&w);
}

static void gas_comes_from_an_image_and_goes(void **state) {
    check_outflow(*state, true, 3);
    check_outflow(*state, false, -1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gas_comes_from_an_image_and_goes),
        cmocka_unit_test(fuel_burns_as_far_as_oxygen_goes),
        cmocka_unit_test(fuel_burns_at_the_rate_at_which_it_mixes),
        cmocka_unit_test(hot_gas_cools_by_the_fourth_power),
        cmocka_unit_test(heat_makes_room),
        cmocka_unit_test(heat_makes_room_for_half_the_velocity),
        cmocka_unit_test(a_ball_keeps_what_it_has),
        cmocka_unit_test(a_ball_keeps_what_it_has_with_half_the_velocity),
        cmocka_unit_test(clean_air_is_left_as_it_is),
        cmocka_unit_test(a_flame_moves_into_mixture_at_its_speed),
        cmocka_unit_test(and_so_it_does_with_half_the_velocity),
        cmocka_unit_test(a_warm_column_rises_by_its_warmth),
        cmocka_unit_test(and_with_half_the_velocity),
        cmocka_unit_test(a_hot_column_rises_by_its_density),
        cmocka_unit_test(light_gas_pushes_little),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
