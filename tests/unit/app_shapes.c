// Edits of palettes and curves: order is kept, the least number stays.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "app/curve_keys.h"
#include "app/palette_stops.h"
#include "base/memory.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static void expect_near(float got, double want) {
    if (!(fabs((double)got - want) < 1e-4)) fail_msg("%g, not %g", (double)got, want);
}

static roil_palette ramp(void) {
    roil_palette p = {.count = 3, .min = 0, .max = 10};
    for (size_t i = 0; i < 3; i++) p.stops[i] = (roil_stop){5 * (float)i, {(float)i, 0, 0, 1}};
    return p;
}

static void a_stop_is_added_in_its_place(void **state) {
    (void)state;
    roil_palette p = ramp();
    assert_int_equal(palette_stops_add(&p, 7, (float[4]){1, 2, 3, 0.5f}), 2);
    assert_int_equal(p.count, 4);
    expect_near(p.stops[2].at, 7);
    expect_near(p.stops[2].color[3], 0.5);
    expect_near(p.stops[3].at, 10);
    assert_int_equal(palette_stops_add(&p, -1, (float[4]){0}), 0);
    assert_int_equal(palette_stops_add(&p, 99, (float[4]){0}), 5);
}

static void a_full_palette_takes_no_stop(void **state) {
    (void)state;
    roil_palette p = ramp();
    while (p.count < ROIL_MAX_STOPS) palette_stops_add(&p, 3, (float[4]){0});
    roil_palette before = p;
    assert_int_equal(palette_stops_add(&p, 3, (float[4]){1}), ROIL_MAX_STOPS);
    assert_memory_equal(&p, &before, sizeof p);
}

static void two_stops_stay(void **state) {
    (void)state;
    roil_palette p = ramp();
    assert_true(palette_stops_remove(&p, 1));
    assert_int_equal(p.count, 2);
    expect_near(p.stops[1].at, 10);
    assert_false(palette_stops_remove(&p, 0));
    assert_int_equal(p.count, 2);
}

static void a_stop_moves_no_farther_than_its_neighbours(void **state) {
    (void)state;
    roil_palette p = ramp();
    palette_stops_move(&p, 1, 8);
    expect_near(p.stops[1].at, 8);
    palette_stops_move(&p, 1, 80);
    expect_near(p.stops[1].at, 10);
    palette_stops_move(&p, 1, -80);
    expect_near(p.stops[1].at, 0);
    palette_stops_move(&p, 2, 80); // the last may go anywhere
    expect_near(p.stops[2].at, 80);
}

// What the stops give at each sample, against the samples.
static float greatest_difference(const roil_palette *p, const float (*samples)[4], size_t count) {
    float worst = 0;
    size_t k = 0;
    for (size_t i = 0; i < count; i++) {
        float at = p->min + (p->max - p->min) * (float)i / (float)(count - 1);
        while (k + 2 < p->count && p->stops[k + 1].at < at) k++;
        const roil_stop *a = &p->stops[k], *b = &p->stops[k + 1];
        float t = (at - a->at) / (b->at - a->at);
        float got = a->color[0] + (b->color[0] - a->color[0]) * t;
        worst = fmaxf(worst, fabsf(got - samples[i][0]));
    }
    return worst;
}

static void fitted_stops_follow_a_bend(void **state) {
    (void)state;
    enum { COUNT = 257 };
    float samples[COUNT][4] = {0};
    for (size_t i = 0; i < COUNT; i++) { // flat, then steep: a corner at 200
        samples[i][0] = i < 200 ? 0 : (float)(i - 200) * 0.1f;
        samples[i][3] = 1;
    }
    roil_palette p = {.min = 500, .max = 4500};
    palette_stops_fit(&p, (const float(*)[4])samples, COUNT, 8);
    assert_true(p.count >= 3 && p.count <= 8);
    expect_near(p.stops[0].at, 500);
    expect_near(p.stops[p.count - 1].at, 4500);
    for (size_t i = 1; i < p.count; i++) assert_true(p.stops[i].at > p.stops[i - 1].at);
    assert_true(greatest_difference(&p, (const float(*)[4])samples, COUNT) < 0.01f);
}

// ---- curves -----------------------------------------------------------------------------------

