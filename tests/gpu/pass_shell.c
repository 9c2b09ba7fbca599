// Shells: where their surface is, what it looks like, which is before which; by rays and as meshes.
#include "pass/shell/shell.h"
#include "pass_test.h"

enum { SIDE = 64, CENTRE = SIDE / 2 * SIDE + SIDE / 2 };

typedef struct ball {
    pass_world w;
    pass *shell;
    scene_explosions list;
} ball;

static const char *const modes[] = {"rays", "mesh"};

// White, of 1 m, at half of their life.
static void ball_open(ball *b, gpu *device, const char *mode, const scene_explosion *all,
                      size_t count) {
    world_open(&b->w, device);
    b->list = (scene_explosions){.count = count};
    for (size_t i = 0; i < count; i++) b->list.all[i] = all[i];
    b->w.context.time = 1;
    b->shell = world_add(&b->w, "shell", NULL, "shell");
    pass_shell_open(b->shell, &b->list);
    gpu_test_ok(pass_set_option(b->shell, "mode", mode));
    gpu_test_ok(pass_set_field(b->shell, "color", triple(&b->w, 1, 1, 1)));
}

static const scene_explosion middle = {.size = 1, .life = 1, .seed = 7};

static void set(ball *b, const char *name, const field *value) {
    gpu_test_ok(pass_set_field(b->shell, name, value));
}

static const field *source(ball *b, const char *kind) {
    const field *made = field_make(&b->w.memory, kind, NULL, NULL);
    gpu_test_ok(made);
    return made;
}

#define op(b, kind, ...) operate(b, kind, (const field *const[FIELD_MAX_ARGS]){__VA_ARGS__})
static const field *operate(ball *b, const char *kind, const field *const *args) {
    const field *made = field_make(&b->w.memory, kind, args, NULL);
    gpu_test_ok(made);
    return made;
}

// Two layers, 0..0.6.
static const field *lumps(ball *b) {
    pass_world *w = &b->w;
    const field *coarse = row(w, "perlin", SET("frequency", number(w, 2)),
                              SET("octaves", number(w, 1)), SET("amplitude", number(w, 0.4f)));
    const field *fine = row(w, "perlin", SET("frequency", number(w, 5)),
                            SET("octaves", number(w, 1)), SET("amplitude", number(w, 0.2f)));
    return op(b, "add", coarse, fine);
}

// Draws; free with mem_free. The depths too, where they are asked for.
static float *ball_draw(ball *b, float **depths) {
    gpu_test_ok(pass_declare(b->shell));
    if (depths) graph_add_output(b->w.host.graph, pass_output(b->shell, "front"));
    world_render(&b->w, SIDE, SIDE, pass_output(b->shell, "image"));
    if (depths) *depths = world_read_depth(&b->w, pass_output(b->shell, "front"));
    return world_read(&b->w, pass_output(b->shell, "image"));
}

static int count_covered(const float *pixels) {
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) count += pixels[4 * i + 3] > 0.5f;
    return count;
}

// Of the middle of a pixel, one metre deep: x to the right, z up.
static void ray_of(const ball *b, int i, vec3 out) {
    const float *lens = b->w.frame.lens.v;
    out[0] = (2 * ((float)(i % SIDE) + 0.5f) / SIDE - 1) * lens[0];
    out[1] = 1;
    out[2] = (1 - 2 * ((float)(i / SIDE) + 0.5f) / SIDE) * lens[1];
}

// How near the ray through a pixel comes to the centre (m).
static float passes_at(const ball *b, int i) {
    vec3 ray, away;
    ray_of(b, i, ray);
    glm_vec3_normalize(ray);
    glm_vec3_scale(ray, 5 * ray[1], away);
    away[1] -= 5;
    return glm_vec3_norm(away);
}

