// Templates in simulated air: where they are, how pictures are made deep, and what the air makes of
// them.
#include "air_templates_test.h"

static const float side = 1.6f; // m, of one in the middle

static const char *const kinds[] = {"pyro", "lbm"};

static picture *even_picture(air_world *t, float red, float green, float blue) {
    picture *out = arena_alloc(&t->w.memory, sizeof *out);
    float *rgba = arena_alloc(&t->w.memory, 4 * sizeof *rgba);
    rgba[0] = red, rgba[1] = green, rgba[2] = blue, rgba[3] = 1;
    *out = (picture){1, 1, 0, rgba};
    return out;
}

static void open_air(air_world *t, gpu *device, const char *type, const char *faces) {
    air_test_open(t, device, type, faces);
    air_test_declare(t);
}

// ---- what flows -------------------------------------------------------------------------------

// As much flows out of a box around a source as comes out of the picture, and into a sink.
static void check_flux(gpu *g, const char *type, const char *cells, const char *depth, int steps) {
    double seen[2];
    static const char *const names[] = {"source", "sink"};
    double expected = 0;
    for (int k = 0; k < 2; k++) {
        air_world t;
        air_test_open(&t, g, type, "open");
        if (cells) air_test_word(t.pass, "velocity_cells", cells);
        air_test_declare(&t);
        const picture *image = library_picture(&t.w.memory, names[k]);
        air_test_middle(&t, image, "pressure", depth, side, 2);
        air_test_build(&t);
        air_test_run(&t, steps);
        const air_flow f = air_test_flow(&t);
        seen[k] = air_test_flux(&f, f.side * 5 / AIR_SIDE);
        if (k == 0)
            expected = 2 * pow((double)side / 2, 3) *
                       air_test_integral(image, 2, strcmp(depth, "extrude") == 0);
        mem_free(f.v);
        world_close(&t.w);
    }
    print_message("%s%s%s, %s: flux %.4f of a source, %.4f of a sink; theory %.4f\n", type,
                  cells ? ", " : "", cells ? cells : "", depth, seen[0], seen[1], expected);
    assert_true(fabs(seen[0] / expected - 1) < 0.03);
    assert_true(fabs(seen[1] / expected + 1) < 0.03);
}

static void pressure_lets_as_much_out_as_it_says(void **state) {
    check_flux(*state, "pyro", "full", "revolve", 5);
    check_flux(*state, "pyro", "full", "extrude", 5);
    check_flux(*state, "pyro", "half", "revolve", 5);
    check_flux(*state, "lbm", NULL, "revolve", 400);
}

// Where all is around, what is pushed stays in it.
static void velocity_gives_the_momentum_it_says(void **state) {
    static const char *const depths[] = {"revolve", "extrude"};
    for (int k = 0; k < 4; k++) {
        air_world t;
        const int steps = 40;
        open_air(&t, *state, kinds[k / 2], "periodic");
        const picture *up = even_picture(&t, 0, 1, 0);
        air_test_middle(&t, up, "velocity", depths[k % 2], side, 0.5f);
        air_test_build(&t);
        air_test_run(&t, steps);
        const air_flow f = air_test_flow(&t);
        double sum[3] = {0};
        for (int i = 0; i < f.side * f.side * f.side; i++)
            for (int axis = 0; axis < 3; axis++)
                sum[axis] += (double)f.v[i][axis] * (double)f.v[i][3] * pow(f.cell, 3);
        const air *a = air_of(t.pass);
        // Of the lattice the state before the last step is kept, with half of its force.
        const double time = (steps - (a->kind->late ? 0.5 : 0)) * a->units.step;
        const double expected =
            0.5 * time * pow((double)side / 2, 3) * air_test_integral(up, 1, k % 2 == 1);
        print_message("%s, %s: momentum %.5f, %.5f, %.5f; theory 0, 0, %.5f\n", kinds[k / 2],
                      depths[k % 2], sum[0], sum[1], sum[2], expected);
        assert_true(fabs(sum[2] / expected - 1) < 0.03);
        assert_true(fabs(sum[0]) < 0.01 * expected && fabs(sum[1]) < 0.01 * expected);
        mem_free(f.v);
        world_close(&t.w);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(pressure_lets_as_much_out_as_it_says),
        cmocka_unit_test(velocity_gives_the_momentum_it_says),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
