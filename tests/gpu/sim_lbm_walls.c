// Boundaries of a solver against theory: channels, plates that slide, cylinders that turn.
#include "long_test.h"
#include "sim_bodies_test.h"

// ---- channels ---------------------------------------------------------------------------------

// Greatest error of the velocity along `flow` across `across`, over the greatest of `theory`, which
// is given the distance from the lower wall as part of the channel's width. `wall` is the last cell
// of the lower wall; `skip` cells beside it are passed over.
static double profile_error(sim_world *w, int flow, int across, int wall, int skip, int width,
                            double (*theory)(double at)) {
    double error = 0, most = 0;
    sim_read(w);
    for (int i = skip; i < width; i++) {
        int at[3] = {2, 2, 2};
        at[across] = wall + 1 + i;
        double seen = w->state[sim_index(w, at[0], at[1], at[2])].u[flow] +
                      0.5 * (double)w->numbers.acceleration[flow];
        double wanted = theory((i + 0.5) / width);
        error = fmax(error, fabs(seen - wanted));
        most = fmax(most, fabs(wanted));
    }
    return error / most;
}

static const double channel_speed = 0.05;

static double parabola(double at) {
    return channel_speed * 4 * at * (1 - at);
}

// Flow between two walls under a force: Poiseuille. Halves are tried in a narrower channel: what
// the force adds in a step goes with the square of the width, and in a steady flow it is rounded
// the same way each time.
static double channel_error(gpu *g, int across, lbm_desc desc) {
    sim_world w;
    const int flow = across == 0 ? 1 : 0, low[3] = {4, 4, 16};
    const int cells = desc.precision == LBM_F16 ? 16 : 24, width = cells - 2;
    for (int k = 0; k < 3; k++) desc.size[k] = (uint32_t)low[k];
    desc.size[across] = (uint32_t)cells;
    desc.faces[2 * across] = desc.faces[2 * across + 1] = LBM_WALL;
    sim_open(&w, g, &desc);
    w.numbers.tau = 0.9f;
    double viscosity = ((double)w.numbers.tau - 0.5) / 3;
    w.numbers.acceleration[flow] = (float)(8 * viscosity * channel_speed / (width * width));
    sim_reset(&w);
    sim_run(&w, 10 * width * width); // what is not steady is down to 2e-6
    double error = profile_error(&w, flow, across, 0, 0, width, parabola);
    sim_close(&w);
    return error;
}

static void a_channel_flows_as_a_parabola(void **state) {
    static const char *const ways[] = {"BGK", "TRT", "moments"};
    const bool all = sim_long_tests("each way of collision across each axis");
    static const double bounds[2][3] = {{9e-4, 3.6e-5, 4e-4}, {0.05, 0.05, 0.05}};
    for (int half = 0; half < 2; half++)
        for (int across = 0; across < 3; across++)
            for (int way = 0; way < 3; way++) {
                if (way != across && !all) continue;
                const lbm_desc desc = {.set = across == 1 ? LBM_D3Q27 : LBM_D3Q19,
                                       .collision = (lbm_collision)way,
                                       .precision = half ? LBM_F16 : LBM_F32};
                double error = channel_error(*state, across, desc);
                print_message("channel across %c, %s%s: %.4f %%\n", "xyz"[across], ways[way],
                              half ? ", halves" : "", 100 * error);
                assert_true(error < bounds[half][way]);
            }
}

// ---- plates -----------------------------------------------------------------------------------

static double line(double at) {
    return channel_speed * (1 - at);
}

static int plate(const float p[3], const void *user) {
    (void)user;
    return p[2] < 3;
}

// A plate that slides in itself below a wall: Couette.
static void a_plate_drags_the_air_along(void **state) {
    sim_world w;
    sim_bodies b;
    sim_open(&w, *state,
             &(lbm_desc){.size = {8, 4, 24},
                         .collision = LBM_TRT,
                         .faces = {[4] = LBM_WALL, [5] = LBM_WALL},
                         .bodies = true});
    sim_bodies_open(&w, &b);
    sim_reset(&w);
    b.body[0].linear[0] = (float)channel_speed;
    gpu_test_ok(gpu_frame_begin(w.device));
    sim_bodies_set(&w, &b, plate, NULL);
    gpu_test_ok(gpu_frame_end(w.device));
    sim_run(&w, 8000);
    // What a wall pushes is not yet in what arrives beside it.
    double error = profile_error(&w, 0, 2, 2, 1, 20, line);
    print_message("plate: %.4f %%\n", 100 * error);
    assert_true(error < 2e-5); // rounding's
    sim_bodies_close(&w, &b);
    sim_close(&w);
}

// ---- cylinders --------------------------------------------------------------------------------

enum { ROUND = 48, TURNS = 1, STANDS = 2 }; // cells; ids
static const double inner = 8, outer = 21, middle = 24.2;

static double from_axis(const float p[3]) {
    return hypot((double)p[0] - middle, (double)p[2] - middle);
}

static int between_cylinders(const float p[3], const void *user) {
    (void)user;
    return from_axis(p) < inner ? TURNS : from_axis(p) > outer ? STANDS : 0;
}

// Around the axis, relative to that of the inner cylinder's surface: Couette's in the round.
static double turning(double r) {
    return inner / (outer * outer - inner * inner) * (outer * outer / r - r);
}

// A cylinder that turns within one that stands takes the air along, wherever its surface goes.
static void a_cylinder_turns_the_air(void **state) {
    sim_world w;
    sim_bodies b;
    double error = 0;
    sim_open(&w, *state,
             &(lbm_desc){.size = {ROUND, 4, ROUND}, .collision = LBM_TRT, .bodies = true});
    sim_bodies_open(&w, &b);
    w.numbers.tau = 0.9f;
    sim_reset(&w);
    b.body[TURNS - 1] = (lbm_body){.centre = {(float)middle, 2, (float)middle},
                                   .angular = {0, (float)(channel_speed / inner), 0}};
    gpu_test_ok(gpu_frame_begin(w.device));
    sim_bodies_set(&w, &b, between_cylinders, NULL);
    gpu_test_ok(gpu_frame_end(w.device));
    sim_run(&w, 3000);
    sim_read(&w);
    for (size_t i = 0; i < w.cells; i++) {
        float p[3];
        sim_centre(&w, i, p);
        double r = from_axis(p), x = (double)p[0] - middle, z = (double)p[2] - middle;
        if (r < inner + 2 || r > outer - 2) continue; // surfaces are stairs of cells
        const double *u = w.state[i].u, wanted = turning(r);
        error = fmax(error, fabs((u[0] * z - u[2] * x) / r / channel_speed - wanted));
        error = fmax(error, fabs(u[0] * x + u[2] * z) / r / channel_speed);
        error = fmax(error, fabs(u[1]) / channel_speed);
    }
    print_message("cylinder: within %.2f %% of its speed\n", 100 * error);
    assert_true(error < 0.04);
    sim_bodies_close(&w, &b);
    sim_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_channel_flows_as_a_parabola),
        cmocka_unit_test(a_plate_drags_the_air_along),
        cmocka_unit_test(a_cylinder_turns_the_air),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
