// Rays where arithmetic is tight: inside, along faces, behind, through nothing.
#include "pass_test.h"

enum { SIZE = 17, PIXELS = SIZE * SIZE, CENTRE = SIZE / 2 * SIZE + SIZE / 2 };

typedef struct view {
    float eye[3], target[3];
    float jitter, step_size;
    const char *mode; // NULL: physical
} view;

static void look(pass_world *w, view v) {
    w->scene.camera.eye = triple(w, v.eye[0], v.eye[1], v.eye[2]);
    w->scene.camera.target = triple(w, v.target[0], v.target[1], v.target[2]);
}

// A block of density 1 around the origin, 2 m wide, lit by sun and sky.
static pass *open_block(pass_world *w, gpu *device, view v) {
    world_open(w, device);
    look(w, v);
    w->scene.sun.strength = number(w, 3);
    w->scene.sky.strength = number(w, 1);
    pass *p = world_add(w, "march", NULL, "march");
    if (v.mode) gpu_test_ok(pass_set_option(p, "mode", v.mode));
    gpu_test_ok(pass_set_field(p, "density", block(w, 1, 1)));
    gpu_test_ok(pass_set_uniform(p, "jitter", number(w, v.jitter)));
    gpu_test_ok(pass_set_uniform(p, "step_size", number(w, v.step_size)));
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(w, 0)));
    gpu_test_ok(pass_declare(p));
    world_render(w, SIZE, SIZE, pass_output(p, "color"));
    return p;
}

// One picture of it; free with mem_free.
static float *march(gpu *device, view v) {
    pass_world w;
    pass *p = open_block(&w, device, v);
    float *pixels = world_read(&w, pass_output(p, "color"));
    world_close(&w);
    return pixels;
}

static void all_finite(const float *pixels, const char *what) {
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 4; c++) {
            float v = pixels[4 * i + c];
            if (!isfinite(v) || v < 0 || (c == 3 && v > 1))
                fail_msg("%s: channel %d of pixel (%d, %d) is %g", what, c, i % SIZE, i / SIZE,
                         (double)v);
        }
}

static void nothing_is_not_a_number_wherever_the_camera_is(void **state) {
    static const float at[] = {-2, -1, 0, 1}; // outside, on a face, in the middle, on the other
    static const float to[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {0.3f, -0.5f, 0.8f}};
    char what[64];
    pass_world w;
    pass *p = open_block(&w, *state, (view){.jitter = 1});
    for (int i = 0; i < 256; i++) {
        const float *along = to[i / 64];
        view v = {.eye = {at[i % 4], at[i / 4 % 4], at[i / 16 % 4]}};
        for (int k = 0; k < 3; k++) v.target[k] = v.eye[k] + along[k];
        look(&w, v);
        world_frame(&w, SIZE, SIZE, (uint32_t)i);
        snprintf(what, sizeof what, "eye (%g, %g, %g), direction %d", (double)v.eye[0],
                 (double)v.eye[1], (double)v.eye[2], i / 64);
        float *pixels = world_read(&w, pass_output(p, "color"));
        all_finite(pixels, what);
        mem_free(pixels);
    }
    world_close(&w);
}

static void ray_along_the_axes_sees_the_whole_block(void **state) {
    static const view views[] = {{.eye = {0, -5, 0}},
                                 {.eye = {5, 0, 0}},
                                 {.eye = {0, 0, 5}},
                                 {.eye = {0.5f, 9, 0.5f}, .target = {0.5f, 0, 0.5f}}};
    for (size_t i = 0; i < COUNT_OF(views); i++) {
        float *pixels = march(*state, views[i]);
        all_finite(pixels, "along an axis");
        assert_true(fabs((double)pixels[4 * CENTRE + 3] - (1 - exp(-2.0))) < 0.002);
        mem_free(pixels);
    }
}

static void ray_past_a_face_sees_nothing(void **state) {
    float *pixels = march(*state, (view){.eye = {1.001f, -5, 0}, .target = {1.001f, 0, 0}});
    all_finite(pixels, "past a face");
    assert_true(pixels[4 * CENTRE + 3] == 0);
    assert_true(pixels[4 * (CENTRE - 1) + 3] > 0);
    mem_free(pixels);
}

static void block_behind_the_camera_is_not_seen(void **state) {
    static const char *const modes[] = {"physical", "paper"};
    for (int i = 0; i < 2; i++) {
        float *pixels =
            march(*state, (view){.eye = {0, -5, 0}, .target = {0, -6, 0}, .mode = modes[i]});
        for (int k = 0; k < 4 * PIXELS; k++) assert_true(pixels[k] == 0);
        mem_free(pixels);
    }
}

static void short_step_does_not_cut_the_ray(void **state) {
    float *pixels = march(*state, (view){.eye = {0, -5, 0}, .step_size = 1e-5f});
    assert_true(fabs((double)pixels[4 * CENTRE + 3] - (1 - exp(-2.0))) < 0.002);
    mem_free(pixels);
}

static bool update_nothing(field_grid *grid, gpu *g, double time) {
    (void)grid, (void)g, (void)time;
    return true;
}

// A grid whose frame holds nothing: no texture, no active box.
static void empty_grid_is_transparent(void **state) {
    static const char *const modes[] = {"physical", "paper"};
    static const char *const samplings[] = {"linear", "quasi_cubic", "cubic"};
    for (size_t i = 0; i < COUNT_OF(modes) * COUNT_OF(samplings); i++) {
        pass_world w;
        world_open(&w, *state);
        field_grid grid = {.name = "nothing",
                           .box = {{-1, -1, -1}, {1, 1, 1}},
                           .size = {4, 4, 4},
                           .channel_count = 1,
                           .state = {.active = box3_empty()},
                           .update = update_nothing};
        pass *p = world_add(&w, "march", NULL, "march");
        gpu_test_ok(pass_set_option(p, "mode", modes[i % 2]));
        gpu_test_ok(pass_set_option(p, "sampling", samplings[i / 2]));
        gpu_test_ok(pass_set_field(p, "density", field_grid_channel(&w.memory, &grid, 0, 1)));
        gpu_test_ok(pass_set_field(p, "radiance", triple(&w, 1, 1, 1)));
        gpu_test_ok(pass_declare(p));
        world_render(&w, SIZE, SIZE, pass_output(p, "color"));
        float *pixels = world_read(&w, pass_output(p, "color"));
        for (int k = 0; k < 4 * PIXELS; k++) assert_true(pixels[k] == 0);
        mem_free(pixels);
        world_close(&w);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_not_a_number_wherever_the_camera_is),
        cmocka_unit_test(ray_along_the_axes_sees_the_whole_block),
        cmocka_unit_test(ray_past_a_face_sees_nothing),
        cmocka_unit_test(block_behind_the_camera_is_not_seen),
        cmocka_unit_test(short_step_does_not_cut_the_ray),
        cmocka_unit_test(empty_grid_is_transparent),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
