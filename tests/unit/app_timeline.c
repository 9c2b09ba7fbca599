// The time of the live window: how frames follow the clock, where they begin again, where they end.
#include "base_test.h"

#include "app/timeline.h"
#include "base/memory.h"
#include <math.h>

static timeline started(double fps, double first, double frames) {
    timeline t;
    timeline_init(&t, fps, first, frames);
    t.playing = true;
    return t;
}

static void keeps_time_on_an_uneven_clock(void **state) {
    (void)state;
    timeline t = started(24, 0, 1000);
    const double steps[] = {0.001, 0.3, 0.02, 0.04, 0.0001, 1.7, 0.041, 0.12};
    double passed = 0;
    for (size_t round = 0; round < 10; round++)
        for (size_t i = 0; i < COUNT_OF(steps); i++) {
            passed += steps[i];
            timeline_advance(&t, steps[i]);
            assert_true(t.frame == floor(passed * 24 + 1e-6));
        }
}

static void says_whether_the_frame_changed(void **state) {
    (void)state;
    timeline t = started(10, 0, 100);
    assert_false(timeline_advance(&t, 0.05));
    assert_true(timeline_advance(&t, 0.06));
    assert_true(t.frame == 1);
    t.playing = false;
    assert_false(timeline_advance(&t, 5));
    t.playing = true;
    assert_false(timeline_advance(&t, 0));
    assert_false(timeline_advance(&t, -1));
    assert_false(timeline_advance(&t, NAN));
    assert_false(timeline_advance(&t, INFINITY));
    assert_true(t.frame == 1);
}

static void every_frame_is_shown_when_asked_for(void **state) {
    (void)state;
    timeline t = started(24, 0, 100);
    t.every = true;
    for (int i = 1; i <= 50; i++) {
        assert_true(timeline_advance(&t, 2)); // a slow device
        assert_true(t.frame == i);
    }
    assert_false(timeline_advance(&t, 0.001)); // what was late is forgiven
}

static void begins_again_at_the_end_of_the_range(void **state) {
    (void)state;
    timeline t = started(1, 10, 20);
    timeline_set_loop(&t, 12, 15);
    timeline_seek(&t, 12);
    const double expected[] = {13, 14, 15, 12, 13, 14, 15, 12};
    for (size_t i = 0; i < COUNT_OF(expected); i++) {
        assert_true(timeline_advance(&t, 1));
        assert_true(t.frame == expected[i]);
    }
    timeline_seek(&t, 14);
    timeline_advance(&t, 4 * 100 + 3); // a hundred rounds later
    assert_true(t.frame == 13);
}

static void plays_into_a_range_from_outside(void **state) {
    (void)state;
    timeline t = started(1, 0, 100);
    timeline_set_loop(&t, 50, 60);
    timeline_seek(&t, 40);
    timeline_advance(&t, 5);
    assert_true(t.frame == 45);
    timeline_seek(&t, 80);
    timeline_advance(&t, 1);
    assert_true(t.frame >= 50 && t.frame <= 60);
}

static void plays_backwards(void **state) {
    (void)state;
    timeline t = started(2, 0, 10);
    t.speed = -0.5;
    timeline_seek(&t, 2);
    const double expected[] = {1, 0, 9, 8};
    for (size_t i = 0; i < COUNT_OF(expected); i++) {
        assert_true(timeline_advance(&t, 1));
        assert_true(t.frame == expected[i]);
    }
}

static void stops_at_the_end_and_starts_over(void **state) {
    (void)state;
    timeline t = started(1, 0, 5);
    t.loop = false;
    assert_true(timeline_advance(&t, 100));
    assert_true(t.frame == 4);
    assert_false(t.playing);
    t.playing = true;
    assert_true(timeline_advance(&t, 1));
    assert_true(t.frame == 0 && t.playing);
}

static void stops_on_the_last_frame(void **state) {
    (void)state;
    timeline t = started(1, 0, 3);
    t.loop = false;
    timeline_advance(&t, 1);
    assert_true(t.playing);
    timeline_advance(&t, 1);
    assert_true(t.frame == 2 && !t.playing);
    t.speed = -1;
    t.playing = true;
    timeline_advance(&t, 1);
    assert_true(t.frame == 1 && t.playing);
    timeline_advance(&t, 1);
    assert_true(t.frame == 0 && !t.playing);
}

static void smooth_shows_times_between_frames(void **state) {
    (void)state;
    timeline t = started(24, 0, 100);
    t.smooth = true;
    assert_true(timeline_advance(&t, 0.01));
    assert_true(fabs(t.frame - 0.24) < 1e-9);
    for (int i = 0; i < 1000; i++) {
        timeline_advance(&t, 0.037);
        assert_true(t.frame >= 0 && t.frame <= 99);
    }
    t.smooth = false;
    timeline_advance(&t, 1.0 / 24);
    assert_true(t.frame == round(t.frame));
}

static void a_range_of_one_frame_stands_still(void **state) {
    (void)state;
    for (int smooth = 0; smooth < 2; smooth++) {
        timeline t = started(24, 7, 1);
        t.smooth = smooth;
        timeline_advance(&t, 3);
        assert_true(t.frame == 7);
        t.speed = -1;
        timeline_advance(&t, 3);
        assert_true(t.frame == 7);
    }
}

static void seeking_and_stepping_stay_inside(void **state) {
    (void)state;
    timeline t = started(24, 5, 10);
    timeline_seek(&t, 1e9);
    assert_true(t.frame == 14);
    timeline_seek(&t, 7.4);
    assert_true(t.frame == 7);
    timeline_step(&t, -1);
    assert_true(t.frame == 6 && !t.playing);
    timeline_step(&t, -100);
    assert_true(t.frame == 5);
    assert_true(timeline_seconds(&t) == 0);
    timeline_seek(&t, 11);
    assert_true(fabs(timeline_seconds(&t) - 0.25) < 1e-12);
}

static void a_reload_keeps_what_fits(void **state) {
    (void)state;
    timeline t = started(24, 0, 100);
    timeline_seek(&t, 60);
    timeline_set_range(&t, 30, 0, 200);
    assert_true(t.frame == 60 && t.fps == 30);
    assert_true(t.from == 0 && t.to == 199); // all was played, all is played
    timeline_set_loop(&t, 80, 40);
    assert_true(t.from == 40 && t.to == 80);
    timeline_set_range(&t, 30, 0, 150);
    assert_true(t.from == 40 && t.to == 80);
    timeline_set_range(&t, 30, 0, 50);
    assert_true(t.from == 40 && t.to == 49 && t.frame == 49);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keeps_time_on_an_uneven_clock),
        cmocka_unit_test(says_whether_the_frame_changed),
        cmocka_unit_test(every_frame_is_shown_when_asked_for),
        cmocka_unit_test(begins_again_at_the_end_of_the_range),
        cmocka_unit_test(plays_into_a_range_from_outside),
        cmocka_unit_test(plays_backwards),
        cmocka_unit_test(stops_at_the_end_and_starts_over),
        cmocka_unit_test(stops_on_the_last_frame),
        cmocka_unit_test(smooth_shows_times_between_frames),
        cmocka_unit_test(a_range_of_one_frame_stands_still),
        cmocka_unit_test(seeking_and_stepping_stay_inside),
        cmocka_unit_test(a_reload_keeps_what_fits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
