// The projection: what divergence is left, with and without obstacles; what templates make.
#include "flow_test.h"
#include "long_test.h"

static float noise(uint32_t *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) / 8388608.0f - 1;
}

// Velocities so small that hardly anything is carried in a step: what is projected is known.
static void stir(flow_world *w) {
    uint32_t seed = 1;
    const int *n = (const int *)w->desc.size;
    flow_transfer(w, false);
    for (int slice = 0; slice < (int)w->desc.slices; slice++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++)
                for (int axis = 0; axis < 2; axis++)
                    if ((axis ? y : x) > 0 || w->desc.faces[2 * axis] != FLOW_CLOSED)
                        *flow_face_at(w, x, y, slice, axis) = 1e-4f * noise(&seed);
    flow_transfer(w, true);
}

// The square root of the sum of squares.
static double divergence_of(flow_world *w) {
    double sum = 0;
    for (int slice = 0; slice < (int)w->desc.slices; slice++)
        for (int y = 0; y < (int)w->desc.size[1]; y++)
            for (int x = 0; x < (int)w->desc.size[0]; x++)
                sum += pow(flow_divergence(w, x, y, slice), 2);
    return sqrt(sum);
}

static flow_report look_at(flow_world *w) {
    flow_report report = {0};
    gpu_test_ok(gpu_frame_begin(w->device));
    gpu_test_ok(flow_watch(w->flow, w->device));
    gpu_test_ok(gpu_frame_end(w->device));
    gpu_test_ok(gpu_idle(w->device));
    assert_true(flow_read(w->flow, w->device, &report));
    assert_int_equal(report.step, flow_steps(w->flow));
    return report;
}

// What is left of the divergence, as a part; that at the start is known but for what one step of
// advection changes, which is far less than the bounds.
static void divergence_vanishes(void **state) {
    static const struct {
        uint32_t size[2];
        flow_face faces[4];
        flow_solver solver;
        uint32_t sweeps, most; // iterations
    } rows[] = {
        {{64, 128},
         {FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC},
         FLOW_MULTIGRID,
         2,
         4},
        {{72, 50}, {FLOW_CLOSED, FLOW_OPEN, FLOW_CLOSED, FLOW_OPEN}, FLOW_MULTIGRID, 1, 6},
        {{72, 50}, {FLOW_CLOSED, FLOW_OPEN, FLOW_CLOSED, FLOW_OPEN}, FLOW_TRANSFORM, 1, 2},
        {{40, 300}, {FLOW_OPEN, FLOW_CLOSED, FLOW_OPEN, FLOW_OPEN}, FLOW_TRANSFORM, 1, 2},
        {{40, 48}, {FLOW_OPEN, FLOW_OPEN, FLOW_CLOSED, FLOW_OPEN}, FLOW_CG, 0, 200},
        {{64, 128}, // from here on: long tests
         {FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC},
         FLOW_TRANSFORM,
         1,
         2},
        {{72, 50}, {FLOW_CLOSED, FLOW_CLOSED, FLOW_CLOSED, FLOW_CLOSED}, FLOW_MULTIGRID, 1, 5},
        {{96, 64}, {FLOW_CLOSED, FLOW_OPEN, FLOW_CLOSED, FLOW_OPEN}, FLOW_MULTIGRID, 2, 4},
        {{72, 50}, {FLOW_CLOSED, FLOW_CLOSED, FLOW_CLOSED, FLOW_CLOSED}, FLOW_TRANSFORM, 1, 2},
        {{64, 32}, {FLOW_OPEN, FLOW_OPEN, FLOW_PERIODIC, FLOW_PERIODIC}, FLOW_TRANSFORM, 1, 2},
        {{32, 32}, {FLOW_PERIODIC, FLOW_PERIODIC, FLOW_CLOSED, FLOW_CLOSED}, FLOW_CG, 0, 200},
    };
    enum { USUAL = 5 };
    const bool all = sim_long_tests("more grids for each way to find the pressure");
    for (size_t i = 0; i < (all ? COUNT_OF(rows) : USUAL); i++) {
        flow_world w;
        flow_desc desc = {.slices = 2,
                          .solver = rows[i].solver,
                          .sweeps = rows[i].sweeps,
                          .max_iterations = rows[i].most};
        memcpy(desc.size, rows[i].size, sizeof desc.size);
        memcpy(desc.faces, rows[i].faces, sizeof desc.faces);
        flow_open(&w, *state, &desc);
        w.numbers.tolerance = 5e-5f;
        stir(&w);
        const double before = divergence_of(&w);
        flow_run_steps(&w, 1);
        const flow_report report = look_at(&w);
        flow_transfer(&w, false);
        const double left = divergence_of(&w) / before;
        print_message("%ux%u: %.1e left after %u iterations, residual %.1e\n", desc.size[0],
                      desc.size[1], left, report.iterations, (double)report.residual);
        assert_true(left < 1e-4 && report.residual <= w.numbers.tolerance);
        const uint32_t least = desc.solver == FLOW_TRANSFORM ? 1 : 2;
        assert_true(report.iterations >= least && report.iterations <= rows[i].most);
        flow_close(&w);
    }
}

