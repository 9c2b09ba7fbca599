// Warm air on a lattice against theory: how fast it begins to rise, what slows it down, and when a
// layer that is heated from below begins to turn over.
#include "sim_test.h"

static const double pi = 3.14159265358979;

// ---- a warm column ------------------------------------------------------------------------------

static const double warmth = 0.25;
static int across, wide; // the axis along which columns alternate, and cells from one to the next

static void columns(int x, int y, int z, sim_cell *cell) {
    const int at[3] = {x, y, z};
    cell->scalar[0] = 1;
    cell->scalar[1] = 1 + warmth * cos(2 * pi * at[across] / wide);
}

typedef struct column {
    lbm_desc desc;
    int across, up, wide, steps;
} column;

// The speed of the columns over that of theory, b T (exp(-d k^2 t) - exp(-n k^2 t)) / (n k^2 - d
// k^2), b T at first; n is the viscosity, d the diffusion of warmth. `off`: what is not that wave.
static double rise(gpu *g, const column *c, double *off) {
    sim_world w;
    lbm_desc desc = c->desc;
    const int low[3] = {4, 4, 16};
    for (int k = 0; k < 3; k++) desc.size[k] = (uint32_t)(k == c->across ? c->wide : low[k]);
    desc.scalars = 2; // the first is there, and does nothing
    sim_open(&w, g, &desc);
    const double k2 = pow(2 * pi / c->wide, 2), viscosity = 0.1, diffusion = 0.05, lift = 2e-3;
    w.numbers.tau = (float)(0.5 + 3 * viscosity);
    for (int s = 0; s < 2; s++) {
        w.numbers.ambient[s] = 1;
        w.numbers.scalar_tau[s] =
            (float)(0.5 + diffusion / (double)lbm_scalar_speed(desc.scalar_set));
    }
    w.numbers.buoyancy[0][c->up] = 0.01f;
    w.numbers.buoyancy[1][c->up] = (float)lift;
    across = c->across, wide = c->wide;
    sim_set_state(&w, columns);
    sim_run(&w, c->steps);
    sim_read(&w);
    const double nk = viscosity * k2, dk = diffusion * k2, t = c->steps;
    // What is read lacks half of the force, so air whose populations are at rest is under way by
    // it.
    const double half = desc.forcing == LBM_GUO ? 0.5 * lift : 0;
    const double wanted =
        lift * warmth * (exp(-dk * t) - exp(-nk * t)) / (nk - dk) + half * warmth * exp(-nk * t);
    double along = 0, all = 0, waves = 0;
    const int *n = (const int *)desc.size;
    for (size_t i = 0; i < w.cells; i++) {
        const int at[3] = {(int)i % n[0], (int)i / n[0] % n[1], (int)i / n[0] / n[1]};
        const double wave = cos(2 * pi * at[across] / wide);
        const double u = w.state[i].u[c->up] + half * (w.state[i].scalar[1] - 1);
        along += u * wave, waves += wave * wave, all += u * u;
    }
    const double speed = along / waves;
    *off = sqrt(fmax(0, all / waves / (speed * speed) - 1));
    sim_close(&w);
    return speed / wanted;
}

static void a_warm_column_rises_by_its_warmth_and_is_held_by_drag(void **state) {
    static const struct {
        const char *name;
        column run;
        double bound;
    } rows[] = {
        {"moments", {{.collision = LBM_CENTRAL_MOMENTS}, 0, 2, 32, 300}, 0.02},
        {"moments, at first", {{.collision = LBM_CENTRAL_MOMENTS}, 1, 2, 32, 20}, 0.02},
        {"TRT, along x", {{.collision = LBM_TRT}, 2, 0, 32, 300}, 0.02},
        {"D3Q27, BGK", {{.set = LBM_D3Q27, .scalar_set = LBM_SCALAR_D3Q27}, 0, 1, 32, 300}, 0.02},
        {"as published",
         {{.set = LBM_D3Q27, .scalar_set = LBM_SCALAR_D3Q27, .forcing = LBM_WEIGHTS_ONLY},
          0,
          2,
          32,
          300},
         0.02},
        {"D3Q27, moments",
         {{.set = LBM_D3Q27, .collision = LBM_CENTRAL_MOMENTS}, 1, 2, 32, 300},
         0.02},
        {"moments, halves",
         {{.collision = LBM_CENTRAL_MOMENTS, .precision = LBM_F16}, 0, 2, 16, 80},
         0.04},
        {"moments, halves, as on GPUs",
         {{.collision = LBM_CENTRAL_MOMENTS, .precision = LBM_F16, .lanes = 2}, 0, 2, 16, 80},
         0.04},
    };
    // Halves lose what changes by less than a part of 4000 in a step: these columns are narrow.
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        double off;
        const double share = rise(*state, &rows[i].run, &off);
        print_message("column, %s: %.4f of theory, %.1e beside it\n", rows[i].name, share, off);
        assert_true(fabs(share - 1) < rows[i].bound && off < 0.002);
    }
}

