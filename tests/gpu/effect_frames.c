// An effect frame by frame: time, randomness, histories, numbers that change, hooks that fail.
#include "effect_test.h"

enum { SIZE = 17, PIXELS = SIZE * SIZE };

static effect *open_block(gpu *device, const field *(*density)(effect *e), pass **march) {
    effect *e = open_effect(&(effect_desc){.device = device});
    gpu_test_ok(effect_set_timeline(e, 10, 100, 1));
    *march = add_march(e, block(e, density(e)));
    return e;
}

static double opacity(double density) { // of the block, 2 m deep
    return 1 - exp(-2 * density);
}

// ---- time -------------------------------------------------------------------------------------

static const field *rising(effect *e) { // 0 at first, 1 after a second
    static const curve_key keys[] = {{0, {0}}, {1, {1}}};
    const curve *c =
        curve_create(effect_memory(e), &(curve){CURVE_LINEAR, 1, keys, COUNT_OF(keys), 0});
    gpu_test_ok(c);
    return field_curve(effect_memory(e), c);
}

static void curve_has_the_value_of_the_frames_time(void **state) {
    pass *p;
    effect *e = open_block(*state, rising, &p);
    finish(e, p, SIZE, SIZE);
    const double frames[] = {1, 2, 6, 11, 50, 3.5}; // time = (frame - 1) / 10, in any order
    for (size_t i = 0; i < COUNT_OF(frames); i++) {
        double want = opacity(fmin((frames[i] - 1) / 10, 1));
        double got = (double)middle(e, frames[i], SIZE, 3);
        if (fabs(got - want) > 0.002) fail_msg("frame %g: %g, not %g", frames[i], got, want);
    }
    effect_destroy(e);
}

static const field *clock_seconds(effect *e) {
    return field_time(effect_memory(e));
}

static void first_frame_may_have_any_number(void **state) {
    pass *p;
    effect *e = open_block(*state, clock_seconds, &p);
    gpu_test_ok(effect_set_timeline(e, 25, 10, 1001));
    finish(e, p, SIZE, SIZE);
    assert_true(middle(e, 1001, SIZE, 3) == 0);
    assert_true(fabs((double)middle(e, 1011, SIZE, 3) - opacity(0.4)) < 0.002);
    effect_destroy(e);
}

// ---- randomness -------------------------------------------------------------------------------

static const field *ramp(effect *e) { // varies along the rays, so that jitter shows
    const field *position = make(e, "position", NULL);
    const field *y = field_swizzle(effect_memory(e), position, "y");
    return make(e, "abs", make(e, "sin", make(e, "mul", y, number(e, 3))));
}

static float *jittered(gpu *device, uint32_t seed, double frame) {
    pass *p;
    effect *e = open_block(device, ramp, &p);
    effect_set_seed(e, seed);
    gpu_test_ok(pass_set_uniform(p, "jitter", number(e, 1)));
    gpu_test_ok(pass_set_uniform(p, "steps", number(e, 4)));
    finish(e, p, SIZE, SIZE);
    gpu_test_ok(effect_render(e, frame, false));
    float *pixels = read_picture(e);
    effect_destroy(e);
    return pixels;
}

static void jitter_follows_frame_and_seed_alone(void **state) {
    float *one = jittered(*state, 5, 7), *again = jittered(*state, 5, 7);
    float *later = jittered(*state, 5, 8), *other = jittered(*state, 6, 7);
    size_t size = 4 * PIXELS * sizeof *one;
    assert_memory_equal(one, again, size);
    assert_memory_not_equal(one, later, size);
    assert_memory_not_equal(one, other, size);
    assert_memory_not_equal(later, other, size);
    mem_free(one);
    mem_free(again);
    mem_free(later);
    mem_free(other);
}

// ---- numbers ----------------------------------------------------------------------------------

static void parameter_changes_the_next_frame(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    pass *p = add_march(e, block(e, param(e, "density", 0.2f, 10)));
    finish(e, p, SIZE, SIZE);
    assert_true(fabs((double)middle(e, 1, SIZE, 3) - opacity(0.2)) < 0.002);
    gpu_test_ok(effect_set(e, "density", "0.7"));
    assert_true(fabs((double)middle(e, 2, SIZE, 3) - opacity(0.7)) < 0.002);
    gpu_test_ok(effect_set_value(e, 0, (float[4]){1.5f}));
    assert_true(fabs((double)middle(e, 3, SIZE, 3) - opacity(1.5)) < 0.002);
    assert_false(effect_set(e, "density", "11"));
    assert_true(fabs((double)middle(e, 4, SIZE, 3) - opacity(1.5)) < 0.002);
    effect_destroy(e);
}

