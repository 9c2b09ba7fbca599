// Temporal accumulation of a printed wall: what noise is left, and what the history must not do.
#include "effect_test.h"

enum { SIZE = 48, PIXELS = SIZE * SIZE };

typedef struct setup {
    float frames, spread, noise, response;
    const field *(*eye)(effect *e), *(*light)(effect *e), *(*wall)(effect *e); // NULL: at rest
    float half_width, scale;                                                   // 0: endless; 1
    float speed, told; // of the print, m/s; the one that accumulate knows
    bool surface;      // its depth instead of `reach`
} setup;

typedef struct stage {
    effect *e;
    pass *wall, *gather;
} stage;

static stage compile_stage(gpu *device, setup s) { // not yet allocated
    effect *e = open_effect(&(effect_desc){.device = device});
    gpu_test_ok(effect_set_timeline(e, 10, 1000, 1));
    if (s.eye) {
        effect_scene(e)->camera.eye = s.eye(e);
        effect_scene(e)->camera.target =
            make(e, "add", s.eye(e), triple(e, 0, 1, 0)); // always along +Y
    }
    pass *wall = add(e, NULL, "printed_wall.comp"), *gather = add(e, "accumulate", NULL);
    gpu_test_ok(pass_set_uniform(wall, "noise", number(e, s.noise)));
    if (s.light) gpu_test_ok(pass_set_uniform(wall, "light", s.light(e)));
    gpu_test_ok(pass_set_uniform(wall, "speed", number(e, s.speed)));
    if (s.told != 0) gpu_test_ok(pass_set_field(gather, "velocity", triple(e, s.told, 0, 0)));
    if (s.half_width > 0)
        gpu_test_ok(pass_set_uniform(wall, "half_width", number(e, s.half_width)));
    if (s.scale > 0) gpu_test_ok(pass_set_scale(wall, s.scale));
    gpu_test_ok(pass_declare(wall));
    gpu_test_ok(pass_set_uniform(gather, "frames", number(e, s.frames)));
    gpu_test_ok(pass_set_uniform(gather, "spread", number(e, s.spread)));
    gpu_test_ok(pass_set_uniform(gather, "response", number(e, s.response)));
    gpu_test_ok(pass_set_image(gather, "source", pass_output(wall, "color")));
    if (!s.surface) gpu_test_ok(pass_set_image(gather, "reach", pass_output(wall, "reach")));
    if (s.wall) {
        pass *behind = add(e, NULL, "wall.comp");
        gpu_test_ok(pass_set_uniform(behind, "distance_to", s.wall(e)));
        gpu_test_ok(pass_declare(behind));
        gpu_test_ok(pass_set_image(gather, "depth", pass_output(behind, "depth")));
    }
    gpu_test_ok(pass_declare(gather));
    const char *kept[] = {"color", "truth"};
    for (int i = 0; i < 2; i++) graph_add_output(effect_graph(e), pass_output(wall, kept[i]));
    graph_add_output(effect_graph(e), pass_output(gather, "state"));
    gpu_test_ok(effect_set_picture(e, EFFECT_OUTPUT, pass_output(gather, "color")));
    gpu_test_ok(effect_compile(e));
    return (stage){e, wall, gather};
}

static stage open_stage(gpu *device, setup s) {
    stage t = compile_stage(device, s);
    gpu_test_ok(effect_allocate(t.e, SIZE, SIZE));
    return t;
}

static void run(const stage *s, int first, int last) {
    for (int frame = first; frame <= last; frame++) gpu_test_ok(effect_render(s->e, frame, false));
}

// RGBA of an image of `p`; free with mem_free.
static float *look(const stage *s, const pass *p, const char *name) {
    gpu_image *image = graph_get_image(effect_graph(s->e), pass_output(p, name));
    const gpu_image_desc *desc = gpu_image_get_desc(image);
    size_t count = (size_t)desc->width * desc->height * 4;
    uint16_t *halves = mem_alloc(count * 2);
    gpu_test_ok(gpu_image_read(effect_pass_host(s->e)->device, image, halves, count * 2));
    float *out = mem_alloc(count * sizeof *out);
    for (size_t i = 0; i < count; i++) out[i] = half_to_float(halves[i]);
    mem_free(halves);
    return out;
}

// Root of the mean squared difference in red of all pixels but those near the picture's border.
static double error_of(const float *a, const float *b) {
    double sum = 0;
    int count = 0;
    for (int y = 4; y < SIZE - 4; y++)
        for (int x = 4; x < SIZE - 4; x++, count++) {
            double d = (double)a[4 * (y * SIZE + x)] - (double)b[4 * (y * SIZE + x)];
            sum += d * d;
        }
    return sqrt(sum / count);
}

typedef struct errors {
    double before, after; // of the source and of what was gathered, against the truth
} errors;

