// What stands in the way of air, and what must never happen.
#include "flow_test.h"

typedef float quad[4];
enum { WIDE = 64, HIGH = 32 };

// A duct that is blown through at 1 m/s from the left, its cells 1/64 m.
static void open_duct(flow_world *w, gpu *g, flow_advection advection) {
    flow_open(w, g,
              &(flow_desc){.size = {WIDE, HIGH},
                           .slices = 1,
                           .faces = {FLOW_CLOSED, FLOW_OPEN, FLOW_CLOSED, FLOW_CLOSED},
                           .advection = advection,
                           .solver = FLOW_MULTIGRID,
                           .sources = true,
                           .obstacles = true,
                           .max_iterations = 20});
    w->numbers.wall_velocity[0][0] = 1;
    w->numbers.dt = 1.0f / 64;
    w->numbers.tolerance = 1e-5f;
}

// Dye is held at 1 in the first cells of the duct.
static void put_dye(flow_world *w) {
    float(*sources)[12] = mem_alloc(w->cells * sizeof *sources);
    for (size_t i = 0; i < w->cells; i++) sources[i][2] = sources[i][6] = i % WIDE < 3;
    flow_write_input(w, "FlowSources", sources, sizeof *sources);
    mem_free(sources);
}

static double flux_through(flow_world *w, int x) {
    double sum = 0;
    for (int y = 0; y < HIGH; y++) sum += (double)*flow_face_at(w, x, y, 0, 0);
    return sum;
}

static bool in_disc(int x, int y) {
    const int u = x - 20, v = y - 15;
    return u * u + v * v < 50;
}

static void air_flows_around_what_stands_still(void **state) {
    flow_world w;
    open_duct(&w, *state, FLOW_MACCORMACK);
    quad *solids = mem_alloc(w.cells * sizeof *solids);
    for (size_t i = 0; i < w.cells; i++) solids[i][0] = in_disc((int)(i % WIDE), (int)(i / WIDE));
    flow_write_input(&w, "FlowObstacles", solids, sizeof *solids);
    put_dye(&w);
    flow_run_steps(&w, 80);
    flow_transfer(&w, false);
    double through = 0, inside = 0, fastest = 0;
    for (int y = 0; y < HIGH; y++)
        for (int x = 1; x < WIDE; x++) {
            const double u = fabs((double)*flow_face_at(&w, x, y, 0, 0));
            if (in_disc(x, y) || in_disc(x - 1, y)) through = fmax(through, u);
            if (in_disc(x, y)) inside += (double)w.scalars[y * WIDE + x][2];
            if (x == 20) fastest = fmax(fastest, u);
        }
    print_message("past a disc: at most %.3f m/s beside it, %.1e through it, dye behind it %.3f\n",
                  fastest, through, (double)w.scalars[15 * WIDE + 50][2]);
    assert_true(through == 0 && inside == 0);
    assert_true(fabs(flux_through(&w, 20) / HIGH - 1) < 1e-3 && fastest > 1.4);
    assert_true(fabs(flux_through(&w, WIDE) / HIGH - 1) < 1e-3);
    mem_free(solids);
    flow_close(&w);
}

// A wall from end to end, its height but for a few cells: what dye passes goes through the gap.
static void nothing_passes_a_wall(void **state) {
    flow_world w;
    open_duct(&w, *state, FLOW_SEMI_LAGRANGIAN);
    quad *solids = mem_alloc(w.cells * sizeof *solids);
    for (size_t i = 0; i < w.cells; i++) solids[i][0] = i % WIDE == 30 && i / WIDE > 1;
    flow_write_input(&w, "FlowObstacles", solids, sizeof *solids);
    put_dye(&w);
    // Too short for what comes through the gap, which goes faster, to reach the upper half.
    flow_run_steps(&w, 34);
    flow_transfer(&w, false);
    double before = 0, behind = 0;
    for (int y = HIGH / 2; y < HIGH; y++)
        for (int x = 24; x < 34; x++)
            *(x < 30 ? &before : &behind) += (double)w.scalars[y * WIDE + x][2];
    print_message("a wall: dye %.3f before it, %.2e behind it\n", before, behind);
    assert_true(before > 1 && behind < 1e-3 * before);
    mem_free(solids);
    flow_close(&w);
}

