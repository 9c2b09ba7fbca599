// Percentiles, and the signed-rank test against values of published tables.
#include "base/memory.h"
#include "base/statistics.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

static void is_near(double a, double b, double most) {
    if (!(fabs(a - b) <= most)) fail_msg("%.9g is not %.9g", a, b);
}

static void percentiles_are_of_the_nearest_rank(void **state) {
    (void)state;
    double odd[] = {5, 1, 9}, even[] = {4, 1, 3, 2}, hundred[100];
    stats_summary s = stats_summarise(odd, 3);
    assert_true(s.median == 5 && s.p5 == 1 && s.p95 == 9);
    assert_true(stats_summarise(even, 4).median == 2.5);
    for (int i = 0; i < 100; i++) hundred[i] = 100 - i;
    s = stats_summarise(hundred, 100);
    assert_true(s.median == 50.5 && s.p5 == 5 && s.p95 == 95);
    assert_true(stats_summarise(hundred, 0).median == 0);
}

static void signed_ranks_are_exact(void **state) {
    (void)state;
    const double all_up[] = {1, 2, 3, 4, 5, 6, 7, 8};
    is_near(stats_signed_rank(all_up, 8), 2.0 / 256, 1e-12);
    const double one_down[] = {-1, 2, 3, 4, 5, 6, 7, 8}; // the smallest: sums of 0 and 1
    is_near(stats_signed_rank(one_down, 8), 4.0 / 256, 1e-12);
    const double balanced[] = {1, -1, 2, -2};
    is_near(stats_signed_rank(balanced, 4), 1, 1e-12);
    // Wilcoxon 1945, table II: 10 pairs and a sum of 8 are the last at 5 %.
    const double sum_8[] = {1, 2, 3, 4, 5, 6, 7, -8, 9, 10},
                 sum_9[] = {1, 2, 3, 4, 5, 6, 7, 8, -9, 10};
    assert_true(stats_signed_rank(sum_8, 10) < 0.05 && stats_signed_rank(sum_9, 10) > 0.0488);
    const double zeros[] = {0, 0, 0};
    assert_true(stats_signed_rank(zeros, 3) == 1 && stats_signed_rank(zeros, 0) == 1);
}

// Of three equal magnitudes each has rank 2: half of all ways to give signs are as far to one side.
static void ties_take_mean_ranks(void **state) {
    (void)state;
    const double ties[] = {1, 1, -1}, same[] = {2, 2, 2, 2, 2, 2, 2, 2};
    is_near(stats_signed_rank(ties, 3), 1, 1e-12);
    is_near(stats_signed_rank(same, 8), 2.0 / 256, 1e-12);
}

// Every third is negative: a sum of 287, 1.653 standard deviations below the mean of 40 and 1.860
// of 41, for which the normal distribution says 0.0983 and 0.0630.
static void many_go_by_the_normal_distribution(void **state) {
    (void)state;
    double values[STATS_EXACT + 1];
    for (int i = 0; i <= STATS_EXACT; i++) values[i] = (i % 3 ? 1 : -1) * (i + 1);
    is_near(stats_signed_rank(values, STATS_EXACT), 0.0983, 0.003);
    is_near(stats_signed_rank(values, STATS_EXACT + 1), 0.0630, 0.0001);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(percentiles_are_of_the_nearest_rank),
        cmocka_unit_test(signed_ranks_are_exact),
        cmocka_unit_test(ties_take_mean_ranks),
        cmocka_unit_test(many_go_by_the_normal_distribution),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
