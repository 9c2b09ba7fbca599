// Noise by its stated facts: range, mean, octaves, periods, divergence.
#include "field_build.h"

#include "field/noise.h"

enum { SAMPLES = 20000 };

static const char *const scalar_kinds[] = {"perlin", "simplex", "value", "worley"};

static void ranges_are_0_to_1(void **state) {
    (void)state;
    static const char *const fractals[] = {"fbm", "ridged", "billow"};
    for (size_t k = 0; k < COUNT_OF(scalar_kinds); k++)
        for (int four = 0; four < 2; four++)
            for (int f = 0; f < 3; f++) {
                field *n = row(scalar_kinds[k], SET("octaves", number(2)), SET("speed", number(1)),
                               WORD("dimensions", four ? "4" : "3"), WORD("fractal", fractals[f]));
                uint32_t seed = 1;
                float low = 1, high = 0;
                for (int i = 0; i < SAMPLES / 10; i++) {
                    float v = value_at(n, i * 0.01, random_point(&seed, 1000));
                    low = fminf(low, v);
                    high = fmaxf(high, v);
                }
                assert_true(low >= 0 && high <= 1);
                assert_true(high - low > 0.3f); // and they use it
            }
}

static void gradient_and_value_noise_have_mean_one_half(void **state) {
    (void)state;
    for (size_t k = 0; k < 3; k++)
        for (int four = 0; four < 2; four++) {
            field *n =
                row(scalar_kinds[k], SET("speed", number(1)), WORD("dimensions", four ? "4" : "3"));
            uint32_t seed = 2;
            double sum = 0;
            for (int i = 0; i < SAMPLES; i++)
                sum += (double)value_at(n, i * 0.01, random_point(&seed, 500));
            assert_true(fabs(sum / SAMPLES - 0.5) < 0.01);
        }
}

static void extremes_of_gradient_noise_come_near_1(void **state) {
    (void)state;
    for (size_t k = 0; k < 2; k++) {
        field *n = row(scalar_kinds[k], SET("octaves", number(1)));
        uint32_t seed = 3;
        float high = 0;
        for (int i = 0; i < 20 * SAMPLES; i++)
            high = fmaxf(high, value_at(n, 0, random_point(&seed, 100)));
        assert_true(high > 0.9f);
    }
}

// Perlin's noise is zero (here: one half) at lattice points, whatever the seed.
static void perlin_is_one_half_at_lattice_points(void **state) {
    (void)state;
    field *n = row("perlin", SET("octaves", number(4)), SET("seed", number(99)));
    for (int x = -3; x < 3; x++)
        for (int z = -3; z < 3; z++)
            assert_true(value_at(n, 0, (float3){(float)x, 7, (float)z}) == 0.5f);
}

// The paper's sum runs from 0 to o, one too many: three octaves are three.
static void octaves_are_exactly_as_many_as_asked_for(void **state) {
    (void)state;
    noise_desc desc = {.frequency = 1, .persistence = 0.5f, .lacunarity = 2, .amplitude = 1};
    uint32_t seed = 4;
    for (int i = 0; i < 100; i++) {
        float3 p = random_point(&seed, 20);
        // By hand: octave i at twice the frequency, half the weight.
        float sums[4], sum = 0, total = 0;
        for (int octave = 0; octave < 4; octave++) {
            noise_desc one = desc;
            one.octaves = (float)(octave + 1);
            sums[octave] = noise_eval(NOISE_PERLIN, &one, p);
        }
        // What octave k adds must be bounded by its weight and not be there before.
        for (int k = 0; k < 4; k++) {
            float weight = powf(0.5f, (float)k), before = sum;
            total += weight;
            sum = sums[k] * total;
            assert_true(sum - before >= -1e-5f && sum - before <= weight + 1e-5f);
        }
        desc.octaves = 3.4f; // rounded
        assert_true(noise_eval(NOISE_PERLIN, &desc, p) == sums[2]);
        desc.octaves = 100; // limited
        assert_true(isfinite(noise_eval(NOISE_PERLIN, &desc, p)));
    }
}

