// What the pass lighting says about light in a volume, against what is known of simple ones.
#include "pass_test.h"

enum { SIZE = 16 };

typedef struct place {
    double x, y, z;
} place;

typedef struct probe { // a square of points, 16 x 16
    const char *shows;
    int index;
    place corner, across, down;
    place way; // of scattered light
    double g;
} probe;

static const field *at(pass_world *w, place p) {
    return triple(w, (float)p.x, (float)p.y, (float)p.z);
}

static place point(probe q, int i) {
    double u = (i % SIZE + 0.5) / SIZE, v = (i / SIZE + 0.5) / SIZE;
    return (place){q.corner.x + u * q.across.x + v * q.down.x,
                   q.corner.y + u * q.across.y + v * q.down.y,
                   q.corner.z + u * q.across.z + v * q.down.z};
}

static pass *add_lighting(pass_world *w, const field *density) {
    pass *p = world_add(w, "lighting", NULL, "lighting");
    gpu_test_ok(pass_set_field(p, "density", density));
    gpu_test_ok(pass_set_option(p, "fire_lights", "0"));
    gpu_test_ok(pass_set_uniform(p, "sweeps", number(w, 0)));
    return p;
}

// Reads the probe's RGBA; free with mem_free.
static float *look(pass_world *w, pass *lighting, probe q) {
    gpu_test_ok(pass_declare(lighting));
    pass *p = world_add(w, NULL, "lit.comp", "lit");
    pass_add_source(p, lighting);
    gpu_test_ok(pass_set_option(p, "shows", q.shows));
    gpu_test_ok(pass_set_uniform(p, "index", number(w, (float)q.index)));
    gpu_test_ok(pass_set_uniform(p, "corner", at(w, q.corner)));
    gpu_test_ok(pass_set_uniform(p, "across", at(w, q.across)));
    gpu_test_ok(pass_set_uniform(p, "down", at(w, q.down)));
    gpu_test_ok(pass_set_uniform(p, "way", at(w, q.way)));
    gpu_test_ok(pass_set_uniform(p, "g", number(w, (float)q.g)));
    gpu_test_ok(pass_declare(p));
    graph_image seen = pass_output(p, "color");
    world_render(w, SIZE, SIZE, seen);
    float *out = mem_alloc(SIZE * SIZE * 4 * sizeof *out);
    gpu_test_ok(gpu_image_read(w->host.device, graph_get_image(w->host.graph, seen), out,
                               SIZE * SIZE * 4 * sizeof *out));
    return out;
}

static void near(double got, double wanted, double tolerance, probe q, int i) {
    place p = point(q, i);
    if (!(fabs(got - wanted) <= tolerance))
        fail_msg("at %.3f %.3f %.3f: %.5f, not %.5f (+- %g)", p.x, p.y, p.z, got, wanted,
                 tolerance);
}

// ---- shadows ----------------------------------------------------------------------------------

// Metres in the cube -1..1 of the way from `from` to `to`.
static double inside(place from, place to) {
    const double o[] = {from.x, from.y, from.z};
    const double d[] = {to.x - from.x, to.y - from.y, to.z - from.z};
    double near = 0, far = 1;
    for (int i = 0; i < 3; i++) {
        double slope = fabs(d[i]) < 1e-12 ? 1e-12 : d[i];
        double a = (-1 - o[i]) / slope, b = (1 - o[i]) / slope;
        near = fmax(near, fmin(a, b));
        far = fmin(far, fmax(a, b));
    }
    return fmax(far - near, 0) * sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

// A cube of density 1.5 lit by a light; the square cuts through it and reaches out of it.
static const probe cut = {"shadow", 0, {-1.4, 0.3, 1.4}, {2.8, 0, 0}, {0, 0.2, -2.8}, {0, 0, 0}, 0};

static void check_cube(pass_world *w, int index, place light, double tolerance) {
    pass *lighting = add_lighting(w, block(w, 1, 1.5f));
    probe q = cut;
    q.index = index;
    float *seen = look(w, lighting, q);
    double most = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        double wanted = 1.5 * inside(point(q, i), light);
        near((double)seen[4 * i], wanted, tolerance, q, i);
        assert_true(seen[4 * i + 1] == 1);
        most = fmax(most, wanted);
    }
    assert_true(most > 2);
    mem_free(seen);
}

