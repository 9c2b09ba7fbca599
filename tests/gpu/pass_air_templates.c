// Templates in simulated air: where they are, how pictures are made deep, and what the air makes of
// them.
#include "air_templates_test.h"
#include "long_test.h"

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
// `slack`: of what a level of the picture smears outwards, and of how cells see what flows.
static void check_flux(gpu *g, const char *type, const char *cells, const char *depth, int steps,
                       double slack) {
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
    assert_true(fabs(seen[0] / expected - 1) < slack);
    assert_true(fabs(seen[1] / expected + 1) < slack);
}

static void pressure_lets_as_much_out_as_it_says(void **state) {
    check_flux(*state, "pyro", "full", "revolve", 5, 0.03);
    check_flux(*state, "pyro", "full", "extrude", 5, 0.012);
    if (!sim_long_tests("pressure in the lattice, and in half the velocity")) return;
    check_flux(*state, "pyro", "half", "revolve", 5, 0.06);
    check_flux(*state, "lbm", NULL, "revolve", 120, 0.03);
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
        assert_true(fabs(sum[2] / expected - 1) < (k % 2 == 0 ? 0.012 : 0.003));
        assert_true(fabs(sum[0]) < 1e-3 * expected && fabs(sum[1]) < 1e-3 * expected);
        mem_free(f.v);
        world_close(&t.w);
    }
}

// ---- lives ------------------------------------------------------------------------------------

// Lives end and begin anew elsewhere, within their bounds, whichever frames the steps are in.
static void lives_end_and_begin_elsewhere(void **state) {
    enum { COUNT = 60, STEPS = 30 };
    air_seen *last[2];
    for (int k = 0; k < 2; k++) {
        air_world t;
        open_air(&t, *state, "pyro", "open");
        pass *p = air_test_group(&t);
        air_test_set(&t, p, "lifetime_min", 0.1f);
        air_test_set(&t, p, "lifetime_max", 0.3f);
        air_test_set(&t, p, "size_min", 0.6f);
        air_test_set(&t, p, "size_max", 1.2f);
        air_test_add(&t, p, library_picture(&t.w.memory, "source"), COUNT);
        air_test_build(&t);
        for (int i = 0; k == 0 && i < STEPS; i++) air_test_run(&t, 1);
        if (k == 1) air_test_run(&t, STEPS);
        air_seen *seen = last[k] = air_test_read(&t);
        double lives = 0;
        for (int i = 0; i < COUNT; i++) {
            const air_seen *s = &seen[i];
            lives += (double)s->life - 1;
            assert_true(s->side >= 0.6f && s->side < 1.2f && s->age >= 0 && s->age < s->lifetime);
            assert_true(s->lifetime >= 0.1f && s->lifetime < 0.3f);
            const float half = fmaxf(s->side / 0.4f, 2); // texels of 0.2 m
            assert_true(fabsf(s->half_side - half) < 1e-4f);
            for (int axis = 0; axis < 3; axis++) {
                assert_true(s->put[axis] >= 0 && s->put[axis] < AIR_SIDE);
                assert_true(fabsf(2 * s->middle[axis] - s->put[axis]) < 1e-4f);
            }
        }
        // The mean of the rest of a life and those after it: time / 0.2 s.
        print_message("%.2f lives have ended in 0.6 s; theory 3\n", lives / COUNT);
        assert_true(fabs(lives / COUNT - 3) < 0.24);
        air_test_set(&t, p, "amount", 0.5f);
        air_test_run(&t, 1);
        seen = air_test_read(&t);
        int acting = 0;
        for (int i = 0; i < COUNT; i++) acting += seen[i].half_side > 0;
        assert_int_equal(acting, COUNT / 2);
        mem_free(seen);
        air_test_set(&t, p, "amount", 0);
        air_test_run(&t, 1);
        float(*image)[4] = air_test_image(&t);
        for (int i = 0; i < AIR_TEXELS * AIR_TEXELS * AIR_TEXELS; i++)
            for (int c = 0; c < 4; c++) assert_true(image[i][c] == 0);
        mem_free(image);
        world_close(&t.w);
    }
    assert_memory_equal(last[0], last[1], COUNT * sizeof **last);
    mem_free(last[0]);
    mem_free(last[1]);
}