static errors errors_of(const stage *t) {
    float *source = look(t, t->wall, "color"), *truth = look(t, t->wall, "truth");
    float *gathered = look(t, t->gather, "color");
    errors e = {error_of(source, truth), error_of(gathered, truth)};
    mem_free(source);
    mem_free(truth);
    mem_free(gathered);
    return e;
}

static errors measure(gpu *device, setup s, int frames) {
    stage t = open_stage(device, s);
    run(&t, 1, frames);
    errors e = errors_of(&t);
    effect_destroy(t.e);
    return e;
}

static const field *moving_eye(effect *e) { // a tenth of a metre a frame: about a pixel
    static const curve_key keys[] = {{0, {0, -5, 0}}, {10, {10, -5, 0}}};
    const curve *c =
        curve_create(effect_memory(e), &(curve){CURVE_LINEAR, 3, keys, COUNT_OF(keys), 0});
    gpu_test_ok(c);
    return field_curve(effect_memory(e), c);
}

static const field *step_at(effect *e, float before, float after) { // between frames 10 and 11
    curve_key keys[] = {{0.93, {before}}, {0.97, {after}}};
    const curve *c =
        curve_create(effect_memory(e), &(curve){CURVE_LINEAR, 1, keys, COUNT_OF(keys), 0});
    gpu_test_ok(c);
    return field_curve(effect_memory(e), c);
}

static const field *goes_out(effect *e) {
    return step_at(e, 8, 0);
}

static const field *door_opens(effect *e) { // the scene behind the wall's print
    return step_at(e, 6, 9);
}

static void first_frame_is_its_source(void **state) {
    stage t = open_stage(*state, (setup){.frames = 8, .spread = 1, .noise = 0.2f});
    run(&t, 1, 1);
    float *source = look(&t, t.wall, "color"), *gathered = look(&t, t.gather, "color");
    assert_true(error_of(source, gathered) == 0);
    mem_free(source);
    mem_free(gathered);
    effect_destroy(t.e);
}

// The variance of what is left is that of a mean of as many frames as `frames` says.
static void noise_falls_with_the_root_of_frames(void **state) {
    const float frames[] = {1, 4, 16};
    for (size_t i = 0; i < COUNT_OF(frames); i++) {
        errors e = measure(*state, (setup){.frames = frames[i], .spread = 10, .noise = 0.2f}, 60);
        double want = e.before / sqrt((double)frames[i]);
        if (fabs(e.after - want) > 0.1 * want)
            fail_msg("%g frames: %g of %g is left", (double)frames[i], e.after, e.before);
    }
}

static void clipping_lets_most_of_the_noise_go(void **state) {
    errors e = measure(*state, (setup){.frames = 8, .spread = 1, .noise = 0.2f}, 40);
    assert_true(e.after < 0.5 * e.before);
}

static void moving_camera_finds_what_it_saw(void **state) {
    errors sharp = measure(*state, (setup){.frames = 8, .spread = 10, .eye = moving_eye}, 40);
    if (!(sharp.after < 0.002)) fail_msg("the print is off by %g", sharp.after);
    errors noisy =
        measure(*state, (setup){.frames = 8, .spread = 10, .eye = moving_eye, .noise = 0.2f}, 40);
    if (!(noisy.after < 0.5 * noisy.before))
        fail_msg("%g of %g is left", noisy.after, noisy.before);
}

static const field *depth_of_print(effect *e) {
    return number(e, 5);
}

static void surface_is_found_by_its_depth(void **state) {
    setup s = {.frames = 8, .spread = 10, .eye = moving_eye, .surface = true};
    double lost = measure(*state, s, 40).after; // taken to be infinitely far
    s.wall = depth_of_print;
    double found = measure(*state, s, 40).after;
    if (!(lost > 0.05 && found < 0.002)) fail_msg("off by %g, with depth by %g", lost, found);
}

static void what_moves_is_found_by_its_velocity(void **state) {
    setup s = {.frames = 8, .spread = 10, .speed = 1};
    double lost = measure(*state, s, 40).after;
    s.told = 1;
    double found = measure(*state, s, 40).after;
    if (!(lost > 0.05 && found < 0.002))
        fail_msg("off by %g, told the velocity by %g", lost, found);
}

static const field *dims(effect *e) {
    return step_at(e, 1, 0.5f);
}

// The print's waves are wide: all of their light is in the blurred picture.
static void blurred_picture_is_that_of_now(void **state) {
    setup s = {.frames = 8, .spread = 10, .light = dims};
    double late = measure(*state, s, 11).after;
    s.response = 1;
    double prompt = measure(*state, s, 11).after;
    if (!(late > 0.1 && prompt < 0.01)) fail_msg("off by %g, with response 1 by %g", late, prompt);
}

