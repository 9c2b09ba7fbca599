// The projection of burning gas: what divergence is left after a step, and how fast cycles shrink
// it.
#include "long_test.h"
#include "pyro_test.h"

static float noise(uint32_t *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) / 8388608.0f - 1;
}

// Velocities so small that hardly anything is carried in a step: what is projected is known.
static void rough(pyro_world *w, const int c[3], void *seed) {
    for (int axis = 0; axis < 3; axis++)
        if (c[axis] > 0 || w->desc.faces[2 * axis] != PYRO_WALL)
            *pyro_face_at(w, axis, c) = 1e-4f * noise(seed);
}

// One wave in each direction.
static void smooth(pyro_world *w, const int c[3], void *data) {
    (void)data;
    for (int axis = 0; axis < 3; axis++) {
        const double k = 3.14159265358979 / w->desc.size[axis];
        const double wave = sin(k * c[axis]) * cos(2 * k * (c[(axis + 1) % 3] + 0.5));
        if (c[axis] > 0) *pyro_face_at(w, axis, c) = (float)(1e-4 * wave);
    }
}

typedef struct row {
    const char *name;
    uint32_t size[3];
    pyro_face faces[6];
} row;

static const row rows[] = {
    {"open over ground", {32, 32, 48}, {[4] = PYRO_WALL}},
    {"open", {24, 40, 32}, {0}},
    {"around", {32, 32, 32}, {3, 3, 3, 3, 3, 3}},
    {"closed", {32, 32, 32}, {PYRO_WALL, PYRO_WALL, PYRO_WALL, PYRO_WALL, PYRO_WALL, PYRO_WALL}},
    {"a duct", {64, 16, 24}, {PYRO_INFLOW, PYRO_OPEN, PYRO_WALL, PYRO_WALL, PYRO_WALL, PYRO_WALL}},
    {"odd", {40, 56, 24}, {[4] = PYRO_WALL}},
    {"halved along two axes alone at the end", {24, 48, 80}, {[4] = PYRO_WALL}},
};

// The greatest divergence that is left, by the greatest that there was: of waves, and of noise.
static void find_left(gpu *g, const row *r, uint32_t cycles, double out[2]) {
    static pyro_visit *const states[2] = {smooth, rough};
    pyro_world w;
    pyro_desc desc = {.cycles = cycles};
    uint32_t seed = 1;
    memcpy(desc.size, r->size, sizeof desc.size);
    memcpy(desc.faces, r->faces, sizeof desc.faces);
    pyro_open(&w, g, &desc);
    for (int i = 0; i < 2; i++) {
        memset(w.velocity, 0, w.cells * sizeof *w.velocity);
        memset(w.gas, 0, w.cells * sizeof *w.gas);
        memset(w.pressure, 0, w.cells * sizeof *w.pressure);
        pyro_for_each(&w, states[i], &seed);
        pyro_transfer(&w, true);
        pyro_run_steps(&w, 1);
        const pyro_report report = pyro_look_at(&w);
        assert_int_equal(report.bad, 0);
        out[i] = (double)report.residual / 1e-4;
    }
    pyro_close(&w);
}

static void cycles_shrink_what_is_left(void **state) {
    const bool all = sim_long_tests("boxes that are open all round, closed, or odd");
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        if (i % 2 != 0 && !all) continue;
        double left[4][2]; // after so many cycles
        for (uint32_t n = 0; n < 4; n++) find_left(*state, &rows[i], n + 1, left[n]);
        print_message("%s: waves %.1e %.1e %.1e %.1e; noise %.1e %.1e %.1e %.1e\n", rows[i].name,
                      left[0][0], left[1][0], left[2][0], left[3][0], left[0][1], left[1][1],
                      left[2][1], left[3][1]);
        // In the second cycle, when all waves have been met; later rounding has its part.
        assert_true(left[0][0] < 0.2 && left[1][0] < 0.2 * left[0][0] && left[3][0] < 1.5e-3);
        assert_true(left[1][1] < 0.2 * left[0][1] && left[2][1] < 0.2 * left[1][1] &&
                    left[3][1] < 4e-3);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cycles_shrink_what_is_left)};
    return gpu_test_run(tests, COUNT_OF(tests));
}
