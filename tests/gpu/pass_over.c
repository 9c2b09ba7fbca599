// Laying a volume over what shines through it, by colour: a block 2 m wide before an even picture.
#include "pass_test.h"

enum { WIDTH = 34, HEIGHT = 18, CENTRE = (HEIGHT / 2) * WIDTH + WIDTH / 2 };

typedef struct setup {
    float extinction[3]; // 1/m
    float scale;         // of the march
    bool grey;           // `over` is told the opacity only
    bool ragged;         // the march has an error of its own in every pixel, and adds light
} setup;

typedef struct layers {
    pass *volume, *over;
} layers;

// Behind it is light of 8, 4 and 2.
static layers lay(pass_world *w, gpu *device, const setup *how) {
    const float *s = how->extinction;
    world_open(w, device);
    pass *back = world_add(w, NULL, "even.comp", "back"), *p = world_add(w, "march", NULL, "march");
    gpu_test_ok(pass_set_uniform(back, "tint", triple(w, 8, 4, 2)) && pass_declare(back));
    gpu_test_ok(pass_set_field(p, "density", block(w, 1, 1)));
    gpu_test_ok(pass_set_uniform(p, "extinction", triple(w, s[0], s[1], s[2])));
    gpu_test_ok(pass_set_uniform(p, "albedo", triple(w, 0.45f, 0.43f, 0.41f)));
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(w, 0)));
    gpu_test_ok(pass_set_uniform(p, "ambient", number(w, 0)));
    gpu_test_ok(pass_set_scale(p, how->scale));
    if (how->ragged) {
        gpu_test_ok(pass_set_field(p, "emission", triple(w, 1, 0.5f, 0.1f)));
        gpu_test_ok(pass_set_uniform(p, "steps", number(w, 3)));
        gpu_test_ok(pass_set_uniform(p, "jitter", number(w, 1)));
    }
    gpu_test_ok(pass_declare(p));
    pass *over = world_add(w, "over", NULL, "over");
    gpu_test_ok(pass_set_image(over, "volume", pass_output(p, "color")));
    gpu_test_ok(pass_set_image(over, "source", pass_output(back, "color")));
    if (!how->grey) pass_add_source(over, p);
    gpu_test_ok(pass_declare(over));
    return (layers){p, over};
}

// Free with mem_free.
static float *render(gpu *device, const setup *how) {
    pass_world w;
    layers l = lay(&w, device, how);
    world_render(&w, WIDTH, HEIGHT, pass_output(l.over, "color"));
    float *pixels = world_read(&w, pass_output(l.over, "color"));
    world_close(&w);
    return pixels;
}

static void slab_dyes_what_is_behind(void **state) {
    static const float scales[] = {1, 0.5f};
    for (size_t i = 0; i < COUNT_OF(scales); i++) {
        setup how = {.extinction = {0.1f, 0.7f, 2.5f}, .scale = scales[i]};
        float *pixels = render(*state, &how);
        for (int k = 0; k < 3; k++) {
            double wanted = (8 >> k) * exp(-2 * (double)how.extinction[k]);
            double got = (double)pixels[4 * CENTRE + k];
            if (fabs(got - wanted) > 0.01 * wanted) fail_msg("%d: %g, not %g", k, got, wanted);
            assert_true(pixels[k] == (float)(8 >> k)); // nothing before it there
        }
        mem_free(pixels);
    }
}

static void grey_is_as_its_opacity_says(void **state) {
    static const float scales[] = {1, 0.5f};
    for (size_t i = 0; i < COUNT_OF(scales); i++) {
        setup how = {.extinction = {0.6f, 0.6f, 0.6f}, .scale = scales[i], .ragged = true};
        float *dyed = render(*state, &how);
        how.grey = true;
        float *grey = render(*state, &how);
        assert_true(grey[4 * CENTRE] < 7);
        assert_memory_equal(dyed, grey, 4 * WIDTH * HEIGHT * sizeof *grey);
        mem_free(dyed);
        mem_free(grey);
    }
}