static void sun_has_passed_the_cube_as_far_as_it_has(void **state) {
    for (float elevation = 20; elevation <= 90; elevation += 35) {
        pass_world w;
        world_open(&w, *state);
        w.scene.sun.strength = number(&w, 1);
        w.scene.sun.azimuth = number(&w, 30);
        w.scene.sun.elevation = number(&w, elevation);
        double a = GLM_PI / 6, e = (double)elevation * GLM_PI / 180;
        check_cube(&w, 0, (place){1e4 * cos(a) * cos(e), 1e4 * sin(a) * cos(e), 1e4 * sin(e)},
                   0.06);
        world_close(&w);
    }
}

static void lamp_has_passed_the_cube_wherever_it_is(void **state) {
    static const place lamps[] = {{4, 3, 5}, {0.2, -1.5, 0.4}, {0.31, 0.15, -0.23}};
    for (size_t i = 0; i < COUNT_OF(lamps); i++) {
        pass_world w;
        world_open(&w, *state);
        scene_light lamp = {.kind = SCENE_POINT,
                            .position = at(&w, lamps[i]),
                            .color = triple(&w, 1, 1, 1),
                            .power = number(&w, 10),
                            .radius = number(&w, 0)};
        w.scene.lights = &lamp;
        w.scene.light_count = 1;
        check_cube(&w, 1, lamps[i], i ? 0.12 : 0.06);
        world_close(&w);
    }
}

// ---- fire -------------------------------------------------------------------------------------

// A ball of radius 0.3 that gives off light, hardly any smoke; a square of points below it.
static void fire_lights_its_surroundings_like_a_lamp(void **state) {
    static const char *const counts[] = {"1", "8"};
    for (size_t k = 0; k < COUNT_OF(counts); k++) {
        pass_world w;
        world_open(&w, *state);
        const place centre = {0.4, -0.2, 1};
        const field *ball = row(&w, "sphere", SET("position", at(&w, centre)),
                                SET("radius", number(&w, 0.3f)), SET("falloff", number(&w, 0)));
        const field *factors[FIELD_MAX_ARGS] = {ball, number(&w, 0.01f)};
        pass *p = add_lighting(&w, field_make(&w.memory, "mul", factors, NULL));
        gpu_test_ok(pass_set_option(p, "fire_lights", counts[k]));
        gpu_test_ok(pass_set_field(p, "emission", triple(&w, 7, 3.5f, 0)));
        probe q = {"irradiance", 0, {-3, -3, -0.5}, {6, 0, 0}, {0, 6, 0}, {0, 0, 0}, 0};
        float *seen = look(&w, p, q);
        double intensity = 7 * 4 / 3.0 * GLM_PI * 0.027;
        for (int i = 0; i < SIZE * SIZE; i++) {
            place to = point(q, i);
            double x = to.x - centre.x, y = to.y - centre.y, z = to.z - centre.z;
            double wanted = intensity / (x * x + y * y + z * z);
            near((double)seen[4 * i], wanted, 0.03 * wanted, q, i);
            near((double)seen[4 * i + 1], 0.5 * wanted, 0.02 * wanted, q, i);
            assert_true(seen[4 * i + 2] == 0);
        }
        mem_free(seen);
        world_close(&w);
    }
}