static void noise_of_short_waves_falls_whatever_the_response(void **state) {
    setup s = {.frames = 8, .spread = 10, .noise = 0.2f, .response = 1};
    errors e = measure(*state, s, 40);
    assert_true(e.after < 0.6 * e.before); // white noise: a part of it has long waves
}

static void light_that_goes_out_leaves_no_trail(void **state) {
    stage t = open_stage(*state, (setup){.frames = 64, .spread = 1, .light = goes_out});
    run(&t, 1, 10);
    float *lit = look(&t, t.gather, "color");
    run(&t, 11, 11);
    float *dark = look(&t, t.gather, "color");
    for (int i = 0; i < PIXELS; i++) assert_true(lit[4 * i] > 1 && dark[4 * i] < 0.001f);
    mem_free(lit);
    mem_free(dark);
    effect_destroy(t.e);
}

static float age_at(const stage *t, int x, int y) {
    float *known = look(t, t->gather, "state");
    float age = known[4 * (y * SIZE + x) + 2];
    mem_free(known);
    return age;
}

static void other_scene_has_no_history(void **state) {
    stage t = open_stage(*state, (setup){.frames = 8, .spread = 1, .wall = door_opens});
    run(&t, 1, 10);
    assert_true(age_at(&t, SIZE / 2, SIZE / 2) == 10);
    run(&t, 11, 11);
    assert_true(age_at(&t, SIZE / 2, SIZE / 2) == 1);
    effect_destroy(t.e);
}

static void what_comes_into_the_picture_has_no_history(void **state) {
    stage t = open_stage(*state, (setup){.frames = 8, .spread = 1, .eye = moving_eye});
    run(&t, 1, 20);
    assert_true(age_at(&t, SIZE - 1, SIZE / 2) == 1); // it moves to the right
    assert_true(age_at(&t, 1, SIZE / 2) == 20);
    effect_destroy(t.e);
}

static void jump_forgets(void **state) {
    stage t = open_stage(*state, (setup){.frames = 8, .spread = 1, .noise = 0.2f});
    run(&t, 1, 20);
    run(&t, 90, 90);
    assert_true(age_at(&t, SIZE / 2, SIZE / 2) == 1);
    effect_destroy(t.e);
}

static void next_effect_goes_on_where_the_last_camera_stood(void **state) {
    setup s = {.frames = 8, .spread = 10, .eye = moving_eye};
    stage old = open_stage(*state, s), next = compile_stage(*state, s);
    run(&old, 1, 20);
    gpu_test_ok(effect_adopt(next.e, old.e, SIZE, SIZE));
    effect_destroy(old.e);
    run(&next, 21, 21);
    assert_true(age_at(&next, 4, SIZE / 2) == 21);
    assert_true(errors_of(&next).after < 0.002);
    effect_destroy(next.e);
}

static void works_at_the_resolution_of_its_source(void **state) {
    stage t = open_stage(*state, (setup){.frames = 8, .spread = 1, .scale = 0.5f});
    run(&t, 1, 2);
    uint32_t size[3];
    graph_get_size(effect_graph(t.e), pass_output(t.gather, "color"), size);
    assert_int_equal(size[0], SIZE / 2);
    effect_destroy(t.e);
}

static void another_resolution_is_refused(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    pass *wall = add(e, NULL, "printed_wall.comp"), *gather = add(e, "accumulate", NULL);
    gpu_test_ok(pass_declare(wall));
    gpu_test_ok(pass_set_image(gather, "source", pass_output(wall, "color")));
    gpu_test_ok(pass_set_image(gather, "reach", pass_output(wall, "reach")));
    gpu_test_ok(pass_set_scale(gather, 0.5f));
    assert_false(pass_declare(gather));
    assert_string_equal(err_get(),
                        "accumulate: resolution is 0.5; accepted: that of its source, 1");
    effect_destroy(e);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_frame_is_its_source),
        cmocka_unit_test(noise_falls_with_the_root_of_frames),
        cmocka_unit_test(clipping_lets_most_of_the_noise_go),
        cmocka_unit_test(moving_camera_finds_what_it_saw),
        cmocka_unit_test(surface_is_found_by_its_depth),
        cmocka_unit_test(what_moves_is_found_by_its_velocity),
        cmocka_unit_test(blurred_picture_is_that_of_now),
        cmocka_unit_test(noise_of_short_waves_falls_whatever_the_response),
        cmocka_unit_test(light_that_goes_out_leaves_no_trail),
        cmocka_unit_test(other_scene_has_no_history),
        cmocka_unit_test(what_comes_into_the_picture_has_no_history),
        cmocka_unit_test(jump_forgets),
        cmocka_unit_test(next_effect_goes_on_where_the_last_camera_stood),
        cmocka_unit_test(works_at_the_resolution_of_its_source),
        cmocka_unit_test(another_resolution_is_refused),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