// Without a reader the image has no memory; it is written as soon as somebody wants it, by the same
// pipeline.
static void unread_transmittance_costs_nothing(void **state) {
    pass_world w;
    setup how = {.extinction = {0.1f, 0.7f, 2.5f}, .scale = 1, .grey = true};
    layers l = lay(&w, *state, &how);
    graph_image through = pass_output(l.volume, "transmittance");
    world_render(&w, WIDTH, HEIGHT, pass_output(l.over, "color"));
    assert_null(graph_get_image(w.host.graph, through));
    graph_add_output(w.host.graph, through);
    gpu_test_ok(graph_compile(w.host.graph, WIDTH, HEIGHT));
    gpu_test_ok(graph_allocate(w.host.graph, *state));
    world_frame(&w, WIDTH, HEIGHT, 2);
    float *pixels = world_read(&w, through);
    for (int k = 0; k < 3; k++) {
        assert_true(fabs((double)pixels[4 * CENTRE + k] - exp(-2 * (double)how.extinction[k])) <
                    1e-3);
        assert_true(pixels[k] == 1);
    }
    mem_free(pixels);
    world_close(&w);
}

// Texels around the middle are a little like it, but count as less than nothing; those that would
// count are not like it at all. What comes of it is no more than there is.
static void no_pixel_is_brighter_than_the_volume(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *back = world_add(&w, NULL, "even.comp", "back");
    pass *deep = world_add(&w, NULL, "even.comp", "deep");
    pass *volume = world_add(&w, NULL, "far_edge.comp", "volume");
    gpu_test_ok(pass_set_uniform(back, "tint", triple(&w, 1, 1, 1)) && pass_declare(back));
    gpu_test_ok(pass_set_uniform(deep, "tint", triple(&w, 10, 0, 0)) && pass_declare(deep));
    gpu_test_ok(pass_set_scale(volume, 0.5f) && pass_declare(volume));
    pass *over = world_add(&w, "over", NULL, "over");
    gpu_test_ok(pass_set_image(over, "volume", pass_output(volume, "color")));
    gpu_test_ok(pass_set_image(over, "edge", pass_output(volume, "edge")));
    gpu_test_ok(pass_set_image(over, "depth", pass_output(deep, "color")));
    gpu_test_ok(pass_set_image(over, "source", pass_output(back, "color")));
    gpu_test_ok(pass_declare(over));
    enum { ACROSS = 36, DOWN = 20 }; // an even number of texels for the volume
    world_render(&w, ACROSS, DOWN, pass_output(over, "color"));
    float *pixels = world_read(&w, pass_output(over, "color"));
    for (int i = 0; i < ACROSS * DOWN; i++) // 0.25 + 0.5 * 1
        if (!(fabs((double)pixels[4 * i] - 0.75) < 2e-3))
            fail_msg("pixel %d, %d: %g", i % ACROSS, i / ACROSS, (double)pixels[4 * i]);
    mem_free(pixels);
    world_close(&w);
}

// ---- smoke before ground that is seen at a grazing angle, and before its horizon
// -----------------

enum { SIDE = 96, BLOCK = 4 };

typedef struct puff {
    const char *mode;
    float thickness; // 1/m
    float z;         // of its middle; its radius is 1 m
    float eye;       // height
    float wall;      // depth of a wall before the left half, through the smoke; 0: none
    float most;      // that a row may jump
} puff;

// It shines the more the higher it is. Free with mem_free.
static float *render_puff(gpu *device, const puff *how, float scale) {
    pass_world w;
    world_open(&w, device);
    w.scene.camera.eye = triple(&w, 0, -6, how->eye);
    w.scene.camera.target = triple(&w, 0, 0, 1);
    const field *ball = row(&w, "sphere", SET("position", triple(&w, 0, 0, how->z)),
                            SET("radius", number(&w, 1)), SET("falloff", number(&w, 0.6f)));
    const field *above = row(&w, "sphere", SET("position", triple(&w, 0, 0, how->z + 1.5f)),
                             SET("radius", number(&w, 3)), SET("falloff", number(&w, 3)));
    pass *back = world_add(&w, NULL, "even.comp", "back");
    gpu_test_ok(pass_set_uniform(back, "tint", triple(&w, 0, 0, 0)) && pass_declare(back));
    pass *ground = world_add(&w, NULL, "ground.comp", "ground");
    if (how->wall > 0) gpu_test_ok(pass_set_uniform(ground, "wall", number(&w, how->wall)));
    gpu_test_ok(pass_declare(ground));
    pass *p = world_add(&w, "march", NULL, "march");
    gpu_test_ok(pass_set_option(p, "mode", how->mode));
    gpu_test_ok(pass_set_field(
        p, "density", row(&w, "mul", SET("a", ball), SET("b", number(&w, how->thickness)))));
    gpu_test_ok(pass_set_field(p, "radiance",
                               row(&w, "mul", SET("a", above), SET("b", triple(&w, 1, 1, 1)))));
    gpu_test_ok(pass_set_uniform(p, "opacity", number(&w, 2)));
    gpu_test_ok(pass_set_uniform(p, "steps", number(&w, 256)));
    gpu_test_ok(pass_set_image(p, "depth", pass_output(ground, "depth")));
    gpu_test_ok(pass_set_scale(p, scale));
    gpu_test_ok(pass_declare(p));
    pass *over = world_add(&w, "over", NULL, "over");
    gpu_test_ok(pass_set_image(over, "volume", pass_output(p, "color")));
    gpu_test_ok(pass_set_image(over, "source", pass_output(back, "color")));
    pass_add_source(over, p);
    pass_add_source(over, ground);
    gpu_test_ok(pass_declare(over));
    world_render(&w, SIDE, SIDE, pass_output(over, "color"));
    float *pixels = world_read(&w, pass_output(over, "color"));
    world_close(&w);
    return pixels;
}

