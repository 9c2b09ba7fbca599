// Lamps of `point_lights` on a wall at y = 0 that faces the camera, which stands at (0, -5, 0).
#include "pass/lamps.h"
#include "pass_test.h"

enum { SIZE = 48, PIXELS = SIZE * SIZE };

static const float part = 0.8f; // of the light that plane.obj sends back, times its colour here

static const field *of(pass_world *w, const char *kind, const field *a, const field *b) {
    const field *args[FIELD_MAX_ARGS] = {a, b};
    const field *made = field_make(&w->memory, kind, args, NULL);
    gpu_test_ok(made);
    return made;
}

// low + (high - low) * fract(index * step): spread over a range, another for each lamp.
static const field *spread(pass_world *w, float step, float low, float high) {
    const field *index = of(w, "light_index", NULL, NULL);
    const field *share = of(w, "fract", of(w, "mul", index, number(w, step)), NULL);
    return of(w, "add", number(w, low), of(w, "mul", share, number(w, high - low)));
}

static const field *vector(pass_world *w, const field *x, const field *y, const field *z) {
    const field *args[FIELD_MAX_ARGS] = {x, y, z};
    const field *made = field_make(&w->memory, "vec", args, NULL);
    gpu_test_ok(made);
    return made;
}

static pass *add_lamps(pass_world *w, uint32_t count) {
    pass *p = world_add(w, "point_lights", NULL, "lamps");
    gpu_test_ok(pass_lamps_open(p, count));
    return p;
}

static void set(pass *p, const char *name, const field *value) {
    gpu_test_ok(pass_set_field(p, name, value));
}

// A shade of all meshes, lit by the lamps.
static pass *add_shade(pass_world *w, pass *lamps, const char *way) {
    gpu_test_ok(pass_declare(lamps));
    pass *geometry = world_add(w, "geometry", NULL, "geometry");
    for (size_t i = 0; i < w->mesh_count; i++) gpu_test_ok(pass_add_mesh(geometry, &w->meshes[i]));
    gpu_test_ok(pass_declare(geometry));
    pass *p = world_add(w, "shade", NULL, "shade");
    gpu_test_ok(pass_set_option(p, "lamps_by", way));
    pass_add_source(p, geometry);
    pass_add_source(p, lamps);
    return p;
}

static float *render(pass_world *w, pass *shade, uint32_t size) {
    gpu_test_ok(pass_declare(shade));
    world_render(w, size, size, pass_output(shade, "color"));
    return world_read(w, pass_output(shade, "color"));
}

static scene_mesh *add_wall(pass_world *w) {
    scene_mesh *wall = world_mesh(w, "plane.obj");
    wall->scale = number(w, 200);
    float color = part / wall->data.parts[0].color[0];
    wall->color = triple(w, color, color, color);
    return wall;
}

// Where the ray of a pixel meets the wall.
static void wall_point(const pass_world *w, size_t i, double *x, double *z) {
    double u = ((double)(i % SIZE) + 0.5) / SIZE, v = ((double)(i / SIZE) + 0.5) / SIZE;
    *x = 5 * (2 * u - 1) * (double)w->frame.lens.v[0];
    *z = 5 * (1 - 2 * v) * (double)w->frame.lens.v[1];
}

static void expect_near(float got, double want, double tolerance, const char *what, size_t i) {
    if (!(fabs((double)got - want) <= tolerance))
        fail_msg("%s, pixel (%zu, %zu): %.6f, not %.6f", what, i % SIZE, i / SIZE, (double)got,
                 want);
}

// ---- attenuation ------------------------------------------------------------------------------