static void check_bounds(gpu *device, const char *mode, float reach) {
    ball b;
    ball_open(&b, device, mode, &middle, 1);
    set(&b, "displacement", lumps(&b));
    gpu_test_ok(pass_set_uniform(b.shell, "reach", number(&b.w, reach)));
    float *pixels = ball_draw(&b, NULL), slack = 0.03f; // less than a pixel
    float most = 1 + fminf(reach, 0.6f);
    int beyond_the_sphere = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        float at = passes_at(&b, i), alpha = pixels[4 * i + 3];
        if (at > most + slack && alpha > 0.5f) fail_msg("%s: there at %g m", mode, (double)at);
        if (at < 1 - slack && alpha < 0.999f) fail_msg("%s: a hole at %g m", mode, (double)at);
        beyond_the_sphere += at > 1 && alpha > 0.5f;
    }
    assert_true(beyond_the_sphere > 100);
    mem_free(pixels);
    world_close(&b.w);
}

static void extrusion_stays_within_its_bounds(void **state) {
    check_bounds(*state, "rays", 2);
    check_bounds(*state, "rays", 0.15f);
    check_bounds(*state, "mesh", 0.15f);
}

// The depth of each pixel against the noise as the host computes it.
static void the_surface_is_where_the_layers_say(void **state) {
    for (size_t m = 0; m < COUNT_OF(modes); m++) {
        ball b;
        ball_open(&b, *state, modes[m], &middle, 1);
        const field *layers = lumps(&b);
        set(&b, "displacement", layers);
        set(&b, "color", source(&b, "shell_displacement"));
        float *depths, *pixels = ball_draw(&b, &depths);
        int seen = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            if (passes_at(&b, i) > 0.9f) continue; // near the outline a step aside counts for more
            vec3 p;
            ray_of(&b, i, p);
            glm_vec3_scale(p, depths[i], p);
            p[1] -= 5;
            float away = glm_vec3_norm(p), wanted[4];
            glm_vec3_scale(p, 1 / away, p);
            assert_true(field_eval(layers, &b.w.context, (float3){p[0], p[1], p[2]}, wanted));
            if (fabsf(away - 1 - wanted[0]) > 0.02f || fabsf(pixels[4 * i] - wanted[0]) > 0.01f)
                fail_msg("%s: at %g m, coloured %g; wanted 1 + %g", modes[m], (double)away,
                         (double)pixels[4 * i], (double)wanted[0]);
            seen++;
        }
        assert_true(seen > 300);
        mem_free(pixels);
        mem_free(depths);
        world_close(&b.w);
    }
}

static void a_gradient_has_its_keys_colours(void **state) {
    static const palette_stop stops[] = {{0, {8, 4, 1, 1}},
                                         {1, {4, 1, 0.25f, 1}},
                                         {2, {0.5f, 0.125f, 0, 1}},
                                         {3, {0.0625f, 0.0625f, 0.0625f, 1}}};
    const palette_key key = {.stops = stops, .count = COUNT_OF(stops)};
    const palette_desc desc = {.min = -1, .max = 4, .keys = &key, .key_count = 1};
    for (size_t i = 0; i < COUNT_OF(stops); i++) {
        ball b;
        ball_open(&b, *state, "rays", &middle, 1);
        palette *gradient = palette_create(&b.w.memory, &desc);
        gpu_test_ok(gradient);
        const field *at =
            op(&b, "add", source(&b, "shell_displacement"), source(&b, "shell_depth"));
        set(&b, "displacement", number(&b.w, 0.25f));
        set(&b, "shell_depth", number(&b.w, (float)i - 0.25f));
        set(&b, "color",
            field_swizzle(&b.w.memory, field_palette(&b.w.memory, gradient, at), "rgb"));
        float *pixels = ball_draw(&b, NULL);
        for (int c = 0; c < 3; c++) // a texel of the gradient is a hundredth of a step
            assert_true(fabsf(pixels[4 * CENTRE + c] - stops[i].color[c]) < 0.03f);
        mem_free(pixels);
        world_close(&b.w);
    }
}

