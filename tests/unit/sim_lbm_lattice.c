// The tables of velocity sets, and how a state is laid out for a device.
#include "base_test.h"
#include "sim/lbm_impl.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define COUNT_ONE(i, x, y, z) +2
#include "sim/lbm/lattice.glsl"

typedef struct table {
    int count, c[27][3];
    double weight[27], speed; // square of that of sound
} table;

static void fill(table *t, int count, const double weights[4], double speed) {
    *t = (table){.count = count, .speed = speed};
#define ADD(i, X, Y, Z)                                                                            \
    {                                                                                              \
        const int v[3] = {X, Y, Z};                                                                \
        for (int k = 0; k < 3; k++) t->c[i][k] = v[k], t->c[i + 1][k] = -v[k];                     \
    }
    LBM_D3Q27(ADD)
#undef ADD
    for (int i = 0; i < count; i++)
        t->weight[i] = weights[abs(t->c[i][0]) + abs(t->c[i][1]) + abs(t->c[i][2])];
}

static void tables(table out[3]) {
    fill(&out[0], 7, (const double[4]){LBM_D3Q7_REST, LBM_D3Q7_AXIS}, 0.25);
    fill(&out[1], 19, (const double[4]){LBM_D3Q19_REST, LBM_D3Q19_AXIS, LBM_D3Q19_EDGE}, 1.0 / 3);
    fill(&out[2], 27,
         (const double[4]){LBM_D3Q27_REST, LBM_D3Q27_AXIS, LBM_D3Q27_EDGE, LBM_D3Q27_CORNER},
         1.0 / 3);
}

// The sum of weights times c_x^a c_y^b c_z^c.
static double moment(const table *t, int a, int b, int c) {
    double sum = 0;
    for (int i = 0; i < t->count; i++)
        sum += t->weight[i] * pow(t->c[i][0], a) * pow(t->c[i][1], b) * pow(t->c[i][2], c);
    return sum;
}

static void close_to(double value, double expected) {
    if (fabs(value - expected) > 1e-14) fail_msg("%.17g is not %.17g", value, expected);
}

static void the_lists_are_as_long_as_their_names_say(void **state) {
    (void)state;
    assert_int_equal(1 LBM_D3Q7(COUNT_ONE), 7);
    assert_int_equal(1 LBM_D3Q19(COUNT_ONE), 19);
    assert_int_equal(1 LBM_D3Q27(COUNT_ONE), 27);
}

static void every_direction_is_there_once_and_its_opposite_beside_it(void **state) {
    table t[3];
    (void)state;
    tables(t);
    for (int i = 0; i < 27; i++)
        for (int j = 0; j < i; j++) assert_memory_not_equal(t[2].c[i], t[2].c[j], sizeof t[2].c[i]);
    for (int i = 1; i < 27; i += 2) {
        for (int k = 0; k < 3; k++) assert_int_equal(t[2].c[i][k], -t[2].c[i + 1][k]);
        assert_true(t[2].c[i][2] >= 0); // only the layer above is ever beyond the end
    }
}

static void moments_of_the_weights_are_isotropic(void **state) {
    table all[3];
    (void)state;
    tables(all);
    for (int s = 0; s < 3; s++) {
        const table *t = &all[s];
        close_to(moment(t, 0, 0, 0), 1);
        close_to(moment(t, 2, 0, 0), t->speed);
        close_to(moment(t, 0, 2, 0), t->speed);
        close_to(moment(t, 0, 0, 2), t->speed);
        for (int a = 0; a < 4; a++) // odd moments, and mixed ones
            for (int b = 0; a + b < 6; b++)
                for (int c = 0; a + b + c < 6; c++)
                    if (a % 2 || b % 2 || c % 2) close_to(moment(t, a, b, c), 0);
        if (t->count == 7) continue; // of second order only
        close_to(moment(t, 4, 0, 0), 3 * t->speed * t->speed);
        close_to(moment(t, 2, 2, 0), t->speed * t->speed);
        close_to(moment(t, 2, 0, 2), t->speed * t->speed);
        close_to(moment(t, 0, 2, 2), t->speed * t->speed);
    }
    close_to(moment(&all[2], 2, 2, 2), 1.0 / 27);
}

static lbm_layout lay_out(lbm_desc desc, uint64_t range) {
    lbm_layout layout;
    desc.lanes = 4;
    desc.order = LBM_BLOCKS;
    if (!lbm_layout_find(&desc, range, &layout)) fail_msg("%s", err_get());
    assert_int_equal(layout.run % 2, 0);
    assert_true(layout.run * layout.buffers >= layout.slots);
    assert_true((uint64_t)layout.run * layout.elements <= UINT32_MAX);
    return layout;
}

// Every direction with a part along the axis is in one pair, whose two differ in that part's sign.
static void mirrors_exchange_what_goes_up_and_down(void **state) {
    (void)state;
    static const int x[][2] = {
#define PAIR(a, b) {a, b},
        LBM_MIRRORS_27_X(PAIR)};
    static const int y[][2] = {LBM_MIRRORS_27_Y(PAIR)};
    static const int z[][2] = {LBM_MIRRORS_27_Z(PAIR)};
#undef PAIR
    static const int(*const lists[3])[2] = {x, y, z};
    table t[3];
    tables(t);
    for (int axis = 0; axis < 3; axis++) {
        bool seen[27] = {false};
        for (int i = 0; i < 9; i++) {
            const int up = lists[axis][i][0], down = lists[axis][i][1];
            assert_true(!seen[up] && !seen[down]);
            seen[up] = seen[down] = true;
            assert_int_equal(t[2].c[up][axis], 1);
            for (int k = 0; k < 3; k++)
                assert_int_equal(t[2].c[up][k], k == axis ? -t[2].c[down][k] : t[2].c[down][k]);
            if (i < 5) assert_true(up < 19 && down < 19); // these are all that D3Q19 has
        }
    }
}