static void one_octave_has_the_frequency_asked_for(void **state) {
    (void)state;
    noise_desc desc = {
        .frequency = 8, .octaves = 1, .persistence = 0.5f, .lacunarity = 2, .amplitude = 1};
    noise_desc coarse = desc;
    coarse.frequency = 1;
    uint32_t seed = 5;
    for (int i = 0; i < 100; i++) {
        float3 p = random_point(&seed, 2), eight = {8 * p.x, 8 * p.y, 8 * p.z};
        assert_true(noise_eval(NOISE_VALUE, &desc, p) == noise_eval(NOISE_VALUE, &coarse, eight));
    }
}

static void periods_tile_in_every_direction_and_in_time(void **state) {
    (void)state;
    static const char *const kinds[] = {"perlin", "value", "worley"};
    for (size_t k = 0; k < COUNT_OF(kinds); k++)
        for (int paper = 0; paper < (k == 2 ? 2 : 1); paper++) {
            const named settings[] = {SET("period", number(4)),  SET("frequency", number(2)),
                                      SET("octaves", number(3)), SET("speed", number(8)),
                                      WORD("dimensions", "4"),   WORD("mode", "paper")};
            field *n = need_field(build_row(kinds[k], settings, paper ? 6 : 5));
            uint32_t seed = 6;
            for (int i = 0; i < 300; i++) { // multiples of 1/64: sums are exact
                float3 p = random_point(&seed, 3);
                p = (float3){floorf(p.x * 64) / 64, floorf(p.y * 64) / 64, floorf(p.z * 64) / 64};
                float v = value_at(n, 0.125, p);
                assert_true(v == value_at(n, 0.125, (float3){p.x + 2, p.y, p.z}));
                assert_true(v == value_at(n, 0.125, (float3){p.x, p.y - 4, p.z}));
                assert_true(v == value_at(n, 0.125, (float3){p.x, p.y, p.z + 6}));
                assert_true(v == value_at(n, 0.625, p)); // 4 cells at 8 a second
            }
        }
}

static void simplex_tiles_after_multiples_of_three(void **state) {
    (void)state;
    static const char *const dimensions[] = {"3", "4"};
    for (int four = 0; four < 2; four++) {
        field *n = row("simplex", SET("period", number(6.4f)), SET("frequency", number(2)),
                       SET("octaves", number(2)), SET("speed", number(four ? 8.0f : 0.0f)),
                       WORD("dimensions", dimensions[four]));
        uint32_t seed = 9;
        float most = 0, least = 1;
        for (int i = 0; i < 2000; i++) {
            float3 p = random_point(&seed, 3);
            float v = value_at(n, 0.125, p);
            const float moved[] = {value_at(n, 0.125, (float3){p.x + 3, p.y, p.z}),
                                   value_at(n, 0.125, (float3){p.x, p.y - 6, p.z}),
                                   value_at(n, 0.125, (float3){p.x, p.y, p.z + 9}),
                                   value_at(n, 0.875, p)}; // 6 cells at 8 a second
            for (int k = 0; k < 4; k++)                    // the sums of coordinates are rounded
                if (fabsf(v - moved[k]) > 1e-4f)
                    fail_msg("%g, moved %g", (double)v, (double)moved[k]);
            float half = value_at(n, 0.125, (float3){p.x + 1.5f, p.y, p.z});
            most = fmaxf(most, fabsf(v - half));
            least = fminf(least, v);
            float near = value_at(n, 0.125, (float3){p.x + 1e-4f, p.y, p.z});
            assert_true(fabsf(v - near) < 0.01f); // continuous across simplices
        }
        assert_true(most > 0.2f && least < 0.35f); // and it is not flat
    }
}

static void drift_moves_the_domain(void **state) {
    (void)state;
    field *still = row("perlin", SET("seed", number(1)));
    field *moving = row("perlin", SET("seed", number(1)), SET("drift", vector(0.5f, 0, -1)));
    assert_true(value_at(moving, 2, (float3){0.25f, 0.5f, 3}) ==
                value_at(still, 2, (float3){1.25f, 0.5f, 1}));
}

