// Burning gas that a coarser run guides: its large eddies are those of the guide, its small ones
// its own.
#include "pyro_test.h"

enum { MOST = 16 }; // cells of a coarse run along a side; the fine one has twice as many

static const double pi = 3.14159265358979;
static const float box = 2.4f; // m

// ---- the same gas in both ---------------------------------------------------------------------

// A ball of fuel that is hot, in air that is stirred at random: an integral over a face of a vector
// potential of waves, so that both runs have the same flow through the same face.
typedef struct wave {
    double k[3], phase[3], size[3];
} wave;
enum { WAVES = 12 };

static double chance(uint32_t *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (1 << 24);
}

static void make_waves(wave out[WAVES]) {
    uint32_t seed = 7;
    for (int i = 0; i < WAVES; i++)
        for (int a = 0; a < 3; a++) {
            out[i].k[a] = 2 * pi * floor(1 + 3 * chance(&seed)) * (chance(&seed) < 0.5 ? -1 : 1);
            out[i].phase[a] = 2 * pi * chance(&seed);
            out[i].size[a] = chance(&seed) - 0.5;
        }
}

// Component `a` of the potential at a place of a box of side 1, which is none at its faces.
static double potential(const wave w[WAVES], const double p[3], int a) {
    double sum = 0, in = 1;
    for (int i = 0; i < WAVES; i++)
        sum += w[i].size[a] *
               cos(w[i].k[0] * p[0] + w[i].k[1] * p[1] + w[i].k[2] * p[2] + w[i].phase[a]);
    for (int i = 0; i < 3; i++) in *= pow(sin(pi * p[i]), 2);
    return in * sum;
}

// Stokes: by the potential in the middle of the edges of the face.
static double through(const wave w[WAVES], const double corner[3], double side, int axis) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    double at[4][3];
    for (int i = 0; i < 4; i++) memcpy(at[i], corner, sizeof at[i]);
    at[0][b] += side / 2;                   // along b, low c
    at[1][b] += side, at[1][c] += side / 2; // along c, high b
    at[2][b] += side / 2, at[2][c] += side; // along b, high c
    at[3][c] += side / 2;                   // along c, low b
    return (potential(w, at[0], b) + potential(w, at[1], c) - potential(w, at[2], b) -
            potential(w, at[3], c)) /
           side;
}

static void begin(pyro_world *w, const int c[3], void *data) {
    const wave *waves = data;
    const double n = w->desc.size[0];
    double r2 = 0, corner[3];
    for (int i = 0; i < 3; i++) corner[i] = c[i] / n;
    for (int i = 0; i < 3; i++) r2 += pow((c[i] + 0.5) / n - (i == 2 ? 0.3 : 0.5), 2);
    const float in = (float)fmin(1, fmax(0, (0.2 - sqrt(r2)) / 0.08 + 0.5));
    w->gas[pyro_cell_at(w, c)][0] = 600 * in;
    w->gas[pyro_cell_at(w, c)][1] = 0.15f * in;
    for (int i = 0; i < 3; i++)
        *pyro_face_at(w, i, c) = c[i] == 0 ? 0 : (float)(0.15 * through(waves, corner, 1 / n, i));
}

// `cells`: of the coarse run along a side, whatever the run.
static void open_run(pyro_world *w, gpu *g, int cells, bool fine, bool guided,
                     pyro_advection advection) {
    wave waves[WAVES];
    const uint32_t side = (uint32_t)(fine ? 2 * cells : cells);
    make_waves(waves);
    pyro_open(w, g,
              &(pyro_desc){.size = {side, side, side},
                           .faces = {[4] = PYRO_WALL},
                           .advection = advection,
                           .cycles = 4,
                           .guide = guided});
    w->numbers.cell = box / (float)side;
    w->numbers.dt = 0.25f * w->numbers.cell;
    w->numbers.burn_time = 0.1f;
    w->numbers.guide_rate = 20;
    w->numbers.guide_size = box / (float)cells;
    pyro_for_each(w, begin, waves);
    pyro_transfer(w, true);
}

// ---- what they have in common -----------------------------------------------------------------

typedef struct means { // of the velocity in the cells of a coarse run
    int cells;         // along a side
    double velocity[MOST * MOST * MOST][3];
    double small; // energy of what is left, m^2/s^2
} means;

// Velocities in the middle of cells of the run.
static void add_cell(pyro_world *w, const int c[3], void *data) {
    means *m = data;
    const int n = (int)w->desc.size[0], each = n / m->cells;
    double *to = m->velocity[c[0] / each + m->cells * (c[1] / each + m->cells * (c[2] / each))];
    for (int a = 0; a < 3; a++) {
        int above[3] = {c[0], c[1], c[2]};
        if (above[a] + 1 < n) above[a]++;
        const double v =
            0.5 * ((double)*pyro_face_at(w, a, c) + (double)*pyro_face_at(w, a, above));
        to[a] += v / pow(each, 3);
        m->small += v * v / pow(n, 3);
    }
}

static means *find_means(pyro_world *w, int cells) {
    means *m = mem_alloc(sizeof *m);
    memset(m, 0, sizeof *m);
    m->cells = cells;
    pyro_transfer(w, false);
    pyro_for_each(w, add_cell, m);
    for (int i = 0; i < cells * cells * cells; i++)
        for (int a = 0; a < 3; a++) m->small -= pow(m->velocity[i][a], 2) / pow(cells, 3);
    return m;
}

typedef struct likeness {
    double apart; // of the mean velocities, by their own size
    double small; // energy of small eddies, m^2/s^2
    double left;  // of divergence that is not wanted, by the greatest speed
} likeness;