static void a_state_fits_into_what_a_device_binds(void **state) {
    const uint64_t mib = 1 << 20, gib = 1 << 30;
    (void)state;
    lbm_layout small = lay_out((lbm_desc){.size = {96, 96, 96}}, 128 * mib);
    assert_int_equal(small.buffers, 1);
    lbm_desc desc = {.size = {128, 128, 128}, .set = LBM_D3Q27};
    lbm_layout split = lay_out(desc, 128 * mib);
    assert_int_equal(split.run, 16);
    assert_int_equal(split.buffers, 2);
    desc.precision = LBM_F16;
    lbm_layout halves = lay_out(desc, 128 * mib);
    assert_int_equal(halves.elements, split.elements);
    assert_int_equal(halves.buffers, 1);
    desc.lanes = 2;
    desc.order = LBM_BLOCKS;
    lbm_layout bundles;
    assert_true(lbm_layout_find(&desc, 128 * mib, &bundles));
    assert_int_equal(bundles.bundle * bundles.element, 16);
    assert_int_equal(bundles.elements, 2 * halves.elements);
    assert_int_equal(bundles.block % bundles.bundle, 0);
    desc.size[2] = 124;
    assert_true(lbm_layout_find(&desc, 128 * mib, &bundles));
    assert_int_equal(bundles.bundle, 1);
    lbm_layout large = lay_out((lbm_desc){.size = {512, 512, 512}}, UINT32_MAX);
    assert_int_equal(large.run, 6); // of 512 MiB
    assert_int_equal(large.buffers, 4);
    lbm_layout all = lay_out(
        (lbm_desc){.size = {512, 512, 512}, .set = LBM_D3Q27, .scalars = 3, .precision = LBM_F16},
        4 * gib);
    assert_int_equal(all.slots, 27 + 3 * 7);
}

static void what_does_not_fit_is_refused_with_numbers(void **state) {
    lbm_layout layout;
    (void)state;
    assert_false(
        lbm_layout_find(&(lbm_desc){.size = {512, 512, 512}, .lanes = 4}, 128 << 20, &layout));
    assert_non_null(strstr(err_get(), "512 x 512 x 512"));
    assert_non_null(strstr(err_get(), "128 MiB"));
}

static void refuse(lbm_desc desc, const char *why) {
    arena memory = {0};
    assert_null(lbm_create(&memory, &desc));
    if (!strstr(err_get(), why)) fail_msg("\"%s\" does not say \"%s\"", err_get(), why);
    arena_free(&memory);
}

static void a_lattice_that_cannot_be_is_refused(void **state) {
    (void)state;
    refuse((lbm_desc){.size = {2, 64, 64}}, "at least");
    refuse((lbm_desc){.size = {64, 64, 62}}, "multiple of 4");
    refuse((lbm_desc){.size = {64, 8192, 64}}, "at most");
    refuse((lbm_desc){.size = {64, 64, 64}, .lanes = 3}, "elements of 3 cells");
    refuse((lbm_desc){.size = {64, 64, 64}, .lanes = 2}, "half precision");
    refuse((lbm_desc){.size = {64, 64, 64}, .scalars = 4}, "4 scalars");
    refuse((lbm_desc){.size = {64, 64, 64}, .faces = {LBM_WALL}}, "along x");
    refuse((lbm_desc){.size = {64, 64, 64}, .collision = LBM_TRT, .forcing = LBM_WEIGHTS_ONLY},
           "BGK");
}

// The shader that holds most, as cards get it: a thread's arrays are limited (SPIRV_MAX_PRIVATE).
static void all_that_a_step_can_do_compiles_for_a_card(void **state) {
    const char *source = getenv("ROIL_SOURCE_DIR");
    arena memory = {0};
    (void)state;
    if (!source) fail_msg("set ROIL_SOURCE_DIR to the root of the source");
    shader_library *library = shader_library_create(
        &(shader_library_desc){.shader_root = arena_format(&memory, "%s/shaders", source)});
    for (int half = 0; half < 2; half++) {
        lbm *l = lbm_create(&memory, &(lbm_desc){.size = {32, 32, 32},
                                                 .set = LBM_D3Q27,
                                                 .scalar_set = LBM_SCALAR_D3Q27,
                                                 .collision = LBM_CENTRAL_MOMENTS,
                                                 .precision = half ? LBM_F16 : LBM_F32,
                                                 .faces = {LBM_INFLOW, LBM_OPEN, LBM_SLIP, LBM_SLIP,
                                                           LBM_WALL, LBM_OPEN},
                                                 .scalars = LBM_MAX_SCALARS,
                                                 .subgrid = true,
                                                 .force = true,
                                                 .outflow = true,
                                                 .bodies = true});
        if (!l || !lbm_build(l, NULL, library, NULL)) fail_msg("%s", err_get());
        lbm_destroy(l, NULL);
    }
    shader_library_destroy(library);
    arena_free(&memory);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_lists_are_as_long_as_their_names_say),
        cmocka_unit_test(every_direction_is_there_once_and_its_opposite_beside_it),
        cmocka_unit_test(moments_of_the_weights_are_isotropic),
        cmocka_unit_test(mirrors_exchange_what_goes_up_and_down),
        cmocka_unit_test(a_state_fits_into_what_a_device_binds),
        cmocka_unit_test(what_does_not_fit_is_refused_with_numbers),
        cmocka_unit_test(a_lattice_that_cannot_be_is_refused),
        cmocka_unit_test(all_that_a_step_can_do_compiles_for_a_card),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
