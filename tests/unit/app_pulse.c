// How alive the window is, from the times of its pictures and of what hands do.
#include "base_test.h"

#include "app/pulse.h"
#include <math.h>

static void is_near(double a, double b) {
    if (!(fabs(a - b) < 1e-6)) fail_msg("%g, not %g", a, b);
}

static void an_answer_counts_from_the_first_input(void **state) {
    (void)state;
    pulse p = {0};
    pulse_show(&p, 1, false); // nobody asked
    assert_int_equal(pulse_summarise(&p).count, 0);
    pulse_ask(&p, 2);
    pulse_ask(&p, 2.5);
    pulse_show(&p, 3, false);
    pulse_show(&p, 9, false); // it was answered
    for (int i = 1; i <= 99; i++) {
        pulse_ask(&p, 10 * i);
        pulse_show(&p, 10 * i + 0.001 * i, false);
    }
    pulse_answers a = pulse_summarise(&p);
    assert_int_equal(a.count, 100);
    is_near(a.median, 50.5);
    is_near(a.p95, 95);
    is_near(a.longest, 1000);
}

static void the_last_answers_are_kept(void **state) {
    (void)state;
    pulse p = {0};
    for (int i = 1; i <= 3 * PULSE_ANSWERS; i++) {
        pulse_ask(&p, i);
        pulse_show(&p, i + (i <= PULSE_ANSWERS ? 0.5 : 0.1), false);
    }
    assert_int_equal(pulse_summarise(&p).count, PULSE_ANSWERS);
    is_near(pulse_summarise(&p).longest, 100);
}

static void the_rate_is_that_of_the_last_second(void **state) {
    (void)state;
    pulse p = {0};
    assert_true(pulse_rate(&p, 0) == 0);
    for (int i = 0; i < 100; i++) pulse_show(&p, 0.1 * i, i >= 50);
    is_near(pulse_rate(&p, 9.9), 10);
    assert_true(pulse_rate(&p, 20) == 0); // it sleeps
    assert_int_equal(p.busy_shown, 50);
    for (int i = 0; i < 4; i++) pulse_turn(&p, 0.5, i > 0);
    is_near(p.busy_seconds, 1.5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_answer_counts_from_the_first_input),
        cmocka_unit_test(the_last_answers_are_kept),
        cmocka_unit_test(the_rate_is_that_of_the_last_second),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
