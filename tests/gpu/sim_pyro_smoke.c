// Smoke of burning gas, which does not glow or burn: beside soot that does not burn either, which
// is one of the four numbers of the gas, and against what was given.
#include "pyro_test.h"

// ---- beside soot ------------------------------------------------------------------------------

// A ball of lumps of fuel that is hot, with as much smoke as soot.
static void fill(pyro_world *w, const int c[3], void *data) {
    const float cold = *(const float *)data;
    double r2 = 0;
    for (int i = 0; i < 3; i++) r2 += pow(c[i] + 0.5 - w->desc.size[i] / 2.0, 2);
    const float in = (float)fmin(1, fmax(0, (7 - sqrt(r2)) / 4 + 0.5));
    const size_t at = pyro_cell_at(w, c);
    const float lump = (c[0] + c[1] + c[2]) % 2 == 0 ? 1.5f : 0.5f;
    w->gas[at][0] = cold > 0 ? 0 : 600 * in;
    w->gas[at][1] = cold > 0 ? 0 : 0.03f * in * lump;
    w->gas[at][3] = 0.02f * in * lump;
    // By volume.
    w->smoke[at] = w->gas[at][3] * w->numbers.ambient / (w->numbers.ambient + w->gas[at][0]);
    for (int axis = 0; axis < 3; axis++)
        if (cold > 0) w->velocity[at][axis] = cold;
}

static void open_ball(pyro_world *w, gpu *g, const pyro_desc *desc, float cold) {
    pyro_desc d = *desc;
    for (int i = 0; i < 3; i++) d.size[i] = 32;
    d.smoke = true;
    pyro_open(w, g, &d);
    w->numbers.gravity = 9.81f;
    w->numbers.burn_time = 0.05f;
    w->numbers.flame_speed = 1;
    w->numbers.soot_yield = w->numbers.smoke_yield = 0.1f;
    w->numbers.dissolve = w->numbers.smoke_dissolve = 1;
    pyro_for_each(w, fill, &cold);
    pyro_transfer(w, true);
}

// The greatest difference by the greatest value.
static double apart_from_soot(pyro_world *w) {
    double most = 0, apart = 0;
    for (size_t i = 0; i < w->cells; i++) {
        const double ambient = (double)w->numbers.ambient;
        const double soot = (double)w->gas[i][3] * ambient / (ambient + (double)w->gas[i][0]);
        most = fmax(most, soot);
        apart = fmax(apart, fabs(soot - (double)w->smoke[i]));
    }
    assert_true(most > 1e-3);
    return apart / most;
}

static void smoke_is_what_soot_would_be(void **state) {
    static const pyro_desc rows[] = {
        {.advection = PYRO_PARABOLIC},
        {.advection = PYRO_UPWIND},
        {.advection = PYRO_PARABOLIC, .half_velocity = true, .variable_density = true},
        {.advection = PYRO_PARABOLIC, .premixed = true},
    };
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        pyro_world w;
        open_ball(&w, *state, &rows[i], 0);
        pyro_run_steps(&w, 12);
        pyro_transfer(&w, false);
        const double apart = apart_from_soot(&w);
        print_message("smoke is %.1e of the most soot apart from it\n", apart);
        assert_true(apart < 3e-6);
        pyro_close(&w);
    }
}

// ---- alone ------------------------------------------------------------------------------------

static double sum_of(const pyro_world *w) {
    double sum = 0;
    for (size_t i = 0; i < w->cells; i++) sum += (double)w->smoke[i];
    return sum;
}

// Cold, in air that moves along all axes: nothing of the gas marks where it is.
static float *carry_cold(gpu *g, bool everywhere, double *kept) {
    pyro_world w;
    open_ball(&w, g, &(pyro_desc){.advection = PYRO_PARABOLIC, .faces = {3, 3, 3, 3, 3, 3}}, 1);
    for (size_t i = 0; i < w.cells; i++) w.gas[i][3] = 0;
    w.numbers.smoke_dissolve = 2;
    pyro_transfer(&w, true);
    const double before = sum_of(&w);
    for (int i = 0; i < 30; i++) {
        gpu_buffer *buffers[PYRO_STATE_BUFFERS];
        if (everywhere) pyro_buffers(w.solver, buffers);
        pyro_run_steps(&w, 1);
    }
    pyro_transfer(&w, false);
    *kept = sum_of(&w) / before;
    float *smoke = mem_copy(w.smoke, w.cells * sizeof *smoke);
    pyro_close(&w);
    return smoke;
}

// Half a second, in which it goes on by ten cells along each axis.
static void smoke_fades_at_its_rate(void **state) {
    double kept, same;
    float *some = carry_cold(*state, false, &kept), *all = carry_cold(*state, true, &same);
    print_message("%.4f of the smoke is left, theory %.4f\n", kept, exp(-1));
    assert_true(fabs(kept - exp(-1)) < 6e-4);
    assert_memory_equal(some, all, (size_t)32 * 32 * 32 * sizeof *some);
    mem_free(some);
    mem_free(all);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smoke_is_what_soot_would_be),
        cmocka_unit_test(smoke_fades_at_its_rate),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