// ---- obstacles --------------------------------------------------------------------------------

enum { SIDE = 96 };

// A maze: thin walls with narrow gaps, and discs; what multigrid's coarse levels cannot see.
static bool in_maze(int x, int y) {
    if (x % 24 == 11 && y % 32 > 2) return true;
    const int u = x % 32 - 20, v = y % 24 - 12;
    return u * u + v * v < 20;
}

static void a_maze_takes_a_few_iterations_more(void **state) {
    flow_world w;
    flow_open(&w, *state,
              &(flow_desc){.size = {SIDE, SIDE},
                           .slices = 1,
                           .solver = FLOW_MULTIGRID,
                           .faces = {[3] = FLOW_OPEN},
                           .obstacles = true,
                           .max_iterations = 30});
    float(*solids)[4] = mem_alloc(w.cells * sizeof *solids);
    for (size_t i = 0; i < w.cells; i++) solids[i][0] = in_maze((int)(i % SIDE), (int)(i / SIDE));
    flow_write_input(&w, "FlowObstacles", solids, sizeof *solids);
    w.numbers.tolerance = 3e-5f;
    stir(&w);
    const double before = divergence_of(&w);
    flow_run_steps(&w, 1);
    const flow_report report = look_at(&w);
    flow_transfer(&w, false);
    print_message("a maze: %.1e left after %u iterations\n", divergence_of(&w) / before,
                  report.iterations);
    assert_true(divergence_of(&w) / before < 1e-4 && report.iterations <= 20);
    mem_free(solids);
    flow_close(&w);
}

// ---- templates --------------------------------------------------------------------------------

static void open_box(flow_world *w, gpu *g, flow_solver solver) {
    flow_open(w, g,
              &(flow_desc){.size = {64, 64},
                           .slices = 1,
                           .solver = solver,
                           .faces = {FLOW_OPEN, FLOW_OPEN, FLOW_OPEN, FLOW_OPEN},
                           .templates = true,
                           .sources = true,
                           .max_iterations = solver == FLOW_MULTIGRID ? 10 : 0});
    w->numbers.tolerance = 1e-5f;
}

static double distance(const flow_world *w, int x, int y) {
    return hypot(x + 0.5 - w->desc.size[0] / 2.0, y + 0.5 - w->desc.size[1] / 2.0);
}

// A disc of raised or lowered pressure in the middle, with a border that is a Gaussian.
static void put_template(flow_world *w, float pressure) {
    float(*t)[2] = mem_alloc(w->cells * sizeof *t);
    for (size_t i = 0; i < w->cells; i++) {
        const double r = distance(w, (int)(i % 64), (int)(i / 64)) / 8;
        if (r >= 1) continue;
        t[i][0] = (float)exp(-4 * r * r);
        t[i][1] = pressure;
    }
    flow_write_input(w, "FlowTemplates", t, sizeof *t);
    mem_free(t);
}