static likeness compare(pyro_world *coarse, pyro_world *fine) {
    const int cells = (int)coarse->desc.size[0];
    means *a = find_means(coarse, cells), *b = find_means(fine, cells);
    double apart = 0, size = 0;
    for (int i = 0; i < cells * cells * cells; i++)
        for (int k = 0; k < 3; k++) {
            apart += pow(a->velocity[i][k] - b->velocity[i][k], 2);
            size += pow(a->velocity[i][k], 2);
        }
    const pyro_report r = pyro_look_at(fine);
    const likeness out = {sqrt(apart / size), b->small, (double)(r.residual / r.speed)};
    mem_free(a);
    mem_free(b);
    return out;
}

// The coarse run goes first; two steps of the fine one follow each of its own.
static likeness run_both(gpu *g, int cells, bool guided, pyro_advection advection) {
    enum { STEPS = 40 };
    pyro_world coarse, fine;
    open_run(&coarse, g, cells, false, false, advection);
    open_run(&fine, g, cells, true, guided, advection);
    for (int i = 0; i < STEPS; i++) {
        gpu_test_ok(gpu_frame_begin(g));
        gpu_test_ok(pyro_step(coarse.solver, g, &coarse.numbers, true));
        pyro_set_guide(fine.solver, pyro_image(coarse.solver, PYRO_FLOW, 0));
        for (int k = 0; k < 2; k++) gpu_test_ok(pyro_step(fine.solver, g, &fine.numbers, false));
        gpu_test_ok(gpu_frame_end(g));
    }
    const likeness out = compare(&coarse, &fine);
    print_message("%s, %s: large eddies %.3f apart, small ones %.5f m^2/s^2, divergence %.2g\n",
                  pyro_advection_names[advection], guided ? "guided" : "alone", out.apart,
                  out.small, out.left);
    pyro_close(&coarse);
    pyro_close(&fine);
    return out;
}

static void a_guide_holds_large_eddies(void **state) {
    const likeness alone = run_both(*state, MOST, false, PYRO_PARABOLIC);
    const likeness guided = run_both(*state, MOST, true, PYRO_PARABOLIC);
    assert_true(alone.apart > 0.6 && guided.apart < 0.25);
    assert_true(fabs(guided.small / alone.small - 1) < 0.3);
    assert_true(guided.left < 2.9e-5);
}

static void and_with_reflection(void **state) {
    const likeness guided = run_both(*state, MOST, true, PYRO_REFLECTION);
    assert_true(guided.apart < 0.4);
    assert_true(guided.left < 2e-5);
}

// ---- numbers ----------------------------------------------------------------------------------

static gpu_image *make_guide(gpu *g, const pyro *p, const float velocity[4]) {
    uint32_t n[3];
    pyro_find_most_guide_cells(p, n);
    gpu_image *guide =
        gpu_image_create(g, &(gpu_image_desc){.label = "guide",
                                              .format = GPU_RGBA16F,
                                              .width = n[0],
                                              .height = n[1],
                                              .depth = n[2],
                                              .use = GPU_USE_SAMPLED | GPU_USE_STORAGE});
    gpu_test_ok(guide);
    gpu_test_ok(gpu_frame_begin(g));
    gpu_image_clear(g, guide, velocity);
    gpu_test_ok(gpu_frame_end(g));
    return guide;
}

// Air at rest, that shall be 1 m/s fast: what is missing goes by exp(-rate t).
static void check_rate(gpu *g, pyro_advection advection) {
    pyro_world w;
    pyro_open(&w, g,
              &(pyro_desc){.size = {16, 16, 16},
                           .faces = {3, 3, 3, 3, 3, 3},
                           .advection = advection,
                           .guide = true});
    gpu_image *guide = make_guide(g, w.solver, (const float[4]){1, 0, 0, 0});
    pyro_set_guide(w.solver, guide);
    w.numbers.guide_rate = 5;
    w.numbers.guide_size = 8 * w.numbers.cell;
    w.numbers.dt = 0.02f;
    pyro_run_steps(&w, 10);
    pyro_transfer(&w, false);
    const double seen = (double)*pyro_face_at(&w, 0, (int[3]){7, 8, 8});
    print_message("after 1 / rate: %.5f of the guide, theory %.5f\n", seen, 1 - exp(-1));
    assert_true(fabs(seen - (1 - exp(-1))) < 3e-4);
    gpu_image_destroy(g, guide);
    pyro_close(&w);
}

static void a_guide_is_taken_on_at_its_rate(void **state) {
    for (pyro_advection a = PYRO_PARABOLIC; a <= PYRO_REFLECTION; a++) check_rate(*state, a);
}

// The level of multigrid whose cells come nearest, of those that are larger than the velocity's.
static void large_is_what_the_size_says(void **state) {
    static const struct {
        float size;
        uint32_t cells;
    } rows[] = {{0, 24}, {1, 24}, {2.7f, 24}, {2.9f, 12}, {4, 12}, {8, 6}, {100, 3}};
    arena memory = {0};
    (void)state;
    pyro *p = pyro_create(&memory, &(pyro_desc){.size = {48, 48, 48}, .guide = true});
    gpu_test_ok(p);
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        uint32_t n[3];
        pyro_find_guide_cells(p, &(pyro_numbers){.cell = 1, .guide_size = rows[i].size}, n);
        assert_int_equal(n[0], rows[i].cells);
    }
    arena_free(&memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_guide_holds_large_eddies),
        cmocka_unit_test(and_with_reflection),
        cmocka_unit_test(a_guide_is_taken_on_at_its_rate),
        cmocka_unit_test(large_is_what_the_size_says),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