static void the_fourth_dimension_boils(void **state) {
    (void)state;
    field *n = row("simplex", SET("speed", number(1)), WORD("dimensions", "4"));
    float3 p = {0.3f, 0.4f, 0.5f};
    assert_true(value_at(n, 0.1, p) != value_at(n, 0.4, p));
    assert_true(fabsf(value_at(n, 0.1, p) - value_at(n, 0.1001, p)) < 0.01f); // continuously
}

static void w_is_a_place_in_the_fourth_dimension(void **state) {
    (void)state;
    static const char *const kinds[] = {"perlin", "simplex", "value", "worley", "curl"};
    for (size_t k = 0; k < COUNT_OF(kinds); k++) {
        field *moving = row(kinds[k], SET("speed", number(0.5f)), WORD("dimensions", "4"));
        field *placed = row(kinds[k], SET("w", number(1.25f)), WORD("dimensions", "4"));
        uint32_t seed = 13;
        float most = 0;
        for (int i = 0; i < 200; i++) {
            float3 p = random_point(&seed, 40);
            assert_true(value_at(placed, 0, p) == value_at(moving, 2.5, p));
            most = fmaxf(most, fabsf(value_at(placed, 0, p) - value_at(moving, 0, p)));
        }
        assert_true(most > 0.2f);
    }
}

static void noise_is_continuous_in_w(void **state) {
    (void)state;
    static const char *const kinds[] = {"perlin", "simplex", "value", "worley", "curl"};
    for (size_t k = 0; k < COUNT_OF(kinds); k++) {
        field *n = row(kinds[k], SET("octaves", number(1)), SET("speed", number(1)),
                       WORD("dimensions", "4"));
        float3 p = {0.37f, -2.21f, 5.13f};
        float most = 0, first = value_at(n, 0, p), away = 0;
        for (int i = 0; i < SAMPLES / 2; i++) { // through ten cells
            float a = value_at(n, i * 1e-3, p), b = value_at(n, (i + 1) * 1e-3, p);
            most = fmaxf(most, fabsf(a - b));
            away = fmaxf(away, fabsf(a - first));
        }
        assert_true(most < 0.02f && away > 0.1f);
    }
}

static void seeds_give_other_patterns(void **state) {
    (void)state;
    for (size_t k = 0; k < COUNT_OF(scalar_kinds); k++) {
        field *a = row(scalar_kinds[k], SET("seed", number(1))),
              *b = row(scalar_kinds[k], SET("seed", number(2)));
        uint32_t seed = 7;
        double product = 0, square = 0;
        for (int i = 0; i < SAMPLES / 4; i++) {
            float3 p = random_point(&seed, 300);
            double x = (double)value_at(a, 0, p) - 0.5, y = (double)value_at(b, 0, p) - 0.5;
            product += x * y;
            square += x * x;
        }
        if (k < 3)
            assert_true(fabs(product / square) < 0.05);
        else
            assert_true(product < 0.99 * square);
    }
}

static void noise_is_continuous(void **state) {
    (void)state;
    for (size_t k = 0; k < COUNT_OF(scalar_kinds); k++)
        for (int four = 0; four < 2; four++) {
            field *n = row(scalar_kinds[k], SET("octaves", number(1)),
                           WORD("dimensions", four ? "4" : "3"));
            for (int i = 0; i < SAMPLES; i++) { // along a line through many cells
                float t = (float)i * 0.001f;
                float a = value_at(n, 0, (float3){t, 0.37f * t, 5 - 0.2f * t});
                float b = value_at(
                    n, 0, (float3){t + 0.001f, 0.37f * (t + 0.001f), 5 - 0.2f * (t + 0.001f)});
                assert_true(fabsf(a - b) < 0.01f);
            }
        }
}

static void worley_is_high_near_feature_points(void **state) {
    (void)state;
    static const char *const distances[] = {"f1", "f2", "f2_f1"};
    field *kinds[3];
    for (int d = 0; d < 3; d++) kinds[d] = row("worley", WORD("distance", distances[d]));
    uint32_t seed = 8;
    for (int i = 0; i < SAMPLES / 4; i++) {
        float3 p = random_point(&seed, 100);
        float f1 = 1 - value_at(kinds[0], 0, p), f2 = 1 - value_at(kinds[1], 0, p);
        assert_true(f1 <= f2 + 1e-6f);
        assert_true(fabsf(value_at(kinds[2], 0, p) - (f2 - f1)) < 1e-5f);
    }
}

