// What acts on air and what carries it, where theory says the result to a part of a percent: waves
// of shear, warm columns, vortices that confinement winds up, dye in a wind.
#include "flow_test.h"

static const double pi = 3.14159265358979323846;
enum { SIDE = 64 };

static void open_periodic(flow_world *w, gpu *g, flow_advection advection) {
    flow_open(w, g,
              &(flow_desc){.size = {SIDE, SIDE},
                           .slices = 1,
                           .faces = {FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC, FLOW_PERIODIC},
                           .advection = advection,
                           .solver = FLOW_MULTIGRID});
    w->numbers.dt = 1.0f / 128;
    flow_transfer(w, false);
}

// ---- waves of shear ---------------------------------------------------------------------------

// Air that goes along itself alone: nothing is carried anywhere, and no advection blurs it. So the
// wave decays by its viscosity and nothing else. Its amplitude, of 1 at first.
static double wave_left(gpu *g, flow_advection advection, int axis, float viscosity, int steps) {
    flow_world w;
    open_periodic(&w, g, advection);
    w.numbers.viscosity = viscosity;
    double sum = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const double wave = sin(2 * pi * ((axis ? x : y) + 0.5) / SIDE);
                float *v = flow_face_at(&w, x, y, 0, axis);
                if (pass == 0)
                    *v = (float)wave;
                else
                    sum += (double)*v * wave;
            }
        if (pass == 1) break;
        flow_transfer(&w, true);
        flow_run_steps(&w, steps);
        flow_transfer(&w, false);
    }
    flow_close(&w);
    return 2 * sum / (SIDE * SIDE);
}

static void waves_of_shear_decay_by_their_viscosity(void **state) {
    static const struct {
        const char *name;
        flow_advection advection;
        int axis;
        float viscosity;
        int steps;
        double bound;
    } rows[] = {
        {"semi-Lagrangian, along x", FLOW_SEMI_LAGRANGIAN, 0, 0.006f, 128, 5e-4},
        {"semi-Lagrangian, along y, in stages", FLOW_SEMI_LAGRANGIAN, 1, 0.05f, 64, 0.008},
        {"MacCormack, along y", FLOW_MACCORMACK, 1, 0.006f, 128, 5e-4},
        {"MacCormack, along x, in stages", FLOW_MACCORMACK, 0, 0.05f, 64, 0.008},
    };
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        const double left =
            wave_left(*state, rows[i].advection, rows[i].axis, rows[i].viscosity, rows[i].steps);
        const double wanted = exp(-4 * pi * pi * (double)rows[i].viscosity * rows[i].steps / 128.0);
        const double rate = log(left) / log(wanted);
        print_message("%s: %.4f are left (theory %.4f), rate off by %.3f %%\n", rows[i].name, left,
                      wanted, 100 * (rate - 1));
        assert_true(fabs(rate - 1) < rows[i].bound);
    }
}

// ---- warm columns -----------------------------------------------------------------------------

// Columns of warm (or thick) air and of cold air beside each other, so broad that they slow each
// other down little: a rise of b T at first. Then b T (exp(-c t) - exp(-n k^2 t)) / (n k^2 - c), if
// the warmth goes with a rate c, n the viscosity.
static double column_error(gpu *g, flow_advection advection, int scalar) {
    flow_world w;
    enum { STEPS = 96 };
    const double lift = scalar ? 2 : -1.5, cooling = 0.8, viscosity = 0.006;
    const double time = STEPS / 128.0, drag = viscosity * 4 * pi * pi;
    open_periodic(&w, g, advection);
    w.numbers.viscosity = (float)viscosity;
    w.numbers.buoyancy[scalar] = (float)lift;
    w.numbers.buoyancy[1 - scalar] = 5; // of what there is nothing of
    w.numbers.decay[scalar] = (float)cooling;
    for (int i = 0; i < SIDE * SIDE; i++)
        w.scalars[i][scalar] = (float)(0.3 * cos(2 * pi * (i % SIDE + 0.5) / SIDE));
    flow_transfer(&w, true);
    flow_run_steps(&w, STEPS);
    flow_transfer(&w, false);
    const double wanted =
        0.3 * lift * (exp(-cooling * time) - exp(-drag * time)) / (drag - cooling);
    double error = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const double there = wanted * cos(2 * pi * (x + 0.5) / SIDE);
            error = fmax(error, fabs((double)*flow_face_at(&w, x, y, 0, 1) - there));
            error = fmax(error, fabs((double)*flow_face_at(&w, x, y, 0, 0)));
        }
    flow_close(&w);
    return error / fabs(wanted);
}

