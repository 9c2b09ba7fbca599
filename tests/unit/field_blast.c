// Bursts on the host: against Kingery and Bulmash, and against what shocks are bound by.
#include "field_build.h"

#include "base/maths.h"
#include <math.h>

static const double ambient = 101325, sound = 340.3;

// On the axis of x, `away` metres from a burst at {1, 2, 3}.
static void burst(const char *kind, double charge, double age, double away, float out[4]) {
    field *node = row(kind, SET("position", vector(1, 2, 3)), SET("charge", number((float)charge)));
    if (strcmp(kind, "blast_arrival") != 0 && strcmp(kind, "blast_impulse") != 0)
        node = row(kind, SET("position", vector(1, 2, 3)), SET("charge", number((float)charge)),
                   SET("age", number((float)age)));
    const field_context context = {.time = 0};
    if (!field_eval(node, &context, (float3){1 + (float)away, 2, 3}, out))
        fail_msg("%s", err_get());
}

static double arrival(double charge, double away) {
    float out[4];
    burst("blast_arrival", charge, 0, away, out);
    return (double)out[0];
}

static double pressure(double charge, double age, double away) {
    float out[4];
    burst("blast_pressure", charge, age, away, out);
    return (double)out[0];
}

static double velocity(double charge, double age, double away) {
    float out[4];
    burst("blast_velocity", charge, age, away, out);
    assert_true(out[1] == 0 && out[2] == 0);
    return (double)out[0];
}

static double peak(double charge, double away) {
    return pressure(charge, arrival(charge, away) * (1 + 1e-6), away);
}

// Kingery and Bulmash, "Airblast parameters from TNT spherical air burst and hemispherical surface
// burst" (1984), the spherical burst: distance for 1 kg (m), overpressure (kPa), arrival (ms).
static void fronts_are_as_measured(void **state) {
    (void)state;
    static const double rows[][3] = {
        {0.2, 15298, 0.0385}, {0.5, 3884.8, 0.1541}, {1, 934.9, 0.5318}, {2, 194.7, 1.9440},
        {5, 31.3, 8.9953},    {10, 11.1, 22.7224},   {20, 4.5, 50.9677},
    };
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        const double p = peak(1, rows[i][0]) / 1000 / rows[i][1];
        const double t = arrival(1, rows[i][0]) * 1000 / rows[i][2];
        print_message("%4g m: pressure %.3f, arrival %.3f of Kingery's and Bulmash's\n", rows[i][0],
                      p, t);
        assert_true(fabs(p - 1) < 0.12 && fabs(t - 1) < 0.12);
    }
    // 10 t on the ground, 500 m away (Swisdak, "Simplified Kingery airblast calculations", 1994).
    const double p = peak(18000, 500) / 5055, t = arrival(18000, 500) / 1.27617;
    print_message("on the ground: %.3f, %.3f of Swisdak's\n", p, t);
    assert_true(fabs(p - 1) < 0.12 && fabs(t - 1) < 0.003);
}

// Momentum through a front: overpressure = density * speed of the front * speed behind it.
static void fronts_keep_momentum(void **state) {
    (void)state;
    static const double places[] = {0.1, 0.3, 1, 3, 10, 30};
    const double density = 1.4 * ambient / (sound * sound);
    for (size_t i = 0; i < COUNT_OF(places); i++) {
        const double r = places[i], d = 0.02 * r;
        const double front = 2 * d / (arrival(1, r + d) - arrival(1, r - d));
        const double behind = velocity(1, arrival(1, r) * (1 + 1e-6), r);
        const double share = peak(1, r) / (density * front * behind);
        print_message("%4g m: front %.0f m/s, behind it %.1f m/s, momentum %.4f\n", r, front,
                      behind, share);
        assert_true(fabs(share - 1) < 0.0012);
    }
}

// The impulse is Kinney's and Graham's; then comes suction, at most 1 / e^2 of the peak.
static void pulses_have_their_impulse(void **state) {
    (void)state;
    static const double rows[][2] = {{0.3, 146.6}, {1, 117.2}, {3, 62.7}, {10, 19.6}}; // m, Pa s
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        const double r = rows[i][0], begin = arrival(1, r), step = rows[i][1] / peak(1, r) / 400;
        double sum = 0, least = 0;
        assert_true(pressure(1, begin * 0.999, r) == 0 && velocity(1, begin * 0.999, r) == 0);
        for (int k = 0; k < 4000; k++) {
            const double p = pressure(1, begin + (k + 0.5) * step, r);
            if (p > 0) sum += p * step;
            least = fmin(least, p);
        }
        float impulse[4];
        burst("blast_impulse", 27, 0, 3 * r, impulse);
        assert_true(fabs((double)impulse[0] / rows[i][1] / 3 - 1) < 0.0012);
        print_message("%4g m: impulse %.4f, suction %.4f\n", r, sum / rows[i][1],
                      -least / peak(1, r));
        assert_true(fabs(sum / rows[i][1] - 1) < 0.0012);
        assert_true(fabs(-least / peak(1, r) - exp(-2)) < 0.0003);
    }
}

// Eight times the charge does at twice the distance after twice the time the same.
static void charges_scale_by_their_root(void **state) {
    (void)state;
    for (double r = 0.5; r < 20; r *= 3) {
        const double age = arrival(1, r) * 1.1;
        assert_true(fabs(arrival(8, 2 * r) / arrival(1, r) / 2 - 1) < 1e-5);
        assert_true(fabs(pressure(8, 2 * age, 2 * r) / pressure(1, age, r) - 1) < 1e-3);
        assert_true(fabs(velocity(8, 2 * age, 2 * r) / velocity(1, age, r) - 1) < 1e-3);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(fronts_are_as_measured),
        cmocka_unit_test(fronts_keep_momentum),
        cmocka_unit_test(pulses_have_their_impulse),
        cmocka_unit_test(charges_scale_by_their_root),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    arena_free(build_memory());
    return failed;
}