static void powers_bend_worleys_distance(void **state) {
    (void)state;
    field *one = row("worley", SET("power", number(1))),
          *soft = row("worley", SET("power", number(0.5f)));
    field *sharp = row("worley", SET("power", number(2.5f)));
    float3 p = {0.2f, 0.7f, 0.4f};
    float distance = 1 - value_at(one, 0, p);
    assert_true(fabsf(1 - value_at(soft, 0, p) - sqrtf(distance)) < 1e-5f);
    assert_true(fabsf(1 - value_at(sharp, 0, p) - powf(distance, 2.5f)) < 1e-5f);
}

// The paper's hash, written as it stands there.
static void the_papers_worley_is_the_papers(void **state) {
    (void)state;
    field *n = row("worley", WORD("mode", "paper"), SET("power", number(1.5f)));
    uint32_t seed = 9;
    for (int i = 0; i < 200; i++) {
        float3 p = random_point(&seed, 20);
        float nearest = 10;
        for (int k = 0; k < 27; k++) {
            float c[3] = {floorf(p.x) + (float)(k % 3 - 1), floorf(p.y) + (float)(k / 3 % 3 - 1),
                          floorf(p.z) + (float)(k / 9 - 1)};
            float a[3] = {c[0] * 0.1031f, c[1] * 0.1030f, c[2] * 0.0973f};
            for (int j = 0; j < 3; j++) a[j] -= floorf(a[j]);
            float dot = a[0] * (a[1] + 33.33f) + a[1] * (a[0] + 33.33f) + a[2] * (a[2] + 33.33f);
            for (int j = 0; j < 3; j++) a[j] += dot;
            float h[3] = {(a[0] + a[1]) * a[2], (a[0] + a[0]) * a[1], (a[1] + a[0]) * a[0]};
            float d[3];
            for (int j = 0; j < 3; j++) d[j] = c[j] + h[j] - floorf(h[j]);
            nearest =
                fminf(nearest, sqrtf((d[0] - p.x) * (d[0] - p.x) + (d[1] - p.y) * (d[1] - p.y) +
                                     (d[2] - p.z) * (d[2] - p.z)));
        }
        float want = 1 - powf(fminf(nearest, 1), 1.5f);
        assert_true(fabsf(value_at(n, 0, p) - want) < 1e-4f);
    }
}

// ---- curl -------------------------------------------------------------------------------------

static void vector_at(const field *node, double x, double y, double z, double out[3]) {
    float v[4];
    assert_true(
        field_eval(node, &(field_context){.time = 0.3}, (float3){(float)x, (float)y, (float)z}, v));
    for (int i = 0; i < 3; i++) out[i] = (double)v[i];
}

// Root mean squares of divergence and of the derivative's entries, by central differences.
static double relative_divergence(const field *node) {
    uint32_t seed = 10;
    double divergence = 0, size = 0;
    const double h = 1.0 / 256; // a power of two: the points are exact
    for (int i = 0; i < 2000; i++) {
        float3 q = random_point(&seed, 30);
        double p[3] = {floor((double)q.x * 1024) / 1024, floor((double)q.y * 1024) / 1024,
                       floor((double)q.z * 1024) / 1024};
        double trace = 0;
        for (int axis = 0; axis < 3; axis++) {
            double a[3] = {p[0], p[1], p[2]}, b[3] = {p[0], p[1], p[2]}, va[3], vb[3];
            a[axis] += h;
            b[axis] -= h;
            vector_at(node, a[0], a[1], a[2], va);
            vector_at(node, b[0], b[1], b[2], vb);
            trace += (va[axis] - vb[axis]) / (2 * h);
            for (int k = 0; k < 3; k++) size += pow((va[k] - vb[k]) / (2 * h), 2);
        }
        divergence += trace * trace;
    }
    return sqrt(divergence / size);
}

static void curl_has_no_divergence(void **state) {
    (void)state;
    assert_true(relative_divergence(row("curl", SET("frequency", number(1)))) < 0.005);
    assert_true(relative_divergence(row("curl", SET("octaves", number(3)),
                                        SET("frequency", number(0.3f)))) < 0.005);
    assert_true(relative_divergence(row("curl", WORD("dimensions", "4"), SET("speed", number(1)))) <
                0.005);
}