static roil_curve line(void) {
    return (roil_curve){
        .count = 3, .components = 1, .shape = "linear", .keys = {{0, {0}}, {1, {5}}, {2, {10}}}};
}

static void a_key_is_added_in_its_place(void **state) {
    (void)state;
    roil_curve c = line();
    assert_int_equal(curve_keys_add(&c, 1.5f, (float[4]){7}), 2);
    assert_int_equal(c.count, 4);
    expect_near(c.keys[2].value[0], 7);
    expect_near(c.keys[3].time, 2);
    assert_int_equal(curve_keys_add(&c, -1, (float[4]){0}), 0);
}

static void two_keys_at_one_time_are_refused(void **state) {
    (void)state;
    roil_curve c = line(), before = c;
    assert_int_equal(curve_keys_add(&c, 1, (float[4]){7}), ROIL_MAX_STOPS);
    assert_memory_equal(&c, &before, sizeof c);
}

static void one_key_stays(void **state) {
    (void)state;
    roil_curve c = line();
    assert_true(curve_keys_remove(&c, 0));
    expect_near(c.keys[0].time, 1);
    assert_true(curve_keys_remove(&c, 1));
    assert_false(curve_keys_remove(&c, 0));
    assert_int_equal(c.count, 1);
}

static void a_key_stops_short_of_its_neighbours(void **state) {
    (void)state;
    roil_curve c = line();
    curve_keys_move(&c, 1, 50);
    assert_true(c.keys[1].time < 2 && c.keys[1].time > 1.99f);
    curve_keys_move(&c, 1, -50);
    assert_true(c.keys[1].time > 0 && c.keys[1].time < 0.01f);
    curve_keys_move(&c, 2, 50);
    expect_near(c.keys[2].time, 50);
    roil_curve tight = line();
    tight.keys[0].time = 0.9999f; // no room on either side: it stays
    tight.keys[2].time = 1.0001f;
    curve_keys_move(&tight, 1, 3);
    expect_near(tight.keys[1].time, 1);
}

static void plots_have_a_margin(void **state) {
    (void)state;
    plot_range r = plot_range_of((float[]){2, 0, 1}, 3);
    assert_true(r.low < 0 && r.low > -1 && r.high > 2 && r.high < 3);
    r = plot_range_of((float[]){5, 5}, 2);
    assert_true(r.low < 4.5f && r.high > 5.5f && r.high < 50);
    r = plot_range_of((float[]){0}, 1);
    assert_true(r.low < 0 && r.high > 0);
    r = plot_range_of(NULL, 0);
    assert_true(r.low < r.high);
}

static void grids_step_by_round_numbers(void **state) {
    (void)state;
    expect_near(plot_step((plot_range){0, 10}, 5), 2);
    expect_near(plot_step((plot_range){0, 4.2f}, 5), 1);
    expect_near(plot_step((plot_range){-1, 1}, 4), 0.5);
    expect_near(plot_step((plot_range){0, 900}, 4), 500);
    expect_near(plot_step((plot_range){0, 0.07f}, 7), 0.01);
}

static void dragged_values_are_round(void **state) {
    (void)state;
    char text[32];
    snprintf(text, sizeof text, "%.6g", (double)plot_round((plot_range){0, 1}, 0.54394f));
    assert_string_equal(text, "0.544");
    snprintf(text, sizeof text, "%.9g", (double)plot_round((plot_range){500, 4500}, 1234.567f));
    assert_string_equal(text, "1230");
    expect_near(plot_round((plot_range){0, 0.9996f}, 0.9999f), 0.9996); // no farther than the end
    expect_near(plot_round((plot_range){2, 2}, 2), 2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stop_is_added_in_its_place),
        cmocka_unit_test(a_full_palette_takes_no_stop),
        cmocka_unit_test(two_stops_stay),
        cmocka_unit_test(a_stop_moves_no_farther_than_its_neighbours),
        cmocka_unit_test(fitted_stops_follow_a_bend),
        cmocka_unit_test(a_key_is_added_in_its_place),
        cmocka_unit_test(two_keys_at_one_time_are_refused),
        cmocka_unit_test(one_key_stays),
        cmocka_unit_test(a_key_stops_short_of_its_neighbours),
        cmocka_unit_test(plots_have_a_margin),
        cmocka_unit_test(grids_step_by_round_numbers),
        cmocka_unit_test(dragged_values_are_round),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