static void warm_columns_rise_and_heavy_ones_sink(void **state) {
    for (int way = 0; way < 2; way++)
        for (int scalar = 0; scalar < 2; scalar++) {
            const double error = column_error(*state, (flow_advection)way, scalar);
            print_message("columns of %s, %s: off by %.3f %%\n", scalar ? "heat" : "smoke",
                          way ? "MacCormack" : "semi-Lagrangian", 100 * error);
            assert_true(error < 0.012);
        }
}

// ---- dye in a wind ----------------------------------------------------------------------------

// A blob in a wind that a force makes faster and faster: in each step it goes as far as the wind
// before the step does.
static void dye_goes_as_far_as_the_wind(void **state) {
    for (int way = 0; way < 2; way++) {
        flow_world w;
        enum { STEPS = 64 };
        const double wind[2] = {0.3, -0.2}, force[2] = {-0.4, 0.6};
        open_periodic(&w, *state, (flow_advection)way);
        for (int k = 0; k < 2; k++) w.numbers.acceleration[k] = (float)force[k];
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const double u = x - 31.5, v = y - 31.5;
                w.scalars[y * SIDE + x][2] = (float)exp(-(u * u + v * v) / 50);
                for (int k = 0; k < 2; k++) *flow_face_at(&w, x, y, 0, k) = (float)wind[k];
            }
        flow_transfer(&w, true);
        flow_run_steps(&w, STEPS);
        flow_transfer(&w, false);
        double sum = 0, at[2] = {0}, speed = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double dye = (double)w.scalars[i][2];
            sum += dye, at[0] += dye * (i % SIDE - 31.5), at[1] += dye * (i / SIDE - 31.5);
            for (int k = 0; k < 2; k++)
                speed = fmax(speed, fabs((double)*flow_face_at(&w, i % SIDE, i / SIDE, 0, k) -
                                         wind[k] - force[k] * STEPS / 128.0));
        }
        double off = 0;
        for (int k = 0; k < 2; k++) {
            const double way_gone =
                wind[k] * STEPS / 128.0 + force[k] * STEPS * (STEPS - 1) / 2.0 / (128.0 * 128.0);
            off = fmax(off, fabs(at[k] / sum - SIDE * way_gone));
        }
        print_message("dye in a wind, %s: off by %.5f cells, speed off by %.1e m/s\n",
                      way ? "MacCormack" : "semi-Lagrangian", off, speed);
        assert_true(off < 6e-4 && speed < 5e-7);
        flow_close(&w);
    }
}

// ---- confinement ------------------------------------------------------------------------------

typedef struct wound { // of a vortex, what confinement adds in a step
    double share, off; // of theory; what is not that, of it
    float added[SIDE * SIDE][2];
} wound;

static const double width = 10; // cells

// The velocity of a vortex, anticlockwise where `strength` is above 0, that is as fast as 1 m/s
// near r = 10 cells; and what its vorticity is at a distance, in m/s by cell.
static double vortex(double strength, double x, double y, int axis) {
    const double r2 = (x * x + y * y) / (width * width);
    return strength * exp(0.5 - 0.5 * r2) / width * (axis ? x : -y);
}
static double vorticity_at(double strength, double r) {
    const double r2 = r * r / (width * width);
    return strength * exp(0.5 - 0.5 * r2) / width * (2 - r2);
}