// The most that the coarse picture jumps from a row to the next where the full one hardly changes.
static double find_jump(const float *coarse, const float *full) {
    const float hardly = 0.02f;
    double most = 0;
    int rows = 0;
    for (int y = 0; y + 1 < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const int a = 4 * (y * SIDE + x), b = a + 4 * SIDE;
            if (full[a] == 0 || full[b] == 0 || fabsf(full[b] - full[a]) > hardly) continue;
            most = fmax(most, fabs((double)(coarse[b] - coarse[a])));
            rows++;
        }
    assert_true(rows > SIDE * SIDE / 16);
    return most;
}

static void smoke_before_a_grazing_plane_has_no_blocks(void **state) {
    static const puff puffs[] = {
        {"physical", 12, 1.7f, 1.5f, 0, 0.09f}, // opaque, off the ground, before the horizon
        {"physical", 1, 1.7f, 1.5f, 0, 0.03f},  // thin
        {"physical", 12, 0.5f, 0.4f, 0, 0.09f}, // in the ground
        {"physical", 1, 0.5f, 0.4f, 0, 0.07f},  {"paper", 1, 1.7f, 1.5f, 0, 0.03f},
        {"paper", 1, 0.5f, 0.4f, 0, 0.07f},
    };
    for (size_t i = 0; i < COUNT_OF(puffs); i++) {
        float *full = render_puff(*state, &puffs[i], 1);
        float *coarse = render_puff(*state, &puffs[i], 1.0f / BLOCK);
        double jump = find_jump(coarse, full);
        if (jump > (double)puffs[i].most)
            fail_msg("mode %s, %g a metre at %g m: a row jumps by %g", puffs[i].mode,
                     (double)puffs[i].thickness, (double)puffs[i].z, jump);
        mem_free(full);
        mem_free(coarse);
    }
}

// A wall through the smoke hides what of it is behind, and its edge stays where it is.
static void edges_of_the_scene_stay_sharp(void **state) {
    static const puff puffs[] = {{"physical", 1, 1.7f, 1.5f, 5.8f, 0},
                                 {"physical", 12, 1.7f, 1.5f, 5.2f, 0},
                                 {"paper", 1, 1.7f, 1.5f, 5.8f, 0}};
    for (size_t i = 0; i < COUNT_OF(puffs); i++) {
        double most = 0, difference = 0;
        float *full = render_puff(*state, &puffs[i], 1);
        float *coarse = render_puff(*state, &puffs[i], 1.0f / BLOCK);
        for (int y = SIDE / 4; y < SIDE / 2; y++)
            for (int x = SIDE / 2 - 1; x <= SIDE / 2; x++) {
                const int k = 4 * (y * SIDE + x);
                most = fmax(most, fabs((double)(coarse[k] - full[k])));
                difference = fmax(difference, fabs((double)(full[4 * (y * SIDE + SIDE / 2)] -
                                                            full[4 * (y * SIDE + SIDE / 2 - 1)])));
            }
        assert_true(difference > 0.15);
        if (most > 0.1 * difference)
            fail_msg("mode %s, %g a metre: off by %g of %g", puffs[i].mode,
                     (double)puffs[i].thickness, most, difference);
        mem_free(full);
        mem_free(coarse);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(slab_dyes_what_is_behind),
        cmocka_unit_test(grey_is_as_its_opacity_says),
        cmocka_unit_test(unread_transmittance_costs_nothing),
        cmocka_unit_test(no_pixel_is_brighter_than_the_volume),
        cmocka_unit_test(smoke_before_a_grazing_plane_has_no_blocks),
        cmocka_unit_test(edges_of_the_scene_stay_sharp),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
