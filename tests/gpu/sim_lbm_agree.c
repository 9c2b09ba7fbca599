// What a layout, a precision, a set or a collision may not change.
#include "long_test.h"
#include "sim_test.h"

// `rise`: by a scalar of 1.
static sim_cell *run(gpu *g, lbm_desc desc, int steps, float rise) {
    sim_world w;
    sim_open(&w, g, &desc);
    w.numbers.tau = 0.55f;
    w.numbers.scalar_tau[0] = 0.5f + 0.02f / lbm_scalar_speed(desc.scalar_set);
    w.numbers.buoyancy[0][2] = rise;
    sim_set_state(&w, swirl);
    sim_run(&w, steps);
    sim_read(&w);
    sim_cell *result = mem_copy(w.state, w.cells * sizeof *w.state);
    sim_close(&w);
    return result;
}

// The greatest difference of velocities and scalars, relative to the greatest speed and to 1.
static void differ(const sim_cell *a, const sim_cell *b, size_t cells, double out[2]) {
    double most = 0;
    out[0] = out[1] = 0;
    for (size_t i = 0; i < cells; i++) {
        for (int k = 0; k < 3; k++) {
            most = fmax(most, fabs(a[i].u[k]));
            out[0] = fmax(out[0], fabs(a[i].u[k] - b[i].u[k]));
        }
        out[1] = fmax(out[1], fabs(a[i].scalar[0] - b[i].scalar[0]));
    }
    out[0] /= most;
}

typedef struct trial {
    int steps; // odd: the parity of these, too
    float rise;
    double speed, scalar; // least errors that are not accepted
} trial;

static void try_both(gpu *g, const char *what, lbm_desc a, lbm_desc b, trial t) {
    a.size[0] = a.size[1] = b.size[0] = b.size[1] = 16;
    a.size[2] = b.size[2] = 32;
    a.scalars = b.scalars = 1;
    sim_cell *first = run(g, a, t.steps, t.rise), *second = run(g, b, t.steps, t.rise);
    double error[2];
    differ(first, second, 16 * 16 * 32, error);
    print_message("%s: velocities differ by %.2e of the greatest, scalars by %.2e\n", what,
                  error[0], error[1]);
    assert_true(error[0] < t.speed && error[1] < t.scalar);
    mem_free(first);
    mem_free(second);
}

static void compare(gpu *g, const char *what, lbm_desc a, lbm_desc b, double speed, double scalar) {
    try_both(g, what, a, b, (trial){.steps = 101, .speed = speed, .scalar = scalar});
}

static void ways_to_do_the_same_agree(void **state) {
    const lbm_desc plain = {.collision = LBM_CENTRAL_MOMENTS};
    lbm_desc other = plain;
    other.set = LBM_D3Q27;
    compare(*state, "D3Q19 and D3Q27", plain, other, 0.0035, 0.0024);
    other = plain;
    other.precision = LBM_F16;
    compare(*state, "FP32 and FP16", plain, other, 0.0014, 0.0022);
    other = plain;
    other.collision = LBM_BGK;
    compare(*state, "moments and BGK", plain, other, 0.03, 0.012);
    other.collision = LBM_TRT;
    compare(*state, "moments and TRT", plain, other, 0.03, 0.02);
    other = plain;
    other.scalar_set = LBM_SCALAR_D3Q27;
    compare(*state, "scalars D3Q7 and D3Q27", plain, other, 1e-9, 0.03);
}

// In bundles, and as lavapipe likes it, where scalars of 27 directions are done beside the air:
// with these, halves are rounded otherwise, and what rises makes more of that in time.
static void lie(gpu *g, lbm_desc a, const lbm_face faces[6]) {
    const trial same = {61, 1e-4f, 1e-9, 1e-9}, rounded = {31, 1e-4f, 1e-3, 2e-3};
    a.collision = LBM_CENTRAL_MOMENTS;
    a.precision = LBM_F16;
    a.lanes = 2;
    memcpy(a.faces, faces, sizeof a.faces);
    lbm_desc b = a;
    b.lanes = 4;
    b.order = LBM_WHOLE;
    try_both(g, "bundles and elements", a, b, a.scalar_set == LBM_SCALAR_D3Q27 ? rounded : same);
}

static void however_the_state_lies_it_is_the_same(void **state) {
    static const lbm_face faces[][6] = {
        {LBM_PERIODIC},
        {LBM_OPEN, LBM_OPEN, LBM_WALL, LBM_SLIP, LBM_WALL, LBM_OPEN},
        {LBM_WALL, LBM_WALL, LBM_SLIP, LBM_SLIP, LBM_SLIP, LBM_WALL},
    };
    for (size_t i = 0; i < COUNT_OF(faces); i++) {
        lie(*state, (lbm_desc){.set = LBM_D3Q19, .order = LBM_BLOCKS}, faces[i]);
        if (i > 0 && !sim_long_tests("other layouts beside walls")) continue;
        lie(*state, (lbm_desc){.set = LBM_D3Q27, .order = LBM_WHOLE}, faces[i]);
        lie(*state, (lbm_desc){.scalar_set = LBM_SCALAR_D3Q27, .order = LBM_BLOCKS}, faces[i]);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(ways_to_do_the_same_agree),
        cmocka_unit_test(however_the_state_lies_it_is_the_same),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
