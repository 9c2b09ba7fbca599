// Lamps of `point_lights` on a wall at y = 0 that faces the camera, which stands at (0, -5, 0).
#include "pass/light/point_lights.h"
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
    gpu_test_ok(pass_point_lights_open(p, count, NULL));
    return p;
}

static void set(pass *p, const char *name, const field *value) {
    gpu_test_ok(pass_set_field(p, name, value));
}

// A forward of all meshes, lit by the lamps.
static pass *add_forward(pass_world *w, pass *lamps, const char *way) {
    gpu_test_ok(pass_declare(lamps));
    pass *p = world_add(w, "forward", NULL, "forward");
    for (size_t i = 0; i < w->mesh_count; i++) gpu_test_ok(pass_add_mesh(p, &w->meshes[i]));
    gpu_test_ok(pass_set_option(p, "point_lights_by", way));
    pass_add_source(p, lamps);
    return p;
}

// A shade of all meshes, lit by the lamps.
static pass *add_shade(pass_world *w, pass *lamps, const char *way) {
    gpu_test_ok(pass_declare(lamps));
    pass *geometry = world_add(w, "geometry", NULL, "geometry");
    for (size_t i = 0; i < w->mesh_count; i++) gpu_test_ok(pass_add_mesh(geometry, &w->meshes[i]));
    gpu_test_ok(pass_declare(geometry));
    pass *p = world_add(w, "shade", NULL, "shade");
    gpu_test_ok(pass_set_option(p, "point_lights_by", way));
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

typedef struct lit_by {
    const char *word;
    bool forward;
    float tolerance; // relative; forward rounds places and normals otherwise
} lit_by;

// Hundreds of small lamps between the camera and the wall, some of them off, some no numbers, some
// behind the camera; a crate stands in the middle, so that tiles show what is near and far.
static float *light_many(pass_world *w, const lit_by *by, uint32_t count, uint32_t size) {
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
    return render(w, by->forward ? add_forward(w, lamps, by->word) : add_shade(w, lamps, by->word),
                  size);
}

static void expect_equal_ways(gpu *device, uint32_t count, uint32_t size) {
    static const lit_by ways[] = {{"all", false, 0},
                                  {"tiles", false, 0.001f},
                                  {"volumes", false, 0.001f},
                                  {"all", true, 0.004f},
                                  {"tiles", true, 0.004f}};
    float *pictures[COUNT_OF(ways)];
    double sum = 0;
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        pass_world w;
        world_open(&w, device);
        pictures[i] = light_many(&w, &ways[i], count, size);
        world_close(&w);
    }
    for (size_t i = 0; i < 4ull * size * size; i++) {
        float want = pictures[0][i];
        sum += (double)want;
        for (size_t k = 1; k < COUNT_OF(ways); k++)
            if (!(fabsf(pictures[k][i] - want) <= ways[k].tolerance * want + 1e-6f))
                fail_msg("%u lamps, %s by %s, pixel (%zu, %zu): %.6f, by %s %.6f", count,
                         ways[k].forward ? "forward" : "shade", ways[k].word, i / 4 % size,
                         i / 4 / size, (double)pictures[k][i], ways[0].word, (double)want);
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

// Three lamps that are on, among `count`: few are all asked, of more there are lists, without a
// depth.
static float *light_user(gpu *device, uint32_t count) {
    pass_world w;
    world_open(&w, device);
    pass *lamps = add_lamps(&w, count), *user = world_add(&w, NULL, "point_lights.comp", "user");
    const field *first = of(&w, "sub", number(&w, 3), of(&w, "light_index", NULL, NULL));
    set(lamps, "power", of(&w, "min", of(&w, "max", first, number(&w, 0)), number(&w, 1)));
    set(lamps, "position",
        vector(&w, spread(&w, 0.618f, -2, 2), spread(&w, 0.414f, -1, 1),
               spread(&w, 0.732f, -2, 2)));
    set(lamps, "range", number(&w, 1.5f));
    gpu_test_ok(pass_declare(lamps));
    pass_add_source(user, lamps);
    float *c = render(&w, user, SIZE);
    world_close(&w);
    return c;
}

static void a_shader_of_a_users_own_is_lit(void **state) {
    float *all = light_user(*state, 3), *tiles = light_user(*state, 70), most = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        expect_near(tiles[4 * i], (double)all[4 * i], 0.001 * (double)all[4 * i], "user", i);
        most = fmaxf(most, all[4 * i]);
    }
    assert_true(most > 0.05f);
    mem_free(all);
    mem_free(tiles);
}

// ---- of instances -----------------------------------------------------------------------------

static float *read_lamps(pass_world *w, pass *lamps, size_t count) {
    gpu_image *image = graph_get_image(w->host.graph, pass_output(lamps, "point_lights"));
    float *texels = mem_alloc(count * sizeof(struct light_entry));
    gpu_test_ok(gpu_image_read(w->host.device, image, texels, count * sizeof(struct light_entry)));
    return texels;
}

// In their own space, which is turned, scaled and moved, and so is that of all.
static void lamps_move_with_their_instances(void **state) {
    pass_world w;
    world_open(&w, *state);
    scene_mesh *mesh = add_wall(&w);
    const float half = sqrtf(0.5f);
    const struct instance_entry entries[2] = {
        {.place = {{1, 2, 3, 2}}, .turn = {{0, 0, half, half}}, .state = {{0, 5, 0, 0}}},
        {.place = {{-1, 0, 0, 1}}, .turn = {{0, 0, 0, 1}}, .state = {{0, 0, 0, 0}}},
    };
    scene_mesh *const kinds[] = {mesh};
    scene_instances *trees =
        scene_instances_create(&(scene_instances_desc){.name = "trees",
                                                       .kinds = kinds,
                                                       .kind_count = 1,
                                                       .entries = entries,
                                                       .count = 2,
                                                       .position = triple(&w, 0, 0, 10),
                                                       .rotation = triple(&w, 0, 0, 0),
                                                       .scale = number(&w, 3),
                                                       .color = triple(&w, 1, 1, 1)});
    gpu_test_ok(trees);
    pass *lamps = world_add(&w, "point_lights", NULL, "lamps");
    gpu_test_ok(pass_point_lights_open(lamps, 0, trees));
    set(lamps, "position", triple(&w, 0.5f, 0, 1));
    set(lamps, "power",
        of(&w, "dot", of(&w, "instance_state", NULL, NULL),
           field_constant(&w.memory, 4, (float[4]){0, 1, 0, 0})));
    gpu_test_ok(pass_declare(lamps));
    gpu_test_ok(scene_instances_allocate(trees, *state) && gpu_frame_begin(*state) &&
                scene_instances_upload(trees, *state) && gpu_frame_end(*state));
    world_render(&w, SIZE, SIZE, pass_output(lamps, "point_lights"));
    float *texels = read_lamps(&w, lamps, 2);
    const float first[] = {3 * 1, 3 * (2 + 2 * 0.5f), 10 + 3 * (3 + 2)};
    const float second[] = {3 * -0.5f, 0, 10 + 3};
    for (int i = 0; i < 3; i++) {
        assert_float_equal(texels[i], first[i], 1e-4);
        assert_float_equal(texels[16 + i], second[i], 1e-4);
        assert_float_equal(texels[4 + i], 5 / (4 * GLM_PIf), 1e-6);
        assert_float_equal(texels[20 + i], 0, 0); // off: the other has no power
    }
    mem_free(texels);
    scene_instances_destroy(trees, *state);
    world_close(&w);
}

// ---- as they are seen -------------------------------------------------------------------------

// What a lamp's sphere sends to the camera is what the lamp would light it by.
static void spheres_give_the_light_of_their_lamps(void **state) {
    static const float radii[] = {0.2f, 0.01f}; // many pixels; less than one
    for (size_t k = 0; k < COUNT_OF(radii); k++) {
        pass_world w;
        world_open(&w, *state);
        pass *lamps = add_lamps(&w, 1);
        set(lamps, "position", triple(&w, 0.31f, 0, 0.17f));
        set(lamps, "radius", number(&w, radii[k]));
        set(lamps, "power", number(&w, 4 * GLM_PIf));
        gpu_test_ok(pass_declare(lamps));
        pass *glows = world_add(&w, "point_light_glows", NULL, "glows");
        pass_add_source(glows, lamps);
        gpu_test_ok(pass_declare(glows));
        world_render(&w, 64, 64, pass_output(glows, "image"));
        float *c = world_read(&w, pass_output(glows, "image"));
        double sum = 0, wide = 2 * (double)w.frame.lens.v[1] / 64; // of a pixel, a metre away
        for (size_t i = 0; i < 64 * 64; i++) {
            double x = ((double)(i % 64) + 0.5 - 32) * wide,
                   y = ((double)(i / 64) + 0.5 - 32) * wide;
            sum += (double)c[4 * i] * wide * wide / pow(1 + x * x + y * y, 1.5);
            assert_true(c[4 * i + 3] == 0);
        }
        double want = 1 / (25 + 0.31 * 0.31 + 0.17 * 0.17);
        if (fabs(sum - want) > 0.06 * want)
            fail_msg("radius %g: %.5f, not %.5f", (double)radii[k], sum, want);
        mem_free(c);
        world_close(&w);
    }
}

// By a sum in small steps along the ray, up to the wall.
static double mist_by_steps(const double way[3], const double at[3], double range, bool linear,
                            double end) {
    enum { STEPS = 20000 };
    double sum = 0, length = end / STEPS;
    for (int i = 0; i < STEPS; i++) {
        double t = (i + 0.5) * length, square = 0;
        for (int a = 0; a < 3; a++) {
            double off = way[a] * t + (a == 1 ? -5 : 0) - at[a];
            square += off * off;
        }
        double d = sqrt(square), window = fmax(1 - pow(d / range, 4), 0);
        sum += linear ? fmax(1 - d / range, 0) : window * window / square;
    }
    return sum * length;
}

static void mist_is_lit_by_the_integral(void **state) {
    static const double at[] = {0.3, -1.2, 0.2};
    for (int linear = 0; linear < 2; linear++) {
        pass_world w;
        world_open(&w, *state);
        pass *lamps = add_lamps(&w, 1);
        set(lamps, "position", triple(&w, (float)at[0], (float)at[1], (float)at[2]));
        set(lamps, "power", number(&w, 16 * GLM_PIf * GLM_PIf));
        set(lamps, "range", number(&w, 2.5f));
        gpu_test_ok(pass_set_uniform(lamps, "falloff", number(&w, (float)linear)));
        add_wall(&w);
        pass *shade = add_shade(&w, lamps, "tiles"), *glows;
        glows = world_add(&w, "point_light_glows", NULL, "glows");
        gpu_test_ok(pass_set_option(glows, "point_lights_by", "tiles"));
        gpu_test_ok(pass_set_uniform(glows, "mist", number(&w, 1)));
        gpu_test_ok(pass_set_uniform(glows, "size", number(&w, 0)));
        gpu_test_ok(pass_declare(shade));
        pass_add_source(glows, w.passes[1]);
        pass_add_source(glows, lamps);
        gpu_test_ok(pass_declare(glows));
        world_render(&w, SIZE, SIZE, pass_output(glows, "image"));
        float *c = world_read(&w, pass_output(glows, "image"));
        for (size_t i = 0; i < PIXELS; i += 29) {
            double x, z;
            wall_point(&w, i, &x, &z);
            double end = sqrt(x * x + z * z + 25);
            const double way[] = {x / end, 5 / end, z / end};
            double want = mist_by_steps(way, at, 2.5, linear, end);
            expect_near(c[4 * i], want, 0.004 * want + 1e-4, linear ? "linear" : "mist", i);
        }
        mem_free(c);
        world_close(&w);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(lamps_fall_off_by_the_formula),
        cmocka_unit_test(every_way_gives_the_same_light),
        cmocka_unit_test(thousands_of_lamps_are_lit),
        cmocka_unit_test(a_shader_of_a_users_own_is_lit),
        cmocka_unit_test(lamps_move_with_their_instances),
        cmocka_unit_test(spheres_give_the_light_of_their_lamps),
        cmocka_unit_test(mist_is_lit_by_the_integral),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