// A piston from wall to wall in a tube that is open at both ends: all air goes as fast as it does,
// and what is before it stays there.
static void a_piston_pushes_all_air(void **state) {
    flow_world w;
    flow_open(&w, *state,
              &(flow_desc){.size = {WIDE, HIGH},
                           .slices = 1,
                           .faces = {FLOW_OPEN, FLOW_OPEN, FLOW_CLOSED, FLOW_CLOSED},
                           .solver = FLOW_MULTIGRID,
                           .obstacles = true,
                           .max_iterations = 20});
    w.numbers.tolerance = 1e-6f;
    w.numbers.dt = 1.0f / 128; // half a cell
    flow_transfer(&w, false);
    for (size_t i = 0; i < w.cells; i++) w.scalars[i][2] = i % WIDE > 21;
    flow_transfer(&w, true);
    quad *solids = mem_alloc(w.cells * sizeof *solids);
    const int steps = 32, wide = 6;
    for (int step = 0; step < steps; step++) {
        for (size_t i = 0; i < w.cells; i++) {
            const int from = 16 + step / 2, x = (int)(i % WIDE);
            const bool is = x >= from && x < from + wide;
            solids[i][0] = is;
            solids[i][1] = is ? 1 : 0;
        }
        flow_write_input(&w, "FlowObstacles", solids, sizeof *solids);
        flow_run_steps(&w, 1);
    }
    flow_transfer(&w, false);
    double off = 0, dye[2] = {0};
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) {
            off = fmax(off, fabs((double)*flow_face_at(&w, x, y, 0, 0) - 1));
            dye[x > 32] += (double)w.scalars[y * WIDE + x][2];
        }
    print_message("a piston: velocities off by %.1e, dye %.1f before it, %.2e behind it\n", off,
                  dye[1], dye[0]);
    assert_true(off < 1e-5 && dye[1] > 20 * HIGH && dye[0] < 1e-3 * dye[1]);
    mem_free(solids);
    flow_close(&w);
}

// ---- what is kept -----------------------------------------------------------------------------

// Dye in a closed box that is stirred by what rises in it: of what was there at first.
static double dye_left(gpu *g, flow_advection advection) {
    flow_world w;
    flow_open(&w, g,
              &(flow_desc){
                  .size = {64, 64}, .slices = 1, .advection = advection, .solver = FLOW_MULTIGRID});
    w.numbers.buoyancy[1] = 4;
    w.numbers.vorticity = 2;
    flow_transfer(&w, false);
    double before = 0, after = 0;
    for (size_t i = 0; i < w.cells; i++) {
        const double x = (double)(i % 64) - 31.5, y = (double)(i / 64) - 16;
        w.scalars[i][1] = w.scalars[i][2] = (float)exp(-(x * x + y * y) / 60);
        before += (double)w.scalars[i][2];
    }
    flow_transfer(&w, true);
    flow_run_steps(&w, 60);
    flow_transfer(&w, false);
    double speed = 0, most = 0;
    for (size_t i = 0; i < w.cells; i++) {
        after += (double)w.scalars[i][2];
        most = fmax(most, (double)w.scalars[i][2]);
        assert_true(w.scalars[i][2] >= 0);
    }
    for (size_t i = 0; i < w.corners; i++) speed = fmax(speed, fabs((double)w.velocity[i][1]));
    print_message("stirred for a second: %.4f of the dye is left, at most %.3f, at %.2f m/s\n",
                  after / before, most, speed);
    assert_true(speed > 0.4 && most <= 1 && most > 0.4);
    flow_close(&w);
    return after / before;
}

static void dye_is_neither_made_nor_lost(void **state) {
    assert_true(fabs(dye_left(*state, FLOW_SEMI_LAGRANGIAN) - 1) < 0.05);
    assert_true(fabs(dye_left(*state, FLOW_MACCORMACK) - 1) < 0.02);
}

// ---- all at once ------------------------------------------------------------------------------

