// The ring of times: medians, passes that come and go, and what happens when it is full.
#include "app/history.h"
#include "base/memory.h"
#include "unit/base_test.h"
#include <math.h>
#include <string.h>

static int create(void **state) {
    *state = mem_alloc(sizeof(history));
    return 0;
}

static int destroy(void **state) {
    mem_free(*state);
    return 0;
}

static roil_time time_of(const char *pass, double ms) {
    roil_time t = {.milliseconds = ms};
    snprintf(t.pass, sizeof t.pass, "%s", pass);
    return t;
}

static void add(history *h, const char *pass, double ms) {
    const roil_time t = time_of(pass, ms);
    history_add(h, &t, 1, 0.002, 0.020);
}

static size_t find(const history *h, size_t ago, const char *name) {
    size_t list[HISTORY_PASSES], count = history_list(h, ago, list);
    for (size_t i = 0; i < count; i++)
        if (strcmp(h->passes[list[i]].name, name) == 0) return list[i];
    return HISTORY_PASSES;
}

static void an_empty_one_has_nothing(void **state) {
    const history *h = *state;
    assert_int_equal(history_length(h), 0);
    assert_true(history_rate(h) == 0);
    assert_true(history_peak(h) == 0);
    assert_true(history_median(h).gpu == 0);
}

static void passes_are_listed_in_order_of_work(void **state) {
    history *h = *state;
    const roil_time first[] = {time_of("march", 3), time_of("final", 1)};
    const roil_time then[] = {time_of("bake", 2), time_of("march", 5), time_of("final", 1)};
    history_add(h, first, 2, 0.001, 0.010);
    history_add(h, then, 3, 0.001, 0.010);
    size_t list[HISTORY_PASSES];
    assert_int_equal(history_list(h, 0, list), 3);
    assert_string_equal(h->passes[list[0]].name, "bake");
    assert_string_equal(h->passes[list[1]].name, "march");
    assert_string_equal(h->passes[list[2]].name, "final");
    assert_int_equal(history_list(h, 1, list), 2);
    assert_true(history_pass_ms(h, list[0], 1) == 3);
    assert_true(history_get(h, 0)->gpu == 8 && history_get(h, 1)->gpu == 4);
    assert_true(history_peak(h) == 8);
}

static void what_runs_twice_is_summed(void **state) {
    history *h = *state;
    const roil_time times[] = {time_of("blur", 1), time_of("mix", 4), time_of("blur", 2)};
    history_add(h, times, 3, 0, 0.010);
    size_t list[HISTORY_PASSES];
    assert_int_equal(history_list(h, 0, list), 2);
    assert_string_equal(h->passes[list[0]].name, "blur");
    assert_true(history_pass_ms(h, list[0], 0) == 3);
}

static void medians_look_at_the_newest_only(void **state) {
    history *h = *state;
    for (int i = 0; i < 100; i++) add(h, "march", 90);
    for (int i = 0; i < HISTORY_RECENT; i++) add(h, "march", i % 2 ? 4 : 6);
    size_t march = find(h, 0, "march");
    assert_true(history_pass_median(h, march) == 5);
    assert_true(history_median(h).gpu == 5);
    assert_true(fabsf(history_median(h).cpu - 2) < 1e-4f);
    assert_true(fabs(history_rate(h) - 50) < 1e-3);
    assert_true(history_peak(h) == 90);
}

static void a_median_is_of_the_frames_that_have_the_pass(void **state) {
    history *h = *state;
    add(h, "old", 7);
    for (int i = 0; i < 9; i++) add(h, "new", 2);
    size_t list[HISTORY_PASSES];
    assert_int_equal(history_list(h, 0, list), 1);
    size_t old = find(h, 9, "old");
    assert_true(history_pass_median(h, old) == 7);
    assert_true(history_pass_ms(h, old, 0) < 0);
}

static void the_ring_forgets(void **state) {
    history *h = *state;
    add(h, "old", 50);
    for (int i = 0; i < HISTORY_FRAMES - 1; i++) add(h, "new", 1);
    assert_int_equal(history_length(h), HISTORY_FRAMES);
    assert_true(history_peak(h) == 50);
    add(h, "new", 1);
    assert_int_equal(history_length(h), HISTORY_FRAMES);
    assert_true(history_peak(h) == 1);
    assert_int_equal(find(h, HISTORY_FRAMES - 1, "old"), HISTORY_PASSES);
}

static void a_pass_that_comes_back_has_its_place(void **state) {
    history *h = *state;
    add(h, "march", 1);
    size_t place = find(h, 0, "march");
    add(h, "other", 1);
    add(h, "march", 2);
    assert_int_equal(find(h, 0, "march"), place);
    assert_true(history_pass_ms(h, place, 2) == 1);
}

// More names than places: the longest away gives way, with all that was kept of it.
static void places_are_used_again(void **state) {
    history *h = *state;
    char name[32];
    for (int i = 0; i <= HISTORY_PASSES; i++) {
        snprintf(name, sizeof name, "pass %d", i);
        add(h, name, 10 + i);
    }
    size_t newest = find(h, 0, name);
    assert_true(newest < HISTORY_PASSES);
    assert_true(history_pass_ms(h, newest, 0) == 10 + HISTORY_PASSES);
    for (size_t ago = 1; ago < HISTORY_FRAMES; ago++)
        assert_true(history_pass_ms(h, newest, ago) < 0);
    assert_true(find(h, 1, "pass 255") < HISTORY_PASSES);
}

static void more_passes_than_places_are_cut(void **state) {
    history *h = *state;
    static roil_time times[HISTORY_PASSES + 5];
    char name[32];
    for (int i = 0; i < HISTORY_PASSES + 5; i++) {
        snprintf(name, sizeof name, "pass %d", i);
        times[i] = time_of(name, 1);
    }
    history_add(h, times, HISTORY_PASSES + 5, 0, 0);
    size_t list[HISTORY_PASSES];
    assert_int_equal(history_list(h, 0, list), HISTORY_PASSES);
    assert_true(history_get(h, 0)->gpu == HISTORY_PASSES);
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, create, destroy)
int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(an_empty_one_has_nothing),
        TEST(passes_are_listed_in_order_of_work),
        TEST(what_runs_twice_is_summed),
        TEST(medians_look_at_the_newest_only),
        TEST(a_median_is_of_the_frames_that_have_the_pass),
        TEST(the_ring_forgets),
        TEST(a_pass_that_comes_back_has_its_place),
        TEST(places_are_used_again),
        TEST(more_passes_than_places_are_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
