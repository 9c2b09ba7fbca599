// Noise that is advected: it moves with the flow, keeps its contrast, and never jumps.
#include "field_build.h"

static const double pi = 3.14159265358979323846;

static double weight(double time, double period, int k, int count) {
    double turns = time / period + (double)k / count;
    return sin(pi * (turns - floor(turns))) * sqrt(2.0 / count);
}

static double age(double time, double period, int k, int count) {
    double turns = time / period + (double)k / count;
    return (turns - floor(turns) - 0.5) * period;
}

static void patterns_are_blended_as_documented(void **state) {
    (void)state;
    field *x = need_field(field_swizzle(build_memory(), make("position", NULL), "x"));
    for (int count = 2; count < 4; count++) {
        field *a = row("advect", SET("value", x), SET("velocity", vector(3, 1, 2)),
                       SET("period", number(0.8f)), SET("mean", number(0.25f)),
                       WORD("phases", count == 2 ? "2" : "3"));
        for (double time = 0.05; time < 2; time += 0.13) {
            double want = 0.25;
            for (int k = 0; k < count; k++)
                want += weight(time, 0.8, k, count) * (7 - 3 * age(time, 0.8, k, count) - 0.25);
            assert_true(fabs((double)value_at(a, time, (float3){7, 0, 0}) - want) < 1e-4);
        }
    }
}

static field *carried(const char *kind, float3 velocity, const char *phases) {
    return row("advect", SET("value", row(kind, SET("octaves", number(2)), SET("seed", number(3)))),
               SET("velocity", vector(velocity.x, velocity.y, velocity.z)), WORD("phases", phases));
}

// Correlation of what is at p at one time with what is at p + by at another.
static double correlation(const field *node, double from, double to, float3 by) {
    enum { COUNT = 4000 };
    uint32_t seed = 1;
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (int i = 0; i < COUNT; i++) {
        float3 p = random_point(&seed, 200);
        double x = (double)value_at(node, from, p);
        double y = (double)value_at(node, to, (float3){p.x + by.x, p.y + by.y, p.z + by.z});
        a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
    }
    return (ab - a * b / COUNT) / sqrt((aa - a * a / COUNT) * (bb - b * b / COUNT));
}

static void patterns_move_with_the_flow(void **state) {
    (void)state;
    field *n = carried("perlin", (float3){4, 0, -2}, "2");
    for (double time = 0; time < 1.2; time += 0.17) { // across resets too
        assert_true(correlation(n, time, time + 0.1, (float3){0.4f, 0, -0.2f}) > 0.88);
        assert_true(correlation(n, time, time + 0.1, (float3){0, 0, 0}) < 0.75);
        assert_true(correlation(n, time, time + 0.1, (float3){-0.4f, 0, 0.2f}) < 0.3);
    }
}

static void contrast_stays_that_of_the_noise(void **state) {
    (void)state;
    static const char *const phases[] = {"2", "3"};
    field *still = row("perlin", SET("octaves", number(2)), SET("seed", number(3)));
    for (int which = 0; which < 2; which++) {
        field *n = carried("perlin", (float3){1, 2, 3}, phases[which]);
        for (double time = 0; time < 1; time += 0.11) {
            uint32_t seed = 2;
            double sums[2] = {0}, squares[2] = {0};
            for (int i = 0; i < 8000; i++) {
                float3 p = random_point(&seed, 500);
                double v[2] = {(double)value_at(n, time, p), (double)value_at(still, time, p)};
                for (int k = 0; k < 2; k++) {
                    sums[k] += v[k] / 8000;
                    squares[k] += (v[k] - 0.5) * (v[k] - 0.5);
                }
            }
            assert_true(fabs(sums[0] - sums[1]) < 0.01);
            assert_true(fabs(squares[0] / squares[1] - 1) < 0.07);
        }
    }
}

static void nothing_jumps_when_a_pattern_is_replaced(void **state) {
    (void)state;
    static const char *const phases[] = {"2", "3"};
    for (int which = 0; which < 2; which++) {
        field *n = carried("worley", (float3){1, 2, 3}, phases[which]);
        for (int turn = 1; turn < 13; turn++) {
            uint32_t seed = 4;
            double at = turn / (double)(which + 2); // a pattern ends here
            for (int i = 0; i < 300; i++) {
                float3 p = random_point(&seed, 50);
                float a = value_at(n, at - 1e-4, p), b = value_at(n, at + 1e-4, p);
                assert_true(fabsf(a - b) < 0.01f);
            }
        }
    }
}