// A lamp 1 m from the wall that gives pi W/sr, by its formula at every pixel.
static void light_wall_by(gpu *device, const char *way, bool linear, double range) {
    pass_world w;
    world_open(&w, device);
    add_wall(&w);
    pass *lamps = add_lamps(&w, 1);
    set(lamps, "position", triple(&w, 0.5f, -1, 0));
    set(lamps, "power", number(&w, 4 * GLM_PIf * GLM_PIf));
    set(lamps, "range", number(&w, (float)range));
    gpu_test_ok(pass_set_uniform(lamps, "falloff", number(&w, linear)));
    float *c = render(&w, add_shade(&w, lamps, way), SIZE);
    size_t dark = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        double x, z;
        wall_point(&w, i, &x, &z);
        double away = 1 - 1e-4 - 3e-4 * sqrt(x * x + z * z + 25); // it is lit from just off it
        double square = (x - 0.5) * (x - 0.5) + z * z + away * away, d = sqrt(square);
        double window = fmax(1 - pow(d / range, 4), 0);
        double falls = linear ? fmax(1 - d / range, 0) : window * window / square;
        expect_near(c[4 * i], (double)part * falls * away / d, 0.001 * falls + 2e-5,
                    linear ? "linear" : "inverse square", i);
        dark += falls == 0;
        if (falls == 0) assert_true(c[4 * i] == 0);
    }
    assert_true(range > 10 ? dark == 0 : dark > PIXELS / 8 && dark < PIXELS * 7 / 8);
    mem_free(c);
    world_close(&w);
}

static void lamps_fall_off_by_the_formula(void **state) {
    static const char *const ways[] = {"all", "tiles"};
    for (size_t i = 0; i < COUNT_OF(ways); i++)
        for (int linear = 0; linear < 2; linear++) {
            light_wall_by(*state, ways[i], linear, 2);
            light_wall_by(*state, ways[i], linear, 50);
        }
}

// ---- ways -------------------------------------------------------------------------------------

// Hundreds of small lamps between the camera and the wall, some of them off, some no numbers, some
// behind the camera; a crate stands in the middle, so that tiles show what is near and far.
static float *light_many(pass_world *w, const char *way, uint32_t count, uint32_t size) {
    add_wall(w);
    scene_mesh *crate = world_mesh(w, "crate.obj");
    crate->scale = number(w, 0.4f);
    crate->position = triple(w, 0.2f, -2.5f, -0.1f);
    pass *lamps = add_lamps(w, count);
    set(lamps, "position",
        vector(w, spread(w, 0.618f, -3, 3), spread(w, 0.414f, -6, 0.2f), spread(w, 0.732f, -3, 3)));
    set(lamps, "color",
        vector(w, spread(w, 0.317f, 0, 1), spread(w, 0.123f, 0, 1), spread(w, 0.91f, 0, 1)));
    set(lamps, "power", of(w, "max", spread(w, 0.271f, -3, 10), number(w, 0)));
    set(lamps, "range", of(w, "div", number(w, 0.9f), spread(w, 0.05f, 0, 1)));
    return render(w, add_shade(w, lamps, way), size);
}

static void expect_equal_ways(gpu *device, uint32_t count, uint32_t size) {
    static const char *const ways[] = {"all", "tiles"};
    float *pictures[COUNT_OF(ways)];
    double sum = 0;
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        pass_world w;
        world_open(&w, device);
        pictures[i] = light_many(&w, ways[i], count, size);
        world_close(&w);
    }
    for (size_t i = 0; i < 4ull * size * size; i++) {
        float want = pictures[0][i];
        sum += (double)want;
        for (size_t k = 1; k < COUNT_OF(ways); k++)
            if (!(fabsf(pictures[k][i] - want) <= 0.001f * want + 1e-6f))
                fail_msg("%u lamps by %s, pixel (%zu, %zu): %.6f, by %s %.6f", count, ways[k],
                         i / 4 % size, i / 4 / size, (double)pictures[k][i], ways[0], (double)want);
    }
    assert_true(sum > 1.01 * size * size); // alpha is 1 everywhere
    for (size_t i = 0; i < COUNT_OF(ways); i++) mem_free(pictures[i]);
}

static void every_way_gives_the_same_light(void **state) {
    expect_equal_ways(*state, 200, 50); // tiles at the edges are cut
    expect_equal_ways(*state, 33, 7);
}

static void thousands_of_lamps_are_lit(void **state) {
    expect_equal_ways(*state, 4096, 20);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(lamps_fall_off_by_the_formula),
        cmocka_unit_test(every_way_gives_the_same_light),
        cmocka_unit_test(thousands_of_lamps_are_lit),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
