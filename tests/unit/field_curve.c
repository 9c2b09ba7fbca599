// Curves: shapes between keys, ends, periods, and keys that make no sense.
#include "field_build.h"

#include "field/curve.h"

static const curve_key ramp[] = {{1, {10}}, {2, {20}}, {4, {0}}};

static const curve *curve_of(curve_shape shape, float period) {
    const curve desc = {shape, 1, ramp, COUNT_OF(ramp), period};
    const curve *c = curve_create(build_memory(), &desc);
    if (!c) fail_msg("%s", err_get());
    return c;
}

static float at(const curve *c, double time) {
    float out[4];
    curve_eval(c, time, out);
    assert_true(out[1] == 0 && out[3] == 0);
    return out[0];
}

static void every_shape_goes_through_its_keys(void **state) {
    (void)state;
    for (int s = 0; s < CURVE_SHAPE_COUNT; s++)
        for (size_t i = 0; i < COUNT_OF(ramp); i++)
            assert_true(fabsf(at(curve_of((curve_shape)s, 0), (double)ramp[i].time) -
                              ramp[i].value[0]) < 1e-5f);
}

static void ends_hold(void **state) {
    (void)state;
    for (int s = 0; s < CURVE_SHAPE_COUNT; s++) {
        assert_true(at(curve_of((curve_shape)s, 0), -100) == 10);
        assert_true(at(curve_of((curve_shape)s, 0), 100) == 0);
    }
}

static void shapes_between_keys(void **state) {
    (void)state;
    assert_true(at(curve_of(CURVE_STEP, 0), 1.99) == 10);
    assert_true(fabsf(at(curve_of(CURVE_LINEAR, 0), 3) - 10) < 1e-5f);
    assert_true(fabsf(at(curve_of(CURVE_EASE_IN, 0), 1.5) - 11.25f) < 1e-5f);
    assert_true(fabsf(at(curve_of(CURVE_EASE_OUT, 0), 1.5) - 18.75f) < 1e-5f);
    assert_true(fabsf(at(curve_of(CURVE_EASE_IN_OUT, 0), 1.5) - 15) < 1e-5f);
    assert_true(fabsf(at(curve_of(CURVE_EASE_IN_OUT, 0), 1.25) - 10.625f) < 1e-5f);
}

static void cubic_is_smooth_and_never_overshoots(void **state) {
    (void)state;
    static const curve_key steps[] = {{0, {0}},    {1, {0.1f}}, {2, {5}},
                                      {2.5f, {5}}, {4, {6}},    {5, {-3}}};
    const curve *c =
        curve_create(build_memory(), &(curve){CURVE_CUBIC, 1, steps, COUNT_OF(steps), 0});
    for (size_t k = 0; k + 1 < COUNT_OF(steps); k++) {
        float low = fminf(steps[k].value[0], steps[k + 1].value[0]);
        float high = fmaxf(steps[k].value[0], steps[k + 1].value[0]), before = steps[k].value[0];
        for (int i = 0; i <= 100; i++) {
            double t =
                (double)steps[k].time + i / 100.0 * (double)(steps[k + 1].time - steps[k].time);
            float v = at(c, t);
            assert_true(v >= low - 1e-5f && v <= high + 1e-5f);
            bool rising = steps[k + 1].value[0] >= steps[k].value[0];
            assert_true(rising ? v >= before - 1e-5f : v <= before + 1e-5f);
            before = v;
        }
    }
    for (size_t k = 1; k + 1 < COUNT_OF(steps); k++) { // one slope on both sides of a key
        double t = (double)steps[k].time, h = 1e-3;
        double left = (double)(at(c, t) - at(c, t - h)) / h,
               right = (double)(at(c, t + h) - at(c, t)) / h;
        assert_true(fabs(left - right) < 0.2);
    }
}

static void a_period_starts_again(void **state) {
    (void)state;
    const curve *c = curve_of(CURVE_LINEAR, 5);
    assert_true(fabsf(at(c, 6.5) - 15) < 1e-5f);
    assert_true(fabsf(at(c, -3.5) - 15) < 1e-5f);
    assert_true(at(c, 4.5) == 0); // after the last key it holds
    assert_true(at(c, 5.5) == 10);
}

static void components_move_together(void **state) {
    (void)state;
    static const curve_key keys[] = {{0, {0, 1, 2, 3}}, {2, {2, 1, 0, -1}}};
    const curve *c = curve_create(build_memory(), &(curve){CURVE_LINEAR, 4, keys, 2, 0});
    float out[4];
    curve_eval(c, 1, out);
    for (int i = 0; i < 4; i++) assert_true(out[i] == 1);
}

static void keys_are_copied(void **state) {
    (void)state;
    curve_key key = {0, {7}};
    const curve *c = curve_create(build_memory(), &(curve){CURVE_LINEAR, 1, &key, 1, 0});
    key.value[0] = 8;
    assert_true(at(c, 3) == 7);
    assert_true(at(c, NAN) == 7);
}

static void refuses(const curve *desc, const char *part) {
    err_clear();
    assert_null(curve_create(build_memory(), desc));
    assert_error(part);
}