// One half of the ball of fire is in thick smoke: it shines to the other side.
static void fire_shines_where_no_smoke_is_in_its_way(void **state) {
    pass_world w;
    world_open(&w, *state);
    const field *ball =
        row(&w, "sphere", SET("radius", number(&w, 1)), SET("falloff", number(&w, 0)));
    const field *smoke = row(&w, "box", SET("position", triple(&w, 0, 0, 0.6f)),
                             SET("size", triple(&w, 2, 2, 0.8f)), SET("falloff", number(&w, 0)));
    const field *thick[FIELD_MAX_ARGS] = {smoke, number(&w, 20)},
                *thin[FIELD_MAX_ARGS] = {ball, number(&w, 0.01f)};
    const field *both[FIELD_MAX_ARGS] = {field_make(&w.memory, "mul", thick, NULL),
                                         field_make(&w.memory, "mul", thin, NULL)};
    pass *p = add_lighting(&w, field_make(&w.memory, "add", both, NULL));
    gpu_test_ok(pass_set_option(p, "fire_lights", "8"));
    const field *glowing[FIELD_MAX_ARGS] = {ball, number(&w, 5)};
    gpu_test_ok(pass_set_field(p, "emission", field_make(&w.memory, "mul", glowing, NULL)));
    probe q = {"irradiance", 0, {-0.1, -0.1, -6}, {0.2, 0, 0}, {0, 0, 12}, {0, 0, 0}, 0};
    float *seen = look(&w, p, q);
    const float *below = seen + 4 * 8, *above = seen + 4 * (15 * SIZE + 8);
    assert_true(below[0] > 4 * above[0] && above[0] >= 0);
    mem_free(seen);
    world_close(&w);
}

// ---- glow -------------------------------------------------------------------------------------

static void set_sky(pass_world *w, float radiance) {
    w->scene.sky.strength = number(w, 1);
    w->scene.sky.zenith = w->scene.sky.horizon = triple(w, radiance, radiance, radiance);
}

// A sphere of smoke with ragged density in a sky of radiance 1 that loses nothing: light is 1
// everywhere, into every direction.
static void furnace_is_as_bright_as_its_walls(void **state) {
    for (float density = 0.3f; density < 10; density *= 25) {
        pass_world w;
        world_open(&w, *state);
        set_sky(&w, 1);
        const field *ball = row(&w, "sphere", SET("radius", number(&w, 1)));
        const field *factors[FIELD_MAX_ARGS] = {ball, number(&w, density)};
        pass *p = add_lighting(&w, field_make(&w.memory, "mul", factors, NULL));
        gpu_test_ok(pass_set_option(p, "glow_resolution", "32"));
        gpu_test_ok(pass_set_uniform(p, "albedo", triple(&w, 1, 1, 1)));
        gpu_test_ok(pass_set_uniform(p, "anisotropy", number(&w, 0.5f)));
        gpu_test_ok(pass_set_uniform(p, "sweeps", number(&w, 3)));
        probe q = {"scattered", 0, {-0.9, -0.9, 0.1}, {1.8, 0, 0}, {0, 1.8, 0}, {0, 0.6, 0.8}, 0.5};
        float *seen = look(&w, p, q);
        for (int i = 0; i < SIZE * SIZE; i++) near((double)seen[4 * i], 1, 0.03, q, i);
        mem_free(seen);
        world_close(&w);
    }
}

// Smoke without scattering, so wide that its middle knows no sides, gives off light: directions of
// a cosine see 1 - exp(-depth / cosine) of it, up and down. Near the faces light comes from the
// sides mostly, of which the pass has few directions.
static void emission_is_that_of_a_slab(void **state) {
    pass_world w;
    world_open(&w, *state);
    const field *args[FIELD_MAX_ARGS] = {triple(&w, 0, 0, 0), triple(&w, 40, 40, 2), number(&w, 0)};
    const field *factors[FIELD_MAX_ARGS] = {field_make(&w.memory, "box", args, NULL),
                                            number(&w, 0.8f)};
    pass *p = add_lighting(&w, field_make(&w.memory, "mul", factors, NULL));
    gpu_test_ok(pass_set_uniform(p, "albedo", triple(&w, 0, 0, 0)));
    gpu_test_ok(pass_set_field(p, "radiance", triple(&w, 2, 1, 0)));
    probe q = {"scattered", 0, {0.1, 0.1, -0.99}, {0.2, 0, 0}, {0, 0, 1.98}, {0, 0, 1}, 0};
    float *seen = look(&w, p, q);
    for (int i = 0; i < SIZE * SIZE; i++) {
        const int steps = 2000;
        double wanted = 0, depth = 0.8 * (point(q, i).z + 1);
        for (int k = 0; k < steps; k++) {
            double cosine = (k + 0.5) / steps;
            wanted += (2 - exp(-depth / cosine) - exp((depth - 1.6) / cosine)) / steps;
        }
        near((double)seen[4 * i], wanted, 0.06 * wanted, q, i);
        near((double)seen[4 * i + 1], 0.5 * (double)seen[4 * i], 1e-3, q, i);
    }
    mem_free(seen);
    world_close(&w);
}