static void step_vortex(gpu *g, double strength, float confinement, float (*out)[2]) {
    flow_world w;
    open_periodic(&w, g, FLOW_SEMI_LAGRANGIAN);
    w.numbers.vorticity = confinement;
    w.numbers.tolerance = 1e-6f;
    for (int i = 0; i < SIDE * SIDE * 2; i++) {
        const int x = i / 2 % SIDE, y = i / 2 / SIDE, axis = i % 2;
        *flow_face_at(&w, x, y, 0, axis) =
            (float)vortex(strength, x - 32 + (axis ? 0.5 : 0), y - 32 + (axis ? 0 : 0.5), axis);
    }
    flow_transfer(&w, true);
    flow_run_steps(&w, 1);
    flow_transfer(&w, false);
    for (int i = 0; i < SIDE * SIDE * 2; i++)
        out[i / 2][i % 2] = *flow_face_at(&w, i / 2 % SIDE, i / 2 / SIDE, 0, i % 2);
    flow_close(&w);
}

// Fedkiw, Stam and Jensen 2001, eq. 11: the force is e h (N x w), N towards more of the vorticity
// w's amount. Round a vortex that is along its turn, as strong as e times the difference of
// velocities across a cell; it has no divergence, so that all of it stays.
static wound wind_up(gpu *g, double strength, float confinement) {
    static float still[SIDE * SIDE][2];
    wound out = {0};
    double both = 0, all = 0, wanted2 = 0;
    step_vortex(g, strength, 0, still);
    step_vortex(g, strength, confinement, out.added);
    for (int i = 0; i < SIDE * SIDE * 2; i++) {
        const int axis = i % 2;
        float *added = &out.added[i / 2][axis];
        *added -= still[i / 2][axis];
        const double x = i / 2 % SIDE - 32 + (axis ? 0.5 : 0), r_least = 0.3 * width;
        const double y = i / 2 / SIDE - 32 + (axis ? 0 : 0.5), r = hypot(x, y);
        if (r < r_least || r > 1.1 * width) continue; // beyond 1.4 its vorticity is turned round
        const double wanted =
            (double)confinement / 128 * vorticity_at(strength, r) * (axis ? x : -y) / r;
        both += wanted * (double)*added;
        all += (double)*added * (double)*added;
        wanted2 += wanted * wanted;
    }
    out.share = both / wanted2;
    out.off = sqrt(fmax(0, all / wanted2 - out.share * out.share));
    return out;
}

static void confinement_winds_vortices_up_by_its_strength(void **state) {
    const wound once = wind_up(*state, 1, 4), other = wind_up(*state, -1, 4);
    const wound twice = wind_up(*state, 1, 8);
    print_message("confinement: %.4f of theory (turned round: %.4f), %.3f beside it\n", once.share,
                  other.share, once.off);
    assert_true(fabs(once.share - 1) < 0.002 && fabs(other.share / once.share - 1) < 1e-4);
    assert_true(once.off < 0.01);
    double most = 0, off = 0;
    for (int i = 0; i < SIDE * SIDE * 2; i++) {
        const double one = (double)once.added[i / 2][i % 2],
                     two = (double)twice.added[i / 2][i % 2];
        most = fmax(most, fabs(one)), off = fmax(off, fabs(two - 2 * one));
    }
    print_message("twice as strong: twice as much but for %.1e of it\n", off / most);
    assert_true(off < 1.5e-4 * most);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_of_shear_decay_by_their_viscosity),
        cmocka_unit_test(warm_columns_rise_and_heavy_ones_sink),
        cmocka_unit_test(dye_goes_as_far_as_the_wind),
        cmocka_unit_test(confinement_winds_vortices_up_by_its_strength),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