// ---- a layer that is heated from below
// ------------------------------------------------------------

// Walls at which the air stands still and has a given warmth are faces that let in air at no speed
// worth the name: they lie in the middle of the outermost cells, exactly so where both relaxation
// times are 1.
enum {
    LAYER = 27,
    ROLL = 54
}; // distance of the walls; wavelength: 2.016 times that is the most
   // dangerous
static const double nothing = 1e-9;

// Warm below, cold above; and rolls, a little of them.
static void layer(int x, int y, int z, sim_cell *cell) {
    (void)y;
    cell->scalar[0] = 1 - (double)z / LAYER + 1e-3 * cos(2 * pi * x / ROLL) * sin(pi * z / LAYER);
}

static double rolls(sim_world *w) {
    double sum = 0;
    sim_read(w);
    for (int z = 1; z < LAYER; z++)
        for (int x = 0; x < ROLL; x++)
            sum +=
                w->state[sim_index(w, x, 1, z)].u[2] * cos(2 * pi * x / ROLL) * sin(pi * z / LAYER);
    return sum;
}

// By how much rolls grow in the time that warmth takes from wall to wall.
static double growth(gpu *g, double rayleigh) {
    sim_world w;
    enum { SETTLE = 2000, STEPS = 1000 };
    const double viscosity = 0.5 / 3, diffusion = 0.5 / 4;
    sim_open(&w, g,
             &(lbm_desc){.size = {ROLL, 4, LAYER + 1},
                         .collision = LBM_TRT,
                         .faces = {[4] = LBM_INFLOW, LBM_INFLOW},
                         .scalars = 1});
    w.numbers.tau = w.numbers.scalar_tau[0] = 1;
    w.numbers.ambient[0] = 0.5f;
    w.numbers.inflow_scalar[4][0] = 1;
    w.numbers.inflow[4][2] = (float)nothing;
    w.numbers.inflow[5][2] = (float)-nothing;
    w.numbers.buoyancy[0][2] =
        (float)(rayleigh * viscosity * diffusion / ((double)LAYER * LAYER * LAYER));
    sim_set_state(&w, layer);
    sim_run(&w, SETTLE);
    const double before = rolls(&w);
    sim_run(&w, STEPS);
    const double after = rolls(&w);
    sim_close(&w);
    return log(after / before) / STEPS * LAYER * LAYER / diffusion;
}

// Rayleigh 1916, Jeffreys 1928: between walls that hold the air, rolls grow above 1707.8. Drazin
// and Reid, "Hydrodynamic stability", 1981, section 10.
static void a_layer_turns_over_above_its_critical_number(void **state) {
    const double low = growth(*state, 1600), high = growth(*state, 1800);
    const double critical = 1600 + 200 * low / (low - high);
    print_message("layer: rolls grow by %.3f at 1600 and by %.3f at 1800: %.1f is critical\n", low,
                  high, critical);
    assert_true(low < 0 && high > 0);
    assert_true(fabs(critical / 1707.8 - 1) < 0.04);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_warm_column_rises_by_its_warmth_and_is_held_by_drag),
        cmocka_unit_test(a_layer_turns_over_above_its_critical_number),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