static void meshes_throw_shadows_into_the_volume(void **state) {
    pass_world w;
    world_open(&w, *state);
    w.scene.sun.strength = number(&w, 1);
    w.scene.sun.elevation = number(&w, 90);
    scene_mesh *crate = world_mesh(&w, "crate.obj"); // 2 m wide
    crate->scale = number(&w, 0.25f);
    pass *p = add_lighting(&w, block(&w, 1, 0.1f));
    probe q = {"shadow", 0, {-0.95, 0.05, 0.95}, {1.9, 0, 0}, {0, 0, -1.9}, {0, 0, 0}, 0};
    float *seen = look(&w, p, q);
    for (int i = 0; i < SIZE * SIZE; i++) {
        place at_ = point(q, i);
        double x = fabs(at_.x), z = at_.z;
        bool edge = fabs(x - 0.25) < 0.03 || (x < 0.25 && fabs(z - 0.25) < 0.06);
        if (!edge) near((double)seen[4 * i + 1], x < 0.25 && z < 0.25 ? 0 : 1, 1e-3, q, i);
    }
    mem_free(seen);
    world_close(&w);
}

// Hardly any smoke, some of it buried in wide ground that sends back a quarter, under a sky of
// radiance 1 and a sun in the zenith that gives the ground as much again: from below comes half as
// much as from above.
static void ground_sends_back_what_falls_on_it(void **state) {
    pass_world w;
    world_open(&w, *state);
    set_sky(&w, 1);
    w.scene.sun.strength = number(&w, GLM_PIf);
    w.scene.sun.elevation = number(&w, 90);
    scene_mesh *crate = world_mesh(&w, "crate.obj"); // 2 m wide, sends back 0.6
    crate->scale = number(&w, 1000);
    crate->position = triple(&w, 0, 0, -1000.5f);
    crate->color = triple(&w, 0.25f / 0.6f, 0.25f / 0.6f, 0);
    pass *p = add_lighting(&w, block(&w, 1, 0.005f));
    probe q = {"scattered", 0, {-0.9, -0.9, 0.1}, {1.8, 0, 0}, {0, 1.8, 0}, {0, 0, 1}, 0};
    float *seen = look(&w, p, q);
    for (int i = 0; i < SIZE * SIZE; i++) {
        near((double)seen[4 * i], 0.75, 0.02, q, i);
        near((double)seen[4 * i + 2], 0.5, 0.02, q, i);
    }
    mem_free(seen);
    world_close(&w);
}

static void too_many_shadows_are_refused(void **state) {
    pass_world w;
    world_open(&w, *state);
    w.scene.light_count = 20;
    pass *p = add_lighting(&w, block(&w, 1, 1));
    gpu_test_ok(pass_set_option(p, "shadow_resolution", "128"));
    assert_false(pass_declare(p));
    assert_non_null(strstr(err_get(), "at most 97"));
    w.scene.light_count = 0;
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(sun_has_passed_the_cube_as_far_as_it_has),
        cmocka_unit_test(lamp_has_passed_the_cube_wherever_it_is),
        cmocka_unit_test(fire_lights_its_surroundings_like_a_lamp),
        cmocka_unit_test(fire_shines_where_no_smoke_is_in_its_way),
        cmocka_unit_test(furnace_is_as_bright_as_its_walls),
        cmocka_unit_test(emission_is_that_of_a_slab),
        cmocka_unit_test(meshes_throw_shadows_into_the_volume),
        cmocka_unit_test(ground_sends_back_what_falls_on_it),
        cmocka_unit_test(too_many_shadows_are_refused),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