// ---- places and turns -------------------------------------------------------------------------

static const float centre[3] = {0, 0, 1.6f};

static void place_of(const air_seen *s, float out[3]) { // m, from the middle of the box
    for (int i = 0; i < 3; i++) out[i] = 0.1f * (s->put[i] - AIR_SIDE / 2);
}

static float dot(const float a[3], const float b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

enum { TURNED = 400 };

// As they begin, in a ball of 1.2 m.
static air_seen *turned(air_world *t, const char *align, const field *direction,
                        const field *region) {
    pass *p = air_test_group(t);
    gpu_test_ok(pass_set_field(p, "region", region ? region : air_test_ball(t, 0, 0, 1.6f, 1.2f)));
    air_test_word(p, "align", align);
    gpu_test_ok(pass_set_uniform(p, "center", triple(&t->w, centre[0], centre[1], centre[2])));
    if (direction) gpu_test_ok(pass_set_field(p, "direction", direction));
    air_test_add(t, p, library_picture(&t->w.memory, "jet"), TURNED);
    air_test_build(t);
    air_test_run(t, 1);
    air_seen *seen = air_test_read(t);
    for (int i = 0; i < TURNED; i++) {
        float at[3];
        place_of(&seen[i], at);
        assert_true(seen[i].is_put == 1 && dot(at, at) <= 1.21f * 1.21f);
        assert_true(fabsf(dot(seen[i].up, seen[i].up) - 1) < 1e-4f);
        assert_true(fabsf(dot(seen[i].right, seen[i].right) - 1) < 1e-4f);
        assert_true(fabsf(dot(seen[i].up, seen[i].right)) < 1e-4f);
    }
    return seen;
}

static void they_look_where_they_are_told_to(void **state) {
    enum { FIXED, RADIAL, DIRECTION, CONTOUR, WAYS };
    static const char *const words[WAYS] = {"fixed", "radial", "direction", "contour"};
    for (int k = 0; k < WAYS; k++) {
        air_world t;
        open_air(&t, *state, "pyro", "open");
        // A vector that is not the same in two places, and not of length 1.
        const field *places = row(&t.w, "position"), *factor = triple(&t.w, 3, -2, 1);
        const field *factors[FIELD_MAX_ARGS] = {places, factor};
        const field *varied = field_make(&t.w.memory, "mul", factors, NULL);
        const field *soft =
            row(&t.w, "sphere", SET("position", triple(&t.w, 0, 0, 1.6f)),
                SET("radius", number(&t.w, 1.2f)), SET("falloff", number(&t.w, 0.6f)));
        air_seen *seen =
            turned(&t, words[k], k == DIRECTION ? varied : NULL, k == CONTOUR ? soft : NULL);
        double mean = 0, least = 1;
        for (int i = 0; i < TURNED; i++) {
            float at[3], aim[3] = {0, 0, 1};
            place_of(&seen[i], at);
            if (k == RADIAL || k == CONTOUR) memcpy(aim, at, sizeof aim);
            if (k == DIRECTION) {
                const float v[3] = {3 * at[0], -2 * at[1], at[2] + centre[2]};
                memcpy(aim, v, sizeof aim);
            }
            const float length = sqrtf(dot(aim, aim));
            if (length < 0.2f) continue; // of the contour: as far in all directions
            const double along = (double)(dot(seen[i].up, aim) / length);
            mean += along / TURNED;
            least = fmin(least, along);
        }
        print_message("%s: along what they follow, mean %.4f, least %.4f\n", words[k], mean, least);
        assert_true(k == CONTOUR ? mean > 0.956 : least > 0.9999);
        mem_free(seen);
        world_close(&t.w);
    }
}

// Along the way that the air goes, which a source gives all of it here.
static void they_look_along_the_flow(void **state) {
    for (int k = 0; k < 2; k++) {
        air_world t;
        open_air(&t, *state, kinds[k], "open");
        char source[32];
        snprintf(source, sizeof source, "%s_source", kinds[k]);
        pass *s = world_add(&t.w, source, NULL, "source");
        gpu_test_ok(pass_set_field(s, "shape", air_test_ball(&t, 0, 0, 1.6f, 4)));
        gpu_test_ok(pass_set_field(s, "velocity", triple(&t.w, 0.2f, -0.3f, 0.6f)));
        gpu_test_ok(pass_declare(s) && pass_air_add_source(t.pass, s));
        air_seen *seen = turned(&t, "flow", NULL, NULL);
        const float way[3] = {0.2f / 0.7f, -0.3f / 0.7f, 0.6f / 0.7f};
        double least = 1;
        for (int i = 0; i < TURNED; i++) least = fmin(least, (double)dot(seen[i].up, way));
        print_message("%s: along the flow, least %.5f\n", kinds[k], least);
        assert_true(least > 0.9999);
        mem_free(seen);
        world_close(&t.w);
    }
}

// By `angle` all of them about the picture's depth, anticlockwise; by `spread` each about any axis.
static void they_are_turned_besides(void **state) {
    for (int k = 0; k < 2; k++) {
        air_world t;
        open_air(&t, *state, "pyro", "open");
        pass *p = air_test_group(&t);
        air_test_word(p, "align", "fixed");
        air_test_set(&t, p, k ? "spread" : "angle", 30);
        air_test_add(&t, p, library_picture(&t.w.memory, "jet"), TURNED);
        air_test_build(&t);
        air_test_run(&t, 1);
        air_seen *seen = air_test_read(&t);
        double mean = 0;
        for (int i = 0; i < TURNED; i++) {
            const float *up = seen[i].up, *right = seen[i].right;
            mean += acos(fmin((double)up[2], 1)) * 180 / acos(-1) / TURNED;
            assert_true(fabsf(dot(up, right)) < 1e-4f && (double)up[2] > cos(acos(-1) / 6) - 1e-4);
            if (k == 0) assert_true(fabsf(up[0] + 0.5f) < 1e-4f && fabsf(right[2] - 0.5f) < 1e-4f);
        }
        // A turn by a about an axis of any direction leaves an edge a pi / 4 off, nearly: the mean
        // of the sine of the angle between them.
        print_message("turned by %.2f degrees; theory %.2f\n", mean, k ? 15 * acos(-1) / 4 : 30);
        assert_true(fabs(mean - (k ? 15 * acos(-1) / 4 : 30)) < (k ? 1.2 : 0.01));
        mem_free(seen);
        world_close(&t.w);
    }
}

// Any way means all alike: the mean of directions is 0, and that of the square of each component
// 1/3.
static void they_look_any_way_where_none_is_told(void **state) {
    air_world t;
    open_air(&t, *state, "lbm", "open");
    air_seen *seen = turned(&t, "none", NULL, NULL);
    double mean[3] = {0}, square[3] = {0};
    for (int i = 0; i < TURNED; i++)
        for (int axis = 0; axis < 3; axis++) {
            mean[axis] += (double)seen[i].up[axis] / TURNED;
            square[axis] += pow((double)seen[i].right[axis], 2) / TURNED;
        }
    print_message("mean of up %.3f %.3f %.3f, of squares of right %.3f %.3f %.3f\n", mean[0],
                  mean[1], mean[2], square[0], square[1], square[2]);
    for (int axis = 0; axis < 3; axis++) { // 4 standard deviations
        assert_true(fabs(mean[axis]) < 4 * sqrt(1.0 / 3 / TURNED));
        assert_true(fabs(square[axis] - 1.0 / 3) < 4 * sqrt(4.0 / 45 / TURNED));
    }
    mem_free(seen);
    world_close(&t.w);
}

// ---- pictures ---------------------------------------------------------------------------------

static const float *texel_at(float (*image)[4], int x, int y, int z) {
    return image[x + AIR_TEXELS * (y + AIR_TEXELS * z)];
}

// Seen along its depth a picture is itself, however deep: a vortex turns about the y axis. Extruded
// it is as strong along all of a tube but for the Gaussian; a source revolved is the same all
// around.
static void check_vortex(float (*image)[4], bool extruded) {
    enum { MIDDLE = AIR_TEXELS / 2 };
    // Two texels right of the axis, above it, left and below. The middle of the box is between two.
    static const int around[4][2] = {{2, 0}, {0, 2}, {-3, 0}, {0, -3}};
    for (int k = 0; k < 4; k++) {
        const int x = MIDDLE + around[k][0], z = MIDDLE + around[k][1];
        const float rx = (float)x + 0.5f - MIDDLE, rz = (float)z + 0.5f - MIDDLE;
        const float *near = texel_at(image, x, MIDDLE, z), *far = texel_at(image, x, MIDDLE + 1, z);
        const float round = near[2] * rx - near[0] * rz, out = near[0] * rx + near[2] * rz;
        assert_true(round > 0.5f && fabsf(out) < 0.05f * round && fabsf(near[1]) < 0.2f * round);
        if (!extruded) continue;
        assert_true(fabsf(out) < 0.01f * round && fabsf(near[1]) < 1e-3f * round);
        // By the Gaussian of its depth: half a texel and one and a half of 4, by 0.3.
        const float fades = expf(-0.5f * (1.5f * 1.5f - 0.5f * 0.5f) / (16 * 0.09f));
        assert_true(fabsf(far[2] * rx - far[0] * rz - fades * round) < 0.003f * round);
    }
}

static void check_source(float (*image)[4]) {
    enum { MIDDLE = AIR_TEXELS / 2 };
    const float *here = texel_at(image, MIDDLE + 2, MIDDLE, MIDDLE);
    const float *there = texel_at(image, MIDDLE, MIDDLE + 2, MIDDLE);
    assert_true(here[3] > 0.1f && fabsf(here[3] - there[3]) < 0.003f * here[3]);
    for (int i = 0; i < 4; i++) { // mirrored
        const int x = i & 1 ? MIDDLE + 2 : MIDDLE - 3, y = i & 2 ? MIDDLE + 1 : MIDDLE - 2;
        const float *one = texel_at(image, x, y, MIDDLE), *two = texel_at(image, y, x, MIDDLE);
        assert_true(fabsf(one[3] - two[3]) < 0.003f * one[3]);
    }
}

static void pictures_are_made_deep(void **state) {
    static const char *const depths[] = {"revolve", "extrude"};
    for (int k = 0; k < 2; k++) {
        air_world t;
        open_air(&t, *state, "lbm", "open");
        const picture *vortex = library_picture(&t.w.memory, "vortex_left");
        air_test_middle(&t, vortex, "velocity", depths[k], side, 10);
        const picture *source = library_picture(&t.w.memory, "source");
        air_test_middle(&t, source, "pressure", "revolve", side, 10);
        air_test_build(&t);
        air_test_run(&t, 1);
        float(*image)[4] = air_test_image(&t);
        check_vortex(image, k == 1);
        check_source(image);
        mem_free(image);
        world_close(&t.w);
    }
}

// What the air is pushed by besides stays.
static void they_add_to_the_force_that_there_is(void **state) {
    float(*images[2])[4];
    for (int k = 0; k < 2; k++) {
        air_world t;
        air_test_open(&t, *state, "pyro", "open");
        const field *factors[FIELD_MAX_ARGS] = {row(&t.w, "position"), triple(&t.w, 1, 2, 3)};
        gpu_test_ok(pass_set_field(t.pass, "force", field_make(&t.w.memory, "mul", factors, NULL)));
        air_test_declare(&t);
        air_test_middle(&t, even_picture(&t, 0, 1, 0), "velocity", "revolve", side, k ? 8 : 0);
        air_test_build(&t);
        air_test_run(&t, 2);
        images[k] = air_test_image(&t);
        world_close(&t.w);
    }
    for (int z = 0; z < AIR_TEXELS; z++)
        for (int x = 0; x < AIR_TEXELS; x++) {
            const float *plain = texel_at(images[0], x, 3, z), *more = texel_at(images[1], x, 3, z);
            assert_true(fabsf(plain[0] - 0.2f * ((float)x + 0.5f - AIR_TEXELS / 2)) < 2e-3f);
            assert_true(fabsf(plain[2] - 0.6f * ((float)z + 0.5f)) < 1e-2f);
            assert_true(more[0] == plain[0] && more[1] == plain[1] && more[2] >= plain[2]);
        }
    const int m = AIR_TEXELS / 2;
    const float gained = texel_at(images[1], m, m, m)[2] - texel_at(images[0], m, m, m)[2];
    // Half a texel of 4 from the middle along each axis, by a Gaussian of 0.3.
    const float expected = 8 * expf(-0.5f * 3 * 0.25f / (16 * 0.09f));
    print_message("in the middle %.3f more; theory %.3f\n", (double)gained, (double)expected);
    assert_true(fabsf(gained / expected - 1) < 0.03f);
    mem_free(images[0]);
    mem_free(images[1]);
}

// ---- by what the air holds --------------------------------------------------------------------

// The left half of the box holds something: templates are put there alone, and are as strong as it.
static void check_held(gpu *g, const char *type, const char *what, float value, float factor) {
    air_world t;
    open_air(&t, g, type, "open");
    char source[32];
    snprintf(source, sizeof source, "%s_source", type);
    pass *s = world_add(&t.w, source, NULL, "source");
    const field *left = row(&t.w, "box", SET("position", triple(&t.w, -0.8f, 0, 1.6f)),
                            SET("size", triple(&t.w, 1.6f, 4, 4)), SET("falloff", number(&t.w, 0)));
    gpu_test_ok(pass_set_field(s, "shape", left));
    gpu_test_ok(pass_set_field(s, what, number(&t.w, value)));
    gpu_test_ok(pass_declare(s) && pass_air_add_source(t.pass, s));
    pass *p = air_test_group(&t);
    air_test_word(p, "within", what);
    air_test_word(p, "scale_by", what);
    air_test_set(&t, p, "above", 0.9f * value);
    air_test_set(&t, p, "fade", 0);
    air_test_set(&t, p, "strength", 3);
    air_test_add(&t, p, library_picture(&t.w.memory, "source"), 100);
    air_test_build(&t);
    air_test_run(&t, 1);
    air_seen *seen = air_test_read(&t);
    int deep = 0;
    for (int i = 0; i < 100; i++) {
        assert_true(seen[i].is_put == 1 && seen[i].put[0] < AIR_SIDE / 2);
        if (seen[i].put[0] > AIR_SIDE / 2 - 3) continue; // its half side reaches beyond
        if (fabsf(seen[i].factor - 3 * factor) > 0.01f * 3 * factor)
            fail_msg("%s: factor %g, not %g", what, (double)seen[i].factor, (double)(3 * factor));
        deep++;
    }
    assert_true(deep > 60);
    mem_free(seen);
    world_close(&t.w);
}

static void they_go_by_what_the_air_holds(void **state) {
    check_held(*state, "pyro", "soot", 0.01f, 0.01f);
    check_held(*state, "pyro", "temperature", 1293, 1);
    check_held(*state, "lbm", "temperature", 2, 2);
    if (!sim_long_tests("templates by fuel, density and dye")) return;
    check_held(*state, "pyro", "fuel", 0.05f, 0.05f);
    check_held(*state, "lbm", "density", 0.5f, 0.5f);
    check_held(*state, "lbm", "dye", 0.25f, 0.25f);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(pressure_lets_as_much_out_as_it_says),
        cmocka_unit_test(velocity_gives_the_momentum_it_says),
        cmocka_unit_test(lives_end_and_begin_elsewhere),
        cmocka_unit_test(they_look_where_they_are_told_to),
        cmocka_unit_test(they_look_along_the_flow),
        cmocka_unit_test(they_are_turned_besides),
        cmocka_unit_test(they_look_any_way_where_none_is_told),
        cmocka_unit_test(pictures_are_made_deep),
        cmocka_unit_test(they_add_to_the_force_that_there_is),
        cmocka_unit_test(they_go_by_what_the_air_holds),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
