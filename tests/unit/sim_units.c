// What metres and seconds become on a lattice, against numbers worked out by hand; and advice that
// names the parameter to change, and is silent once it was followed.
#include "sim/units.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void is_near(double a, double b) {
    if (!(fabs(a - b) <= 1e-9 * fabs(b))) fail_msg("%.12g is not %.12g", a, b);
}

static void a_step_follows_from_the_speed(void **state) {
    (void)state;
    sim_units u = sim_units_make(0.05, 4, 0);
    is_near(u.step, 0.00125);
    is_near(sim_velocity(&u, 4), SIM_SPEED);
    is_near(sim_acceleration(&u, 9.81), 9.81 * 0.00125 * 0.00125 / 0.05);
    is_near(sim_units_make(0.05, 4, 0.002).step, 0.002); // it goes before the speed
}

static void viscosity_and_rates_become_numbers_of_a_step(void **state) {
    (void)state;
    sim_units u = sim_units_make(0.1, 1, 0.01);
    is_near(sim_tau(&u, 0.1, 1.0 / 3), 0.8); // a lattice viscosity of 0.1
    is_near(sim_tau(&u, 0.1, 1.0 / 4), 0.9);
    is_near(sim_tau(&u, 0, 1.0 / 3), 0.5);
    double left = pow(1 - sim_decay(&u, 2), 50); // half a second of steps
    is_near(left, exp(-1));
    assert_true(sim_decay(&u, 0) == 0);
}

static void readouts_are_those_of_the_textbook(void **state) {
    (void)state;
    sim_units u = sim_units_make(0.05, 4, 0);
    sim_flow flow = {.viscosity = 2e-5, .speed = 4, .length = 3.2, .collision = SIM_BGK};
    sim_readout r = sim_judge(&u, &flow);
    is_near(r.tau, 0.5 + 3 * 1e-5);
    is_near(r.mach, 0.1 * sqrt(3));
    is_near(r.reynolds, 640000);
    flow.viscosity = 0;
    assert_true(isinf(sim_judge(&u, &flow).reynolds));
}

static bool advice(const sim_units *u, const sim_flow *flow, char out[512]) {
    out[0] = '\0';
    return sim_advise(u, flow, out, 512);
}

static void names(const char *text, const char *part) {
    if (!strstr(text, part)) fail_msg("'%s' is not in: %s", part, text);
}

static void air_that_is_too_fast_is_noticed(void **state) {
    (void)state;
    char text[512], again[512];
    sim_units u = sim_units_make(0.05, 4, 0.0025);
    sim_flow flow = {.viscosity = 1e-3, .speed = 4, .length = 3, .collision = SIM_CENTRAL_MOMENTS};
    assert_true(advice(&u, &flow, text)); // 0.2 cells a step are Mach 0.35
    names(text, "Mach 0.35");
    names(text, "'time_step' below 0.00217 s");
    u = sim_units_make(0.05, 4, 0.00216);
    assert_false(advice(&u, &flow, again));
    assert_true(sim_advise_speed(&u, &flow, 9, text, sizeof text)); // measured
    names(text, "'speed' to 9 m/s");
    flow.fixed = true;
    assert_true(sim_advise_speed(&u, &flow, 9, text, sizeof text));
    names(text, "set 'time_step' below 0.000962 s");
    assert_null(strstr(text, "'speed'")); // which would change nothing
    u = sim_units_make(0.05, 4, 0.01);
    assert_true(advice(&u, &flow, text)); // by what is expected, not seen
    names(text, "or 'speed' to less");
    u = sim_units_make(0.05, 9, 0);
    assert_false(sim_advise_speed(&u, &flow, 9, text, sizeof text));
}

static void a_tau_that_an_operator_cannot_take_is_noticed(void **state) {
    (void)state;
    char text[512];
    sim_units u = sim_units_make(0.05, 4, 0);
    sim_flow flow = {.viscosity = 2e-5, .speed = 4, .length = 3, .collision = SIM_BGK};
    assert_true(advice(&u, &flow, text));
    names(text, "collision = \"bgk\"");
    names(text, "'viscosity' above 0.0067");
    names(text, "'smagorinsky'");
    flow.viscosity = 0.0067;
    assert_false(advice(&u, &flow, text));
    flow = (sim_flow){.viscosity = 0, .speed = 4, .length = 3, .collision = SIM_CENTRAL_MOMENTS};
    assert_true(advice(&u, &flow, text));
    names(text, "or 'smagorinsky' to 0.1");
    assert_null(strstr(text, "'collision'"));
    flow.subgrid = true;
    assert_false(advice(&u, &flow, text));
    flow.viscosity = 2; // tau is 3.5
    assert_true(advice(&u, &flow, text));
    names(text, "'time_step' below");
    u.step *= (SIM_TAU_MAX - 0.5) / (3.5 - 0.5);
    assert_false(advice(&u, &flow, text));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_follows_from_the_speed),
        cmocka_unit_test(viscosity_and_rates_become_numbers_of_a_step),
        cmocka_unit_test(readouts_are_those_of_the_textbook),
        cmocka_unit_test(air_that_is_too_fast_is_noticed),
        cmocka_unit_test(a_tau_that_an_operator_cannot_take_is_noticed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