static void uniform_may_be_set_between_frames(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    pass *p = add_march(e, block(e, number(e, 1)));
    gpu_test_ok(pass_set_field(p, "radiance", triple(e, 0, 0, 0)));
    effect_scene(e)->sky.strength = number(e, 1);
    effect_scene(e)->sky.zenith = effect_scene(e)->sky.horizon = triple(e, 1, 1, 1);
    finish(e, p, SIZE, SIZE);
    gpu_test_ok(effect_set(e, "march.albedo", "0.5,0.25,1"));
    float half = middle(e, 1, SIZE, 0);
    assert_true(half > 0 && fabsf(middle(e, 2, SIZE, 2) - 2 * half) < 0.004f);
    gpu_test_ok(effect_set(e, "march.albedo", "0 0 0"));
    assert_true(middle(e, 3, SIZE, 0) == 0);
    assert_false(effect_set(e, "march.mode", "paper"));
    assert_non_null(strstr(err_get(), "march.mode is structure"));
    effect_destroy(e);
}

static bool call_hook(void *user, int function, double time, float out[4]) {
    (void)user;
    if (time > 0) return err_set("effect.lua:%d: a function that fails", function);
    out[0] = 0.5f;
    return true;
}

static const field *called(effect *e) {
    return field_call(effect_memory(e), 1, 12);
}

static void function_that_fails_stops_the_frame_with_its_line(void **state) {
    pass *p;
    effect *e = open_block(*state, called, &p);
    effect_set_hooks(e, &(effect_hooks){.call = call_hook});
    finish(e, p, SIZE, SIZE);
    assert_true(fabs((double)middle(e, 1, SIZE, 3) - opacity(0.5)) < 0.002);
    assert_int_equal(effect_render(e, 2, false), 0);
    assert_string_equal(err_get(), "pass 'march.bricks': effect.lua:12: a function that fails");
    assert_true(fabs((double)middle(e, 1, SIZE, 3) - opacity(0.5)) < 0.002);
    effect_destroy(e);
}

static void uniforms_function_that_fails_is_named_too(void **state) {
    pass *p;
    effect *e = open_block(*state, rising, &p);
    effect_set_hooks(e, &(effect_hooks){.call = call_hook});
    gpu_test_ok(pass_set_uniform(p, "ambient", called(e)));
    finish(e, p, SIZE, SIZE);
    gpu_test_ok(effect_render(e, 1, false));
    assert_int_equal(effect_render(e, 2, false), 0);
    assert_string_equal(
        err_get(), "pass 'march.bricks': uniform 'ambient': effect.lua:12: a function that fails");
    effect_destroy(e);
}

// ---- hooks ------------------------------------------------------------------------------------

typedef struct script {
    double time, dt;
    int calls, destroyed;
    bool fails;
} script;

static bool update_hook(void *user, double time, double dt) {
    script *s = user;
    s->time = time;
    s->dt = dt;
    s->calls++;
    return !s->fails || err_set("effect.lua:3: attempt to index a nil value");
}

static void destroy_hook(void *user) {
    ((script *)user)->destroyed++;
}

static void update_is_called_once_a_frame_with_its_time(void **state) {
    script s = {0};
    pass *p;
    effect *e = open_block(*state, clock_seconds, &p);
    effect_set_hooks(e,
                     &(effect_hooks){.update = update_hook, .destroy = destroy_hook, .user = &s});
    finish(e, p, SIZE, SIZE);
    gpu_test_ok(effect_render(e, 4, false));
    assert_true(s.calls == 1 && fabs(s.time - 0.3) < 1e-9 && s.dt == 0);
    gpu_test_ok(effect_render(e, 5, false));
    assert_true(s.calls == 2 && fabs(s.time - 0.4) < 1e-9 && fabs(s.dt - 0.1) < 1e-9);
    effect_destroy(e);
    assert_int_equal(s.destroyed, 1);
}

static void update_that_fails_stops_the_frame_with_its_message(void **state) {
    script s = {.fails = true};
    pass *p;
    effect *e = open_block(*state, clock_seconds, &p);
    effect_set_hooks(e,
                     &(effect_hooks){.update = update_hook, .destroy = destroy_hook, .user = &s});
    finish(e, p, SIZE, SIZE);
    assert_int_equal(effect_render(e, 1, false), 0);
    assert_string_equal(err_get(), "effect.lua:3: attempt to index a nil value");
    s.fails = false;
    assert_true(fabs((double)middle(e, 6, SIZE, 3) - opacity(0.5)) < 0.002);
    effect_destroy(e);
}

// ---- histories --------------------------------------------------------------------------------

static effect *open_trail(gpu *device, script *s) {
    effect *e = open_effect(&(effect_desc){.device = device});
    if (s)
        effect_set_hooks(
            e, &(effect_hooks){.update = update_hook, .destroy = destroy_hook, .user = s});
    pass *trail = add(e, NULL, "trail.comp");
    gpu_test_ok(pass_declare(trail));
    gpu_test_ok(effect_set_picture(e, EFFECT_OUTPUT, pass_output(trail, "count")));
    gpu_test_ok(effect_build(e, SIZE, SIZE));
    return e;
}

