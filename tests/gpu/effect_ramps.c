// Palettes, curves and the camera that change between frames of an effect that stands still.
#include "effect_test.h"

enum { SIZE = 16 };

static effect *open_lit(gpu *device) {
    static const palette_stop stops[] = {{0, {1, 0, 0, 1}}, {1, {1, 0, 0, 1}}};
    static const curve_key keys[] = {{0, {1}}, {1, {1}}};
    effect *e = open_effect(&(effect_desc){.device = device});
    arena *memory = effect_memory(e);
    palette *p = palette_create(
        memory, &(palette_desc){.keys = &(palette_key){0, stops, 2}, .key_count = 1});
    curve *c = curve_create(memory, &(curve){CURVE_LINEAR, 1, keys, 2, 0});
    gpu_test_ok(p && c && effect_add_palette(e, p, "fire") && effect_add_curve(e, c, "fade"));
    const field *color = field_swizzle(memory, field_palette(memory, p, number(e, 0.5f)), "rgb");
    pass *march = add_march(e, block(e, number(e, 50)));
    gpu_test_ok(pass_set_field(march, "radiance", make(e, "mul", color, field_curve(memory, c))));
    finish(e, march, SIZE, SIZE);
    return e;
}

static void is_near(effect *e, float red, float green) {
    assert_true(fabsf(middle(e, 1, SIZE, 0) - red) < 0.01f);
    assert_true(fabsf(middle(e, 1, SIZE, 1) - green) < 0.01f);
}

static void palette_and_curve_change_the_same_frame(void **state) {
    effect *e = open_lit(*state);
    uint64_t before = shader_library_compiles(effect_library(e));
    is_near(e, 1, 0);
    gpu_test_ok(effect_set(e, "fire", "0 0,0.5,0; 2 0,0.5,0"));
    is_near(e, 0, 0.5f);
    gpu_test_ok(effect_set(e, "fade", "step 0 0.5"));
    is_near(e, 0, 0.25f);
    gpu_test_ok(effect_reset(e, "fire"));
    is_near(e, 0.5f, 0);
    gpu_test_ok(effect_reset(e, "fade"));
    is_near(e, 1, 0);
    assert_int_equal(shader_library_compiles(effect_library(e)), before);
    effect_destroy(e);
}

static void camera_changes_the_same_frame(void **state) {
    effect *e = open_lit(*state);
    gpu_test_ok(effect_set(e, "camera.target", "0,-10,0")); // the other way
    assert_true(middle(e, 1, SIZE, 3) == 0);
    gpu_test_ok(effect_set(e, "camera.eye", "0,-20,0"));
    assert_true(middle(e, 1, SIZE, 3) > 0.99f);
    gpu_test_ok(effect_reset(e, "camera.eye"));
    assert_true(middle(e, 1, SIZE, 3) == 0);
    effect_destroy(e);
}

// A window shows it until what is set mends it.
static void what_moves_beyond_its_range_is_told_until_it_does_not(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    pass *march = add_march(e, block(e, number(e, 50)));
    gpu_test_ok(pass_set_uniform(march, "steps", param(e, "steps", 0, 9)));
    gpu_test_ok(pass_set_uniform(march, "jitter", param(e, "jitter", 2, 9)));
    finish(e, march, SIZE, SIZE);
    assert_null(effect_get_warning(e));
    static const struct {
        const char *steps, *jitter, *said;
    } cases[] = {
        {"0", "2", "uniform 'steps' is 0 at 0 s; accepted: 1 to 4096; it counts as 1"},
        {"5", "2", "uniform 'jitter' is 2 at 0 s"},
        {"5", "1", NULL},
        {"0", "1", "uniform 'steps' is 0 at 0 s"}, // again, though it was logged before
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        gpu_test_ok(effect_set(e, "steps", cases[i].steps));
        gpu_test_ok(effect_set(e, "jitter", cases[i].jitter));
        gpu_test_ok(effect_render(e, 1, false));
        const char *said = effect_get_warning(e);
        if (cases[i].said && (!said || !strstr(said, cases[i].said)))
            fail_msg("case %zu: '%s'", i, said ? said : "nothing");
        if (!cases[i].said && said) fail_msg("case %zu: '%s'", i, said);
    }
    effect_destroy(e);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(palette_and_curve_change_the_same_frame),
        cmocka_unit_test(camera_changes_the_same_frame),
        cmocka_unit_test(what_moves_beyond_its_range_is_told_until_it_does_not),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