// Through the faces of the square of cells that are less than `half` from the middle.
static double flux_out_of(flow_world *w, int half) {
    double sum = 0;
    for (int i = 32 - half; i < 32 + half; i++) {
        sum += (double)*flow_face_at(w, 32 + half, i, 0, 0);
        sum -= (double)*flow_face_at(w, 32 - half, i, 0, 0);
        sum += (double)*flow_face_at(w, i, 32 + half, 0, 1);
        sum -= (double)*flow_face_at(w, i, 32 - half, 0, 1);
    }
    return sum;
}

static double made_inside(flow_world *w) {
    double sum = 0;
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++)
            if (distance(w, x, y) < 8) sum += flow_divergence(w, x, y, 0);
    return sum;
}

static double template_flux(gpu *g, flow_solver solver, float pressure) {
    flow_world w;
    open_box(&w, g, solver);
    put_template(&w, pressure);
    flow_run_steps(&w, 4);
    flow_transfer(&w, false);
    const double made = made_inside(&w), near = flux_out_of(&w, 10), far = flux_out_of(&w, 30);
    print_message("a template of %+g m^2/s^2 makes %.5f, %.5f and %.5f pass rings around it\n",
                  (double)pressure, made, near, far);
    assert_true(fabs(near - made) < 2e-4 * fabs(made) && fabs(far - made) < 2e-4 * fabs(made));
    // In the middle, where alpha is 1, the pressure is the template's.
    const double unit = (double)(w.numbers.dt / w.numbers.cell);
    const double middle = (double)w.pressure[32 * 64 + 32] / unit;
    assert_true(fabs(middle / (double)pressure - 1) < 0.02);
    flow_close(&w);
    return made;
}

static void a_raised_pressure_is_a_source_a_lowered_one_a_sink(void **state) {
    const double source = template_flux(*state, FLOW_MULTIGRID, 0.01f);
    const double sink = template_flux(*state, FLOW_MULTIGRID, -0.01f);
    const double published = template_flux(*state, FLOW_CG, 0.01f);
    assert_true(source > 0.05 && sink < -0.05);
    assert_true(fabs(source - published) < 1e-3 * source);
}

// A force that pushes away from the middle has divergence, one that turns around it has none: of
// the former nothing is left, of the latter all.
static double pushed_speed(gpu *g, bool turning, double *divergence) {
    flow_world w;
    open_box(&w, g, FLOW_MULTIGRID);
    float(*sources)[12] = mem_alloc(w.cells * sizeof *sources);
    for (size_t i = 0; i < w.cells; i++) {
        const int x = (int)(i % 64), y = (int)(i / 64);
        const double r = distance(&w, x, y) / 8, push = 0.01 * exp(-r * r);
        const double u = (x + 0.5 - 32) / 8, v = (y + 0.5 - 32) / 8;
        sources[i][8] = (float)(push * (turning ? -v : u));
        sources[i][9] = (float)(push * (turning ? u : v));
    }
    flow_write_input(&w, "FlowSources", sources, sizeof *sources);
    flow_run_steps(&w, 1);
    flow_transfer(&w, false);
    double speed = 0;
    for (size_t i = 0; i < w.corners; i++) speed = fmax(speed, fabs((double)w.velocity[i][0]));
    *divergence = divergence_of(&w);
    mem_free(sources);
    flow_close(&w);
    return speed;
}

static void divergence_that_a_velocity_template_makes_is_removed(void **state) {
    double out_left, turn_left;
    const double most = 0.01 * sqrt(0.5) * exp(-0.5); // that is pushed
    const double out = pushed_speed(*state, false, &out_left);
    const double turn = pushed_speed(*state, true, &turn_left);
    print_message(
        "of %.5f m/s pushed outwards %.5f are left, turning %.5f; divergence %.1e, %.1e\n", most,
        out, turn, out_left, turn_left);
    assert_true(out < 0.002 * most && turn > 0.987 * most);
    assert_true(out_left < 1e-4 * most && turn_left < 1e-4 * most);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(divergence_vanishes),
        cmocka_unit_test(a_maze_takes_a_few_iterations_more),
        cmocka_unit_test(a_raised_pressure_is_a_source_a_lowered_one_a_sink),
        cmocka_unit_test(divergence_that_a_velocity_template_makes_is_removed),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