static void replaced_patterns_are_other_ones(void **state) {
    (void)state;
    field *n = carried("perlin", (float3){0, 0, 0}, "2");
    assert_true(correlation(n, 0.5, 1.5, (float3){0, 0, 0}) < 0.1);
    assert_true(correlation(n, 0.5, 1.0, (float3){0, 0, 0}) < 0.1); // and phases differ
}

static void curved_paths_follow_a_vortex(void **state) {
    (void)state;
    field *p = make("position", NULL);
    field *x = need_field(field_swizzle(build_memory(), p, "x"));
    field *y = need_field(field_swizzle(build_memory(), p, "y"));
    field *spin = make("vec", make("negate", y), x, NULL); // a radian a second
    double worst[2] = {0};
    for (int curved = 0; curved < 2; curved++) {
        field *a = row("advect", SET("value", x), SET("velocity", spin), SET("mean", number(0)),
                       WORD("path", curved ? "curved" : "straight"));
        for (double time = 0; time < 1; time += 0.05) {
            double want = 0;
            for (int k = 0; k < 2; k++) want += weight(time, 1, k, 2) * cos(age(time, 1, k, 2));
            double got = (double)value_at(a, time, (float3){1, 0, 0});
            worst[curved] = fmax(worst[curved], fabs(got - want));
        }
    }
    assert_true(worst[0] > 0.03 && worst[1] < 0.2 * worst[0]);
}

static void noise_anywhere_in_the_value_gets_other_seeds(void **state) {
    (void)state;
    field *cells = row("worley", SET("octaves", number(2)));
    field *bent = make("warp", cells, row("curl", SET("octaves", number(1))), number(0.3f));
    field *value = make("mul", make("add", bent, cells), number(0.5f));
    field *n = make("advect", value, vector(0, 0, 0));
    assert_true(correlation(n, 0.5, 1.5, (float3){0, 0, 0}) < 0.1);
    field *flow = row("advect", SET("value", row("curl", SET("octaves", number(1)))),
                      SET("velocity", vector(0, 0, 1)), SET("mean", number(0)));
    assert_int_equal(flow->components, 3);
    assert_true(correlation(flow, 0.3, 0.4, (float3){0, 0, 0.1f}) > 0.85);
}

static void what_does_not_vary_in_space_stays_a_number(void **state) {
    (void)state;
    field *n = make("advect", number(0.5f), vector(0, 0, 1));
    assert_true(n->uniform && value_at(n, 3.3, (float3){1, 2, 3}) == 0.5f);
}

static void advected_noise_has_a_known_reach(void **state) {
    (void)state;
    field *n = carried("perlin", (float3){0, 0, 1}, "2");
    float most = field_longest(n, &(field_context){.time = 0.3});
    assert_true(most > 1 && most < 3);
}

static void too_large_values_are_refused(void **state) {
    (void)state;
    field *value = row("perlin", SET("octaves", number(1)));
    for (int i = 0; i < FIELD_MAX_ADVECTED; i++) value = make("add", value, number(1));
    assert_null(field_make(build_memory(), "advect",
                           (const field *const[FIELD_MAX_ARGS]){value, vector(0, 0, 1)}, NULL));
    assert_error("too many nodes");
    err_clear();
    field *nested = row("perlin", SET("octaves", number(1))), *last = nested;
    for (int i = 0; i < 12 && nested; i++) { // patterns of patterns: their number doubles each time
        last = nested;
        nested = field_make(build_memory(), "advect",
                            (const field *const[FIELD_MAX_ARGS]){last, vector(0, 0, 1)}, NULL);
    }
    assert_null(nested);
    err_clear();
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(patterns_are_blended_as_documented),
        cmocka_unit_test(patterns_move_with_the_flow),
        cmocka_unit_test(contrast_stays_that_of_the_noise),
        cmocka_unit_test(nothing_jumps_when_a_pattern_is_replaced),
        cmocka_unit_test(replaced_patterns_are_other_ones),
        cmocka_unit_test(curved_paths_follow_a_vortex),
        cmocka_unit_test(noise_anywhere_in_the_value_gets_other_seeds),
        cmocka_unit_test(what_does_not_vary_in_space_stays_a_number),
        cmocka_unit_test(advected_noise_has_a_known_reach),
        cmocka_unit_test(too_large_values_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
