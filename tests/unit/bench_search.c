// The search for the best settings, over made-up costs and errors whose best is known by trying
// all.
#include "base_test.h"

#include "base/memory.h"
#include "bench/search.h"
#include <math.h>
#include <string.h>

// Two passes, one of which two axes multiply; errors that add up, and more so where two are bad.
typedef struct model {
    size_t axis_count, counts[4];
    double cost[4][SEARCH_MAX_RUNGS], error[4][SEARCH_MAX_RUNGS];
    double noise;       // of costs
    size_t asked, most; // most > 0: after so many points it stops
    size_t failing[4];  // a point that cannot be measured, if `fails`
    bool fails;
} model;

static void evaluate(const model *m, search_point *p) {
    double product = 1, rest = 0, sum = 0, together = 1;
    for (size_t i = 0; i < m->axis_count; i++) {
        double c = m->cost[i][p->rungs[i]], e = m->error[i][p->rungs[i]];
        if (i < 2)
            product *= c;
        else
            rest += c;
        sum += e;
        together *= e;
    }
    p->cost = 0.5 + product + rest;
    p->error = sum + together;
}

static bool measure(void *user, search_point *p) {
    model *m = user;
    if (m->most && m->asked == m->most) return false;
    m->asked++;
    evaluate(m, p);
    if (m->fails && memcmp(p->rungs, m->failing, m->axis_count * sizeof *m->failing) == 0)
        p->cost = p->error = INFINITY;
    p->cost *= 1 + m->noise * (m->asked % 2 ? 1 : -1);
    return true;
}

static double random_number(uint64_t *state) { // 0 to 1
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*state >> 40) / (double)(1 << 24);
}

static model make(uint64_t seed) {
    uint64_t state = seed * 7919 + 1;
    model m = {.axis_count = 4};
    for (size_t i = 0; i < 4; i++) {
        m.counts[i] = 3 + (size_t)(random_number(&state) * 6);
        double cost = 0.2 + random_number(&state), error = 0.1 * random_number(&state);
        for (size_t k = 0; k < m.counts[i]; k++) {
            m.cost[i][k] = cost;
            m.error[i][k] = error;
            cost *= 1.2 + 0.6 * random_number(&state);
            error *= 0.3 + 0.6 * random_number(&state);
        }
    }
    return m;
}

static search_desc describe(model *m, bool by_error, double limit) {
    search_desc d = {.axis_count = m->axis_count,
                     .by_error = by_error,
                     .limit = limit,
                     .noise = 0.01,
                     .measure = measure,
                     .user = m};
    for (size_t i = 0; i < m->axis_count; i++)
        d.axes[i] = (search_axis){m->counts[i], m->counts[i] / 2};
    return d;
}

// Least cost within the limit, or least error; INFINITY when nothing is within it.
static double best_of_all(const model *m, bool by_error, double limit, size_t *all) {
    double best = INFINITY;
    *all = 0;
    search_point p = {0};
    for (;;) {
        evaluate(m, &p);
        if ((by_error ? p.error : p.cost) <= limit) best = fmin(best, by_error ? p.cost : p.error);
        ++*all;
        size_t i = 0;
        while (i < m->axis_count && ++p.rungs[i] == m->counts[i]) p.rungs[i++] = 0;
        if (i == m->axis_count) return best;
    }
}

static double middle(const model *m, bool by_error, double part) { // a limit that can be kept
    search_point low = {0}, high = {0};
    for (size_t i = 0; i < m->axis_count; i++) high.rungs[i] = m->counts[i] - 1;
    evaluate(m, &low);
    evaluate(m, &high);
    return by_error ? high.error + (low.error - high.error) * part
                    : low.cost + (high.cost - low.cost) * part;
}