static void bad_keys_are_refused(void **state) {
    (void)state;
    static const curve_key equal[] = {{1, {0}}, {1, {1}}}, nan_value[] = {{0, {NAN}}},
                           nan_time[] = {{NAN, {0}}};
    refuses(&(curve){CURVE_LINEAR, 1, NULL, 0, 0}, "no keys");
    refuses(&(curve){CURVE_LINEAR, 1, equal, 2, 0}, "key 2 at 1 s does not come after");
    refuses(&(curve){CURVE_LINEAR, 1, nan_value, 1, 0}, "not finite");
    refuses(&(curve){CURVE_LINEAR, 1, nan_time, 1, 0}, "no finite time");
    refuses(&(curve){CURVE_LINEAR, 1, ramp, 3, -1}, "period");
    refuses(&(curve){CURVE_LINEAR, 1, ramp, 3, 3}, "outside the period");
    refuses(&(curve){CURVE_LINEAR, 5, ramp, 3, 0}, "5 components");
    refuses(&(curve){CURVE_SHAPE_COUNT, 1, ramp, 3, 0}, "unknown shape");
    assert_string_equal(curve_shape_name(CURVE_EASE_IN_OUT), "ease_in_out");
}

static void replaced_curve_is_the_new_one_and_can_be_restored(void **state) {
    (void)state;
    curve *c = (curve *)(uintptr_t)curve_of(CURVE_LINEAR, 0);
    const curve original = *c;
    static const curve_key other[] = {{0, {5}}, {1, {7}}};
    assert_true(curve_replace(c, &(curve){CURVE_STEP, 1, other, 2, 0}));
    assert_true(at(c, 0.5) == 5 && at(c, 2) == 7);
    assert_true(curve_replace(c, &original));
    assert_true(fabsf(at(c, 3) - 10) < 1e-5f);
}

static void bad_replacement_changes_nothing(void **state) {
    (void)state;
    curve *c = (curve *)(uintptr_t)curve_of(CURVE_LINEAR, 0);
    static const curve_key pair[] = {{0, {5, 6, 7}}, {1, {7, 8, 9}}},
                           equal[] = {{1, {0}}, {1, {1}}};
    err_clear();
    assert_false(curve_replace(c, &(curve){CURVE_STEP, 3, pair, 2, 0}));
    assert_error("its values have 1 component, not 3");
    assert_false(curve_replace(c, &(curve){CURVE_STEP, 1, equal, 2, 0}));
    assert_error("does not come after");
    curve_key many[CURVE_MAX_KEYS + 1] = {0};
    for (int i = 0; i <= CURVE_MAX_KEYS; i++) many[i].time = (float)i;
    assert_false(curve_replace(c, &(curve){CURVE_STEP, 1, many, CURVE_MAX_KEYS + 1, 0}));
    assert_error("65 keys; at most 64");
    assert_true(fabsf(at(c, 3) - 10) < 1e-5f);
}

static void text_gives_keys_and_back(void **state) {
    (void)state;
    static const char *const texts[] = {"cubic 0 1; 2.5 0.1", "ease_in_out -1 0,1,0; 3 4,5,6",
                                        "step 0 0.3333333,2"};
    for (size_t i = 0; i < COUNT_OF(texts); i++) {
        curve_key keys[CURVE_MAX_KEYS];
        curve c;
        if (!curve_parse(texts[i], keys, &c)) fail_msg("%s", err_get());
        strbuf out = {0};
        curve_print(&c, &out);
        assert_string_equal(strbuf_text(&out), texts[i]);
        strbuf_free(&out);
    }
}

static void text_that_is_no_curve_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *text, *part;
    } bad[] = {
        {"", "'' is no shape"},          {"wavy 0 1", "'wavy' is no shape; accepted: step, linear"},
        {"0 1; 2 3", "'0' is no shape"}, {"linear 0", "key 1"},
        {"linear 0 1; 2", "key 2"},      {"linear 0 1; 2 1,2", "key 2"},
        {"linear 0 1,2,3,4,5", "key 1"}, {"linear 0 nan", "key 1"},
        {"linear 0 1 2", "key 1"},       {"linear 0 1;;", "key 2"},
    };
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        curve_key keys[CURVE_MAX_KEYS];
        curve c;
        err_clear();
        if (curve_parse(bad[i].text, keys, &c)) fail_msg("'%s' was taken", bad[i].text);
        assert_error(bad[i].part);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shape_goes_through_its_keys),
        cmocka_unit_test(ends_hold),
        cmocka_unit_test(shapes_between_keys),
        cmocka_unit_test(cubic_is_smooth_and_never_overshoots),
        cmocka_unit_test(a_period_starts_again),
        cmocka_unit_test(components_move_together),
        cmocka_unit_test(keys_are_copied),
        cmocka_unit_test(bad_keys_are_refused),
        cmocka_unit_test(replaced_curve_is_the_new_one_and_can_be_restored),
        cmocka_unit_test(bad_replacement_changes_nothing),
        cmocka_unit_test(text_gives_keys_and_back),
        cmocka_unit_test(text_that_is_no_curve_is_refused),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    arena_free(build_memory());
    return failed;
}