// Of an opacity like rim + noise - age.
static void opacity_is_limited(void **state) {
    static const struct { float opacity, wanted; } cases[] = {{-3, 0}, {0.25f, 0.25f}, {40, 1}};
    for (size_t m = 0; m < COUNT_OF(modes); m++)
        for (size_t i = 0; i < COUNT_OF(cases); i++) {
            ball b;
            ball_open(&b, *state, modes[m], &middle, 1);
            gpu_test_ok(pass_set_option(b.shell, "sides", "front"));
            set(&b, "opacity", number(&b.w, cases[i].opacity));
            float *pixels = ball_draw(&b, NULL);
            for (int c = 0; c < 4; c++)
                assert_true(fabsf(pixels[4 * CENTRE + c] - cases[i].wanted) < 1e-3f);
            mem_free(pixels);
            world_close(&b.w);
        }
}

// Its half towards the eye is cut away: the inside of the other is seen, or nothing.
static void clip_opens_it(void **state) {
    for (size_t m = 0; m < COUNT_OF(modes); m++)
        for (int front = 0; front < 2; front++) {
            ball b;
            ball_open(&b, *state, modes[m], &middle, 1);
            set(&b, "clip", field_swizzle(&b.w.memory, source(&b, "position"), "y"));
            gpu_test_ok(pass_set_option(b.shell, "sides", front ? "front" : "both"));
            float *depths, *pixels = ball_draw(&b, &depths);
            if (fabsf(depths[CENTRE] - (front ? 1e9f : 6)) > 0.02f)
                fail_msg("%s: %g m", modes[m], (double)depths[CENTRE]);
            assert_true((pixels[4 * CENTRE + 3] > 0.99f) == !front);
            mem_free(pixels);
            mem_free(depths);
            world_close(&b.w);
        }
}

static float *draw_list(gpu *device, const char *mode, const scene_explosion *all, size_t count) {
    ball b;
    ball_open(&b, device, mode, all, count);
    set(&b, "radius", op(&b, "add", number(&b.w, 0.3f), source(&b, "shell_age")));
    set(&b, "displacement", lumps(&b));
    set(&b, "color",
        op(&b, "add", source(&b, "shell_shift"),
           op(&b, "mul", source(&b, "shell_age"), number(&b.w, 4))));
    float *pixels = ball_draw(&b, NULL);
    world_close(&b.w);
    return pixels;
}

// Each is as if it were alone: its age, its numbers, its place.
static void several_at_once_equal_one_by_one(void **state) {
    static const scene_explosion all[] = {
        {.time = 0.2, .place = {-0.9f, 0, 0.6f}, .size = 0.6f, .life = 1, .seed = 3},
        {.time = 0.7, .place = {0.8f, 1, 0.7f}, .size = 0.9f, .life = 1, .seed = 8},
        {.time = -9, .place = {0, 0, 0}, .size = 1, .life = 1, .seed = 1}, // over
        {.time = 0, .place = {0.1f, 0.5f, -0.8f}, .size = 0.5f, .life = 2, .seed = 5},
        {.time = 1.1, .place = {0, 0, 0}, .size = 1, .life = 1, .seed = 1}, // to come
    };
    for (size_t m = 0; m < COUNT_OF(modes); m++) {
        float *sum = mem_alloc(4 * SIDE * SIDE * sizeof *sum);
        for (size_t i = 0; i < COUNT_OF(all); i++) {
            float *one = draw_list(*state, modes[m], &all[i], 1);
            for (int k = 0; k < 4 * SIDE * SIDE; k++) sum[k] += one[k];
            int covered = count_covered(one);
            assert_true(i == 2 || i == 4 ? covered == 0 : covered > 60);
            mem_free(one);
        }
        float *together = draw_list(*state, modes[m], all, COUNT_OF(all));
        assert_memory_equal(together, sum, 4 * SIDE * SIDE * sizeof *sum);
        mem_free(together);
        mem_free(sum);
    }
}