// Everything there is, fed with what `wild` makes no sense of; every step.
static void run_all(flow_world *w, gpu *g, bool wild) {
    flow_open(w, g,
              &(flow_desc){.size = {48, 80},
                           .slices = 3,
                           .faces = {FLOW_OPEN, FLOW_CLOSED, FLOW_CLOSED, FLOW_OPEN},
                           .advection = FLOW_MACCORMACK,
                           .solver = FLOW_MULTIGRID,
                           .sources = true,
                           .obstacles = true,
                           .templates = true});
    w->numbers.vorticity = wild ? 1e20f : 2;
    w->numbers.viscosity = wild ? 1e20f : 0.01f;
    w->numbers.buoyancy[1] = wild ? 1e30f : 1;
    w->numbers.friction = 1;
    float(*sources)[12] = mem_alloc(w->cells * sizeof *sources);
    float(*templates)[2] = mem_alloc(w->cells * sizeof *templates);
    quad *solids = mem_alloc(w->cells * sizeof *solids);
    const float bad[] = {NAN, INFINITY, -INFINITY, 3e38f};
    for (size_t i = 0; i < w->cells; i++) {
        const size_t x = i % 48, y = i / 48 % 80;
        if (y < 6) sources[i][1] = sources[i][5] = 0.5f + 0.01f * (float)(x + i / 3840);
        sources[i][9] = 0.001f * (float)(x % 7);
        solids[i][0] = x > 20 && x < 28 && y > 30 && y < 40;
        solids[i][1] = 0.2f;
        templates[i][0] = x > 8 && x < 16 && y > 50 && y < 60 ? 0.9f : 0;
        templates[i][1] = 0.1f;
        if (!wild || i % 97 > 0) continue;
        for (int k = 0; k < 12; k++) sources[i][k] = bad[(i + (size_t)k) % 4];
        for (int k = 0; k < 4; k++) solids[i][k] = bad[(i + (size_t)k) % 4];
        for (int k = 0; k < 2; k++) templates[i][k] = bad[(i + (size_t)k) % 4];
    }
    flow_write_input(w, "FlowSources", sources, sizeof *sources);
    flow_write_input(w, "FlowObstacles", solids, sizeof *solids);
    flow_write_input(w, "FlowTemplates", templates, sizeof *templates);
    flow_run_steps(w, 12);
    flow_transfer(w, false);
    mem_free(sources);
    mem_free(templates);
    mem_free(solids);
}

static void the_same_comes_out_twice(void **state) {
    flow_world a, b;
    run_all(&a, *state, false);
    run_all(&b, *state, false);
    assert_memory_equal(a.velocity, b.velocity, a.corners * sizeof *a.velocity);
    assert_memory_equal(a.scalars, b.scalars, a.cells * sizeof *a.scalars);
    assert_memory_equal(a.pressure, b.pressure, a.cells * sizeof *a.pressure);
    double sum = 0;
    for (size_t i = 0; i < a.cells; i++) sum += fabs((double)a.pressure[i]);
    assert_true(sum > 0);
    // Slices do not know of each other: the third was given more heat than the first.
    assert_true(a.scalars[2 * 3840 + 10][1] > a.scalars[10][1]);
    flow_close(&a);
    flow_close(&b);
}

static void what_is_no_number_goes_nowhere(void **state) {
    flow_world w;
    run_all(&w, *state, true);
    for (size_t i = 0; i < w.corners; i++)
        for (int k = 0; k < 2; k++) assert_true(isfinite(w.velocity[i][k]));
    for (size_t i = 0; i < w.cells; i++) {
        for (int k = 0; k < 4; k++) assert_true(isfinite(w.scalars[i][k]));
        assert_true(isfinite(w.pressure[i]));
    }
    flow_close(&w);
}

// ---- interface --------------------------------------------------------------------------------

static void wrong_structures_are_refused(void **state) {
    (void)state;
    arena memory = {0};
    static const struct {
        flow_desc desc;
        const char *says;
    } rows[] = {
        {{.size = {8, 64}, .slices = 1}, "16 to 2048"},
        {{.size = {64, 64}, .slices = 0}, "0 slices"},
        {{.size = {64, 64}, .slices = 1, .faces = {FLOW_PERIODIC}}, "along x is periodic"},
        {{.size = {64, 80}, .slices = 1, .faces = {[2] = FLOW_PERIODIC, FLOW_PERIODIC}},
         "a power of two"},
    };
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        assert_null(flow_create(&memory, &rows[i].desc));
        assert_non_null(strstr(err_get(), rows[i].says));
    }
    arena_free(&memory);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(air_flows_around_what_stands_still),
        cmocka_unit_test(nothing_passes_a_wall),
        cmocka_unit_test(a_piston_pushes_all_air),
        cmocka_unit_test(dye_is_neither_made_nor_lost),
        cmocka_unit_test(the_same_comes_out_twice),
        cmocka_unit_test(what_is_no_number_goes_nowhere),
        cmocka_unit_test(wrong_structures_are_refused),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