static void the_papers_curl_has(void **state) {
    (void)state;
    assert_true(relative_divergence(row("curl", WORD("mode", "paper"))) > 0.2);
}

static void the_papers_curl_is_differences_of_one_perlin(void **state) {
    (void)state;
    field *curl =
        row("curl", WORD("mode", "paper"), SET("amount", number(5)), SET("step", number(0.02f)));
    field *perlin = row("perlin", SET("octaves", number(1))); // 0.5 + 0.5 G
    uint32_t seed = 11;
    const double near = 5 * 2 * 20 * 0.02 * 0.02 * 0.02; // of two ends in the cell of their middle
    for (int i = 0; i < 200; i++) {
        float3 p = random_point(&seed, 20);
        double v[3];
        vector_at(curl, (double)p.x, (double)p.y, (double)p.z, v);
        float d = 0.02f;
        float x = value_at(perlin, 0, (float3){p.x, p.y + d, p.z + d}) -
                  value_at(perlin, 0, (float3){p.x, p.y - d, p.z - d});
        float y = value_at(perlin, 0, (float3){p.x + d, p.y, p.z + d}) -
                  value_at(perlin, 0, (float3){p.x - d, p.y, p.z - d});
        assert_true(fabs(v[0] - 10 * (double)x) < near);
        assert_true(fabs(v[1] - 10 * (double)y) < near);
    }
}

static void curl_stays_within_the_bound_that_warps_rely_on(void **state) {
    (void)state;
    for (int four = 0; four < 2; four++) {
        field *length = make("length", row("curl", WORD("dimensions", four ? "4" : "3")));
        uint32_t seed = 12;
        for (int i = 0; i < 4 * SAMPLES; i++)
            assert_true(value_at(length, 0, random_point(&seed, 1000)) < 6);
    }
}

static void odd_arguments_do_no_harm(void **state) {
    (void)state;
    const float odd[] = {0, -1, NAN, INFINITY, 1e30f};
    for (size_t i = 0; i < COUNT_OF(odd); i++) {
        noise_desc desc = {odd[i], odd[i],    odd[i],   odd[i],     odd[i],
                           1,      {odd[i]},  odd[i],   odd[i],     odd[i],
                           odd[i], NOISE_FBM, NOISE_F2, i % 2 == 0, true};
        float out[3];
        for (int b = 0; b < 4; b++) noise_eval((noise_base)b, &desc, (float3){odd[i], 1, 2});
        noise_curl(&desc, (float3){odd[i], 1, 2}, out);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranges_are_0_to_1),
        cmocka_unit_test(gradient_and_value_noise_have_mean_one_half),
        cmocka_unit_test(extremes_of_gradient_noise_come_near_1),
        cmocka_unit_test(perlin_is_one_half_at_lattice_points),
        cmocka_unit_test(octaves_are_exactly_as_many_as_asked_for),
        cmocka_unit_test(one_octave_has_the_frequency_asked_for),
        cmocka_unit_test(periods_tile_in_every_direction_and_in_time),
        cmocka_unit_test(simplex_tiles_after_multiples_of_three),
        cmocka_unit_test(drift_moves_the_domain),
        cmocka_unit_test(the_fourth_dimension_boils),
        cmocka_unit_test(w_is_a_place_in_the_fourth_dimension),
        cmocka_unit_test(noise_is_continuous_in_w),
        cmocka_unit_test(seeds_give_other_patterns),
        cmocka_unit_test(noise_is_continuous),
        cmocka_unit_test(worley_is_high_near_feature_points),
        cmocka_unit_test(powers_bend_worleys_distance),
        cmocka_unit_test(the_papers_worley_is_the_papers),
        cmocka_unit_test(curl_has_no_divergence),
        cmocka_unit_test(the_papers_curl_has),
        cmocka_unit_test(the_papers_curl_is_differences_of_one_perlin),
        cmocka_unit_test(curl_stays_within_the_bound_that_warps_rely_on),
        cmocka_unit_test(odd_arguments_do_no_harm),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    arena_free(build_memory());
    return failed;
}
