// What users write themselves: GLSL functions as fields, and passes that read fields.
#include "pass_test.h"

enum { SIZE = 24, PIXELS = SIZE * SIZE };

static const field_glsl onion = {"onion.glsl", "onion", 1, 2};
static const field_glsl stripes = {"onion.glsl", "stripes", 3, 0};
static const field_glsl broken = {"broken.glsl", "broken", 1, 0};

static const field *make_user(pass_world *w, const field_glsl *glsl, const field *a,
                              const field *b) {
    const field *const args[] = {a, b, NULL};
    const field *node = field_user(&w->memory, glsl, args);
    gpu_test_ok(node);
    return node;
}

static const field *make_onion(pass_world *w, float radius) {
    return make_user(w, &onion, number(w, radius), triple(w, 0.1f, 0, -0.1f));
}

static float onion_twin(const float p[3], float radius) {
    float x = p[0] - 0.1f, y = p[1], z = p[2] + 0.1f;
    float d = sqrtf(x * x + y * y + z * z);
    return d < radius ? 0.5f + 0.5f * cosf(20 * d) : 0;
}

static void slice_point(uint32_t i, float half, float y, float p[3]) {
    p[0] = (2 * ((float)(i % SIZE) + 0.5f) / SIZE - 1) * half;
    p[1] = y;
    p[2] = (1 - 2 * ((float)(i / SIZE) + 0.5f) / SIZE) * half;
}

static void users_pass_evaluates_any_field(void **state) {
    pass_world w;
    world_open(&w, *state);
    const field *ball =
        row(&w, "sphere", SET("radius", number(&w, 1)), SET("falloff", number(&w, 0.3f)));
    const field *noise = row(&w, "perlin", SET("frequency", number(&w, 3)));
    const field *value = row(&w, "mul", SET("a", ball), SET("b", noise));
    pass *p = world_add(&w, NULL, "slice.comp", "slice");
    gpu_test_ok(pass_set_field(p, "value", value));
    gpu_test_ok(pass_set_uniform(p, "half_width", number(&w, 1.25f)));
    gpu_test_ok(pass_set_uniform(p, "y", number(&w, 0.2f)));
    gpu_test_ok(pass_declare(p));
    world_render(&w, SIZE, SIZE, pass_output(p, "color"));
    float *c = world_read(&w, pass_output(p, "color"));
    size_t inside = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        float at[3], want[4];
        slice_point(i, 1.25f, 0.2f, at);
        gpu_test_ok(field_eval(value, &w.context, (float3){at[0], at[1], at[2]}, want));
        assert_true(fabsf(c[4 * i + 3] - want[0]) < 0.001f && c[4 * i] == c[4 * i + 3]);
        inside += want[0] > 0;
    }
    assert_true(inside > PIXELS / 4 && inside < PIXELS);
    mem_free(c);
    world_close(&w);
}

static void users_function_is_a_field_with_arguments(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *p = world_add(&w, NULL, "slice.comp", "slice");
    gpu_test_ok(pass_set_field(p, "value", make_onion(&w, 0.8f)));
    gpu_test_ok(pass_set_field(p, "tint", make_user(&w, &stripes, NULL, NULL)));
    gpu_test_ok(pass_declare(p));
    world_render(&w, SIZE, SIZE, pass_output(p, "color"));
    float *c = world_read(&w, pass_output(p, "color"));
    for (uint32_t i = 0; i < PIXELS; i++) {
        float at[3];
        slice_point(i, 1, 0, at);
        float want = onion_twin(at, 0.8f);
        assert_true(fabsf(c[4 * i + 3] - want) < 0.001f);
        assert_true(fabsf(c[4 * i] - want * (0.5f + 0.5f * sinf(7 * at[0]))) < 0.002f);
        assert_true(fabsf(c[4 * i + 2] - want * (0.5f + 0.5f * sinf(7 * at[2]))) < 0.002f);
    }
    mem_free(c);
    world_close(&w);
}

static void march_goes_through_a_users_field(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *p = world_add(&w, "march", NULL, "march");
    const field *density =
        row(&w, "mul", SET("a", block(&w, 1, 1)), SET("b", make_onion(&w, 0.9f)));
    gpu_test_ok(pass_set_field(p, "density", density));
    gpu_test_ok(pass_set_uniform(p, "steps", number(&w, 512)));
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(&w, 0)));
    gpu_test_ok(pass_declare(p));
    world_render(&w, SIZE + 1, SIZE + 1, pass_output(p, "color"));
    float *c = world_read(&w, pass_output(p, "color"));
    double sum = 0, step = 1e-4; // the middle ray runs along the Y axis
    for (double y = -1 + step / 2; y < 1; y += step)
        sum += step * (double)onion_twin((float[3]){0, (float)y, 0}, 0.9f);
    double got = (double)c[4 * (SIZE / 2 * (SIZE + 1) + SIZE / 2) + 3], want = 1 - exp(-sum);
    if (fabs(got - want) > 0.005 * want) fail_msg("opacity %g, not %g", got, want);
    mem_free(c);
    world_close(&w);
}

static void users_field_without_a_shape_fills_space(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *p = world_add(&w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(p, "density", make_onion(&w, 1)));
    assert_false(pass_declare(p));
    assert_non_null(strstr(err_get(), "march: field 'density' fills all of space"));
    world_close(&w);
}

static void mistake_in_a_users_file_is_named_with_its_line(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *p = world_add(&w, NULL, "slice.comp", "slice");
    gpu_test_ok(pass_set_field(p, "value", make_user(&w, &broken, NULL, NULL)));
    gpu_test_ok(pass_declare(p));
    assert_false(pass_build(p));
    assert_non_null(strstr(err_get(), "broken.glsl:3: "));
    assert_non_null(strstr(err_get(), "pp"));
    world_close(&w);
}

static void required_field_that_is_missing_is_named(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *p = world_add(&w, NULL, "slice.comp", "slice");
    assert_false(pass_declare(p));
    assert_string_equal(err_get(), "slice: field 'value' is missing (what is shown)");
    world_close(&w);
}

static void field_of_other_width_is_refused(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *p = world_add(&w, NULL, "slice.comp", "slice");
    assert_false(pass_set_field(p, "value", make_user(&w, &stripes, NULL, NULL)));
    assert_string_equal(err_get(), "slice: field 'value' has 1 components, not 3");
    gpu_test_ok(pass_set_field(p, "tint", make_onion(&w, 1))); // one widens
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(users_pass_evaluates_any_field),
        cmocka_unit_test(users_function_is_a_field_with_arguments),
        cmocka_unit_test(march_goes_through_a_users_field),
        cmocka_unit_test(users_field_without_a_shape_fills_space),
        cmocka_unit_test(mistake_in_a_users_file_is_named_with_its_line),
        cmocka_unit_test(required_field_that_is_missing_is_named),
        cmocka_unit_test(field_of_other_width_is_refused),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