static void history_starts_anew_unless_the_next_frame_follows(void **state) {
    effect *e = open_trail(*state, NULL);
    for (int i = 1; i <= 4; i++) assert_true(middle(e, i, SIZE, 0) == (float)i);
    assert_true(middle(e, 10, SIZE, 0) == 1); // a jump
    assert_true(middle(e, 11, SIZE, 0) == 2);
    assert_true(middle(e, 11, SIZE, 0) == 1); // the same again
    assert_true(middle(e, 10, SIZE, 0) == 1); // back
    assert_true(middle(e, 11, SIZE, 0) == 2);
    effect_destroy(e);
}

static void frame_that_failed_leaves_no_history(void **state) {
    script s = {0};
    effect *e = open_trail(*state, &s);
    assert_true(middle(e, 1, SIZE, 0) == 1 && middle(e, 2, SIZE, 0) == 2);
    s.fails = true;
    assert_int_equal(effect_render(e, 3, false), 0);
    s.fails = false;
    assert_true(middle(e, 4, SIZE, 0) == 1); // 3 was never made
    assert_true(middle(e, 5, SIZE, 0) == 2);
    effect_destroy(e);
}

static void other_size_starts_histories_anew(void **state) {
    effect *e = open_trail(*state, NULL);
    assert_true(middle(e, 1, SIZE, 0) == 1 && middle(e, 2, SIZE, 0) == 2);
    gpu_test_ok(effect_build(e, 40, 40));
    assert_true(middle(e, 3, 40, 0) == 1 && middle(e, 4, 40, 0) == 2);
    effect_destroy(e);
}

// ---- the rest ---------------------------------------------------------------------------------

static uint64_t samples_taken(gpu *device, bool counters) {
    effect *e = open_effect(&(effect_desc){.device = device, .counters = counters});
    pass *p = add_march(e, block(e, number(e, 1)));
    gpu_test_ok(pass_set_uniform(p, "steps", number(e, 32)));
    gpu_test_ok(pass_set_uniform(p, "shadow_steps", number(e, 0)));
    effect_scene(e)->camera.eye = triple(e, 0, 0, 0); // inside: every ray goes through
    effect_scene(e)->camera.target = triple(e, 0, 1, 0);
    finish(e, p, SIZE, SIZE);
    gpu_test_ok(effect_render(e, 1, false));
    gpu_test_ok(effect_render(e, 2, false));
    uint64_t counts[8] = {0};
    assert_int_equal(pass_interface(p)->counter_count, 2);
    gpu_test_ok(pass_read_counters(p, counts));
    effect_destroy(e);
    return counts[0];
}

static void counter_is_of_one_frame(void **state) {
    assert_int_equal(samples_taken(*state, true), PIXELS * 32);
    assert_int_equal(samples_taken(*state, false), 0);
}

static void two_effects_share_a_device(void **state) {
    pass *a, *b;
    effect *first = open_block(*state, clock_seconds, &a);
    effect *second = open_block(*state, rising, &b);
    finish(first, a, SIZE, SIZE);
    finish(second, b, SIZE, SIZE);
    for (int frame = 1; frame <= 5; frame++) {
        double want = opacity((frame - 1) / 10.0);
        assert_true(fabs((double)middle(first, frame, SIZE, 3) - want) < 0.002);
        assert_true(fabs((double)middle(second, frame, SIZE, 3) - want) < 0.002);
    }
    effect_destroy(first);
    assert_true(fabs((double)middle(second, 6, SIZE, 3) - opacity(0.5)) < 0.002);
    effect_destroy(second);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(curve_has_the_value_of_the_frames_time),
        cmocka_unit_test(first_frame_may_have_any_number),
        cmocka_unit_test(jitter_follows_frame_and_seed_alone),
        cmocka_unit_test(parameter_changes_the_next_frame),
        cmocka_unit_test(uniform_may_be_set_between_frames),
        cmocka_unit_test(function_that_fails_stops_the_frame_with_its_line),
        cmocka_unit_test(uniforms_function_that_fails_is_named_too),
        cmocka_unit_test(update_is_called_once_a_frame_with_its_time),
        cmocka_unit_test(update_that_fails_stops_the_frame_with_its_message),
        cmocka_unit_test(history_starts_anew_unless_the_next_frame_follows),
        cmocka_unit_test(frame_that_failed_leaves_no_history),
        cmocka_unit_test(other_size_starts_histories_anew),
        cmocka_unit_test(counter_is_of_one_frame),
        cmocka_unit_test(two_effects_share_a_device),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