static void both_ways_give_one_picture(void **state) {
    float *by[2];
    for (size_t m = 0; m < COUNT_OF(modes); m++) by[m] = draw_list(*state, modes[m], &middle, 1);
    int same = 0, other = 0;
    for (int i = 0; i < 4 * SIDE * SIDE; i += 4) {
        if (by[0][i + 3] == 0 && by[1][i + 3] == 0) continue;
        bool near = true;
        for (int c = 0; c < 4; c++) near = near && fabsf(by[0][i + c] - by[1][i + c]) < 0.02f;
        *(near ? &same : &other) += 1;
    }
    if (!(same > 700 && other < 0.15 * same)) fail_msg("%d the same, %d not", same, other);
    mem_free(by[0]);
    mem_free(by[1]);
}

// One at half opacity before another: the nearer is over the farther, whatever their order.
static void the_nearer_is_before_the_farther(void **state) {
    static const scene_explosion orders[][2] = {{{.place = {0, -1, 0}, .size = 0.5f, .life = 1},
                                                 {.place = {0, 1, 0}, .size = 1, .life = 2}},
                                                {{.place = {0, 1, 0}, .size = 1, .life = 2},
                                                 {.place = {0, -1, 0}, .size = 0.5f, .life = 1}}};
    for (size_t m = 0; m < COUNT_OF(modes); m++)
        for (size_t i = 0; i < COUNT_OF(orders); i++) {
            ball b;
            ball_open(&b, *state, modes[m], orders[i], 2);
            gpu_test_ok(pass_set_option(b.shell, "sides", "front"));
            set(&b, "color", source(&b, "shell_age")); // 0.5 of the nearer, 0.25 of the farther
            set(&b, "opacity", number(&b.w, 0.5f));
            float *pixels = ball_draw(&b, NULL);
            assert_true(fabsf(pixels[4 * CENTRE] - (0.25f + 0.5f * 0.125f)) < 2e-3f);
            assert_true(fabsf(pixels[4 * CENTRE + 3] - 0.75f) < 2e-3f);
            mem_free(pixels);
            world_close(&b.w);
        }
}

// A wall in the middle of it hides what is behind, and what is before the wall fades towards it.
static void the_scene_stops_it(void **state) {
    for (size_t m = 0; m < COUNT_OF(modes); m++) {
        ball b;
        ball_open(&b, *state, modes[m], &middle, 1);
        pass *wall = world_add(&b.w, NULL, "wall.comp", "wall");
        gpu_test_ok(pass_set_uniform(wall, "distance_to", number(&b.w, 4.5f)) &&
                    pass_declare(wall));
        gpu_test_ok(pass_set_image(b.shell, "depth", pass_output(wall, "depth")));
        gpu_test_ok(pass_set_uniform(b.shell, "soften", number(&b.w, 2)));
        float *depths, *pixels = ball_draw(&b, &depths);
        assert_true(fabsf(pixels[4 * CENTRE + 3] - 0.25f) < 5e-3f);
        assert_true(fabsf(depths[CENTRE] - 4.5f) < 1e-3f && pixels[3] == 0);
        int covered = 0;
        for (int i = 0; i < SIDE * SIDE; i++) covered += pixels[4 * i + 3] > 0;
        float radius = sqrtf(0.75f) / 4.5f; // of the circle in which the wall cuts it
        float wanted = 3.1416f * radius * radius * SIDE * SIDE /
                       (4 * b.w.frame.lens.v[0] * b.w.frame.lens.v[1]);
        assert_true(fabsf((float)covered - wanted) < 0.1f * wanted);
        mem_free(pixels);
        mem_free(depths);
        world_close(&b.w);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(extrusion_stays_within_its_bounds),
        cmocka_unit_test(the_surface_is_where_the_layers_say),
        cmocka_unit_test(a_gradient_has_its_keys_colours),
        cmocka_unit_test(opacity_is_limited),
        cmocka_unit_test(clip_opens_it),
        cmocka_unit_test(several_at_once_equal_one_by_one),
        cmocka_unit_test(both_ways_give_one_picture),
        cmocka_unit_test(the_nearer_is_before_the_farther),
        cmocka_unit_test(the_scene_stops_it),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