// Over many models: near the best, exactly it in most, and with few of all points measured.
static void try_models(bool by_error) {
    size_t exact = 0, asked = 0, all = 0, tried = 0;
    double worst = 1;
    for (uint64_t seed = 0; seed < 60; seed++)
        for (int part = 1; part <= 3; part++) {
            model m = make(seed);
            double limit = middle(&m, by_error, 0.2 * part * part);
            search_desc d = describe(&m, by_error, limit);
            size_t points;
            double best = best_of_all(&m, by_error, limit, &points);
            if (isinf(best)) continue;
            search_result r;
            assert_true(search_run(&d, &r));
            assert_true(r.within && r.complete);
            assert_int_equal(r.count, m.asked);
            double got = by_error ? r.best.cost : r.best.error;
            worst = fmax(worst, got / best);
            exact += got <= best * 1.011;
            asked += m.asked;
            all += points;
            tried++;
        }
    print_message("%s: %zu of %zu exact, worst %.3f, %.1f %% of points\n",
                  by_error ? "error" : "cost", exact, tried, worst,
                  100 * (double)asked / (double)all);
    assert_true(tried > 150);
    assert_true(exact * 10 >= tried * 8);
    assert_true(worst < 1.5);
    assert_true(asked * 6 < all);
}

static void cheapest_within_an_error(void **state) {
    (void)state;
    try_models(true);
}

static void best_within_a_cost(void **state) {
    (void)state;
    try_models(false);
}

static void axes_that_do_nothing_cost_little(void **state) {
    (void)state;
    model m = make(3);
    for (size_t k = 0; k < m.counts[2]; k++) {
        m.cost[2][k] = 1;
        m.error[2][k] = 0;
    }
    search_desc d = describe(&m, true, middle(&m, true, 0.3));
    search_result r;
    assert_true(search_run(&d, &r));
    assert_int_equal(r.best.rungs[2], m.counts[2] / 2); // left where it was
}

static void a_limit_out_of_reach_is_told(void **state) {
    (void)state;
    model m = make(5);
    search_point high = {0};
    for (size_t i = 0; i < 4; i++) high.rungs[i] = m.counts[i] - 1;
    evaluate(&m, &high);
    search_desc d = describe(&m, true, high.error * 0.5);
    search_result r;
    assert_true(search_run(&d, &r));
    assert_false(r.within);
    assert_true(r.complete);
    assert_true(r.best.error <= high.error * 1.006);
    m.asked = 0;
    d = describe(&m, false, 0.1);
    assert_true(search_run(&d, &r));
    assert_false(r.within);
    assert_int_equal(r.best.rungs[0], 0);
}

static void noise_of_costs_is_borne(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        model m = make(seed);
        double limit = middle(&m, true, 0.3);
        size_t points;
        double best = best_of_all(&m, true, limit, &points);
        m.noise = 0.02;
        search_desc d = describe(&m, true, limit);
        d.noise = 0.04;
        search_result r;
        assert_true(search_run(&d, &r));
        assert_true(r.within);
        assert_true(r.best.cost < best * 1.6);
    }
}

static void it_can_be_stopped(void **state) {
    (void)state;
    for (size_t most = 1; most < 30; most++) {
        model m = make(9);
        m.most = most;
        search_desc d = describe(&m, true, middle(&m, true, 0.3));
        search_result r;
        assert_true(search_run(&d, &r));
        assert_true(r.count <= most);
        if (r.count == most) assert_true(isfinite(r.best.cost));
    }
    model m = make(9);
    m.most = 1;
    m.asked = 1;
    search_desc d = describe(&m, true, 1);
    search_result r;
    assert_false(search_run(&d, &r));
}

static void what_cannot_be_measured_is_never_chosen(void **state) {
    (void)state;
    model m = make(4);
    double limit = middle(&m, true, 0.3);
    search_desc d = describe(&m, true, limit);
    search_result r;
    assert_true(search_run(&d, &r));
    m.fails = true;
    memcpy(m.failing, r.best.rungs, sizeof m.failing);
    m.asked = 0;
    assert_true(search_run(&d, &r));
    assert_true(r.within);
    assert_true(memcmp(m.failing, r.best.rungs, sizeof m.failing) != 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cheapest_within_an_error),
        cmocka_unit_test(best_within_a_cost),
        cmocka_unit_test(axes_that_do_nothing_cost_little),
        cmocka_unit_test(a_limit_out_of_reach_is_told),
        cmocka_unit_test(noise_of_costs_is_borne),
        cmocka_unit_test(it_can_be_stopped),
        cmocka_unit_test(what_cannot_be_measured_is_never_chosen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
