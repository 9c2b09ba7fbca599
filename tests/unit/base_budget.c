// The account of memory: what is taken, what is refused, and what a refusal says.
#include "base/budget.h"
#include "base_test.h"
#include <pthread.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MIB = 1 << 20 };

static budget *make(const char *share) {
    assert_true(budget_set_share(share));
    return budget_create("memory of a test", 1000 * (uint64_t)MIB);
}

static int put_back(void **state) {
    (void)state;
    return budget_set_share(NULL) ? 0 : 1;
}

static void takes_up_to_the_limit_and_no_further(void **state) {
    (void)state;
    budget *b = make("10%");
    budget_part *a = budget_take(b, 60 * MIB, "a");
    assert_non_null(a);
    assert_null(budget_take(b, 40 * MIB + 1, "b"));
    assert_int_equal(budget_get(b).sum, 60 * MIB);
    budget_part *c = budget_take(b, 40 * MIB, "b");
    assert_non_null(c);
    assert_int_equal(budget_room(b), 0);
    budget_give(a);
    assert_int_equal(budget_room(b), 60 * MIB);
    budget_give(c);
    assert_int_equal(budget_get(b).sum, 0);
    budget_destroy(b);
}

static void a_refusal_says_the_sum_and_the_three_largest_parts(void **state) {
    (void)state;
    budget *b = make("100M");
    budget_part *parts[] = {budget_take(b, 10 * MIB, "small"), budget_take(b, 20 * MIB, "twice"),
                            budget_take(b, 25 * MIB, "alone"), budget_take(b, 20 * MIB, "twice")};
    assert_null(budget_take(b, 30 * MIB, "asked"));
    const char *said = err_get();
    assert_non_null(strstr(said, "asked: 105.0 MiB of memory of a test"));
    assert_non_null(strstr(said, "100.0 MiB may be, of 1000.0 MiB"));
    assert_non_null(strstr(said, "--memory"));
    assert_non_null(strstr(said, "parts: twice 40.0 MiB, asked 30.0 MiB, alone 25.0 MiB"));
    assert_null(strstr(said, "small"));
    for (size_t i = 0; i < 4; i++) budget_give(parts[i]);
    budget_destroy(b);
}

static void sums_do_not_overflow(void **state) {
    (void)state;
    budget *b = make("100%");
    budget_part *a = budget_take(b, MIB, "a");
    assert_null(budget_take(b, UINT64_MAX, "all"));
    assert_null(budget_take(b, UINT64_MAX - MIB + 1, "all"));
    budget_row rows[] = {{"x", UINT64_MAX / 2}, {"y", UINT64_MAX / 2}, {"z", 4}};
    assert_false(budget_ask(b, rows, 3, 0));
    assert_false(budget_resize(a, UINT64_MAX));
    assert_int_equal(budget_get(b).sum, MIB);
    budget_give(a);
    budget_destroy(b);
}

static void a_list_counts_what_is_shared_once(void **state) {
    (void)state;
    budget *b = make("100M");
    int shared, other;
    budget_list list = {0};
    assert_true(budget_list_first(&list, &shared));
    assert_true(budget_list_first(&list, &other));
    assert_false(budget_list_first(&list, &shared));
    budget_list_add(&list, "nothing", 0);
    budget_list_add(&list, "a", 60 * MIB);
    assert_true(budget_ask(b, list.rows, list.count, 0));
    budget_list_add(&list, "b", 41 * MIB);
    assert_int_equal(list.count, 2);
    assert_false(budget_ask(b, list.rows, list.count, 0));
    assert_non_null(strstr(err_get(), "parts: a 60.0 MiB, b 41.0 MiB"));
    assert_int_equal(budget_get(b).sum, 0);
    budget_list_free(&list);
    assert_true(list.count == 0 && budget_list_first(&list, &shared));
    budget_list_free(&list);
    budget_destroy(b);
}

static void a_part_changes_its_size_and_moves(void **state) {
    (void)state;
    budget *b = make("100M");
    budget_part *a = budget_take(b, 50 * MIB, "a"), *c = budget_take(b, 0, "c");
    assert_true(budget_resize(a, 100 * MIB));
    assert_false(budget_resize(a, 100 * MIB + 1));
    assert_non_null(strstr(err_get(), "a 100.0 MiB"));
    budget_move(a, c, 30 * MIB); // of one that is full
    assert_int_equal(budget_get(b).sum, 100 * MIB);
    assert_int_equal(budget_get(b).largest[1].bytes, 30 * MIB);
    assert_true(budget_resize(a, MIB));
    assert_int_equal(budget_room(b), 69 * MIB);
    budget_note(a, 200 * MIB); // which cannot be refused
    assert_int_equal(budget_room(b), 0);
    assert_null(budget_take(b, 1, "more"));
    budget_part *none = budget_take(b, 0, "none");
    assert_non_null(none);
    budget_give(none);
    budget_give(a);
    budget_give(c);
    assert_int_equal(budget_get(b).sum, 0);
    budget_destroy(b);
}

static void what_is_asked_for_takes_nothing(void **state) {
    (void)state;
    budget *b = make("100M");
    budget_part *a = budget_take(b, 80 * MIB, "old");
    budget_row rows[] = {{"color", 15 * MIB}, {"depth", 10 * MIB}};
    assert_false(budget_ask(b, rows, 2, 0));
    assert_non_null(strstr(err_get(), "105.0 MiB"));
    assert_non_null(strstr(err_get(), "old 80.0 MiB, color 15.0 MiB, depth 10.0 MiB"));
    assert_true(budget_ask(b, rows, 2, 5 * MIB)); // if so much is given before
    assert_int_equal(budget_get(b).sum, 80 * MIB);
    budget_give(a);
    budget_destroy(b);
}

static void a_loan_ends_below_what_there_is(void **state) {
    (void)state;
    budget *b = make("60%");
    budget_part *old = budget_take(b, 600 * MIB, "old");
    assert_null(budget_take(b, MIB, "new"));
    budget_lend(b, 100 * MIB);
    budget_part *new = budget_take(b, 100 * MIB, "new");
    assert_non_null(new);
    assert_null(budget_take(b, 1, "more"));
    budget_lend(b, UINT64_MAX);
    assert_int_equal(budget_room(b), 200 * MIB); // nine tenths
    budget_lend(b, 0);
    assert_int_equal(budget_room(b), 0);
    budget_give(old);
    budget_give(new);
    budget_destroy(b);
}

static void a_share_is_read_or_refused(void **state) {
    (void)state;
    static const struct {
        const char *text;
        uint64_t limit;
    } good[] = {{"50%", 500 * (uint64_t)MIB}, {"100%", 1000 * (uint64_t)MIB},
                {"2G", UINT64_C(2) << 30},    {"512M", 512 * (uint64_t)MIB},
                {"1.5g", UINT64_C(3) << 29},  {"64MiB", 64 * (uint64_t)MIB},
                {"2048K", 2 * (uint64_t)MIB}, {NULL, 600 * (uint64_t)MIB}};
    static const char *const bad[] = {"",    "80", "0%", "-5%",  "101%", "much",  "8X",
                                      "8GG", "0G", "1K", "nan%", "inf%", "1e300G"};
    budget *b = make(NULL);
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        assert_true(budget_set_share(good[i].text));
        assert_int_equal(budget_get_limit(b), good[i].limit);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_false(budget_set_share(bad[i]));
        assert_non_null(strstr(err_get(), "accepted: a share"));
        assert_int_equal(budget_get_limit(b), 600 * (uint64_t)MIB); // as it was
    }
    budget_destroy(b);
}

// In a child, for a budget of the host is measured once.
static void the_host_has_no_more_than_its_address_space(void **state) {
    (void)state;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) // which map far more
    skip();
#endif
    pid_t child = fork();
    if (child == 0) {
        struct rlimit space = {(rlim_t)900 * MIB, (rlim_t)900 * MIB};
        bool set = setrlimit(RLIMIT_AS, &space) == 0;
        _exit(set && budget_get(budget_host()).total == (uint64_t)900 * MIB ? 0 : 1);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

enum { THREADS = 4, ROUNDS = 2000 };

static void *take_and_give(void *user) {
    budget *b = user;
    uintptr_t refused = 0;
    for (int i = 0; i < ROUNDS; i++) {
        budget_part *part = budget_take(b, 2 * MIB, "a thread's");
        if (part && budget_get(b).sum > 5 * MIB) refused = UINTPTR_MAX / 2; // more than may be
        if (!part) refused++;
        budget_give(part);
    }
    return (void *)refused;
}

static void threads_never_take_more_than_there_is(void **state) {
    (void)state;
    budget *b = make("5M");
    pthread_t threads[THREADS];
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, take_and_give, b), 0);
    for (int i = 0; i < THREADS; i++) {
        void *refused;
        pthread_join(threads[i], &refused);
        assert_true((uintptr_t)refused <= ROUNDS);
    }
    assert_int_equal(budget_get(b).sum, 0);
    budget_destroy(b);
}

// Of two budgets within one, each has a limit of its own, and both keep that of the whole.
static void a_budget_within_another_keeps_both_limits(void **state) {
    (void)state;
    budget *all = make("10%");
    budget *first = budget_create_within(all, "the first's memory", 70 * MIB, "`first`");
    budget *second = budget_create_within(all, "the second's memory", 50 * MIB, "`second`");
    budget_part *a = budget_take(first, 60 * MIB, "a");
    assert_non_null(a);
    assert_null(budget_take(first, 11 * MIB, "b"));
    assert_non_null(strstr(err_get(), "71.0 MiB of the first's memory would be taken in all, and "
                                      "70.0 MiB may be (`first` sets another limit)"));
    assert_int_equal(budget_get(all).sum, 60 * MIB); // nothing stays of what was refused
    assert_null(budget_take(second, 45 * MIB, "c"));
    assert_non_null(strstr(err_get(), "105.0 MiB of memory of a test"));
    assert_int_equal(budget_get(second).sum, 0);
    assert_int_equal(budget_room(second), 40 * MIB);
    budget_part *d = budget_take(second, 0, "d");
    assert_true(budget_resize(d, 40 * MIB));
    assert_int_equal(budget_get(all).sum, 100 * MIB);
    assert_false(budget_resize(d, 41 * MIB));
    const budget_row row = {.label = "e", .bytes = 5 * MIB};
    assert_false(budget_ask(first, &row, 1, 0)); // the whole has no room
    assert_true(budget_resize(d, 10 * MIB));
    assert_true(budget_ask(first, &row, 1, 0));
    assert_int_equal(budget_get(all).sum, 70 * MIB);
    budget_give(a);
    budget_give(d);
    assert_int_equal(budget_get(all).sum, 0);
    budget_destroy(first);
    budget_destroy(second);
    budget_destroy(all);
}

static void an_amount_is_read_or_refused(void **state) {
    (void)state;
    uint64_t bytes;
    assert_true(budget_read_amount("512M", &bytes));
    assert_int_equal(bytes, 512 * (uint64_t)MIB);
    assert_false(budget_read_amount("60%", &bytes));
    assert_false(budget_read_amount("", &bytes));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        // First: before any other asks for the host's.
        cmocka_unit_test(the_host_has_no_more_than_its_address_space),
        cmocka_unit_test_teardown(takes_up_to_the_limit_and_no_further, put_back),
        cmocka_unit_test_teardown(a_refusal_says_the_sum_and_the_three_largest_parts, put_back),
        cmocka_unit_test_teardown(sums_do_not_overflow, put_back),
        cmocka_unit_test_teardown(a_list_counts_what_is_shared_once, put_back),
        cmocka_unit_test_teardown(a_part_changes_its_size_and_moves, put_back),
        cmocka_unit_test_teardown(what_is_asked_for_takes_nothing, put_back),
        cmocka_unit_test_teardown(a_loan_ends_below_what_there_is, put_back),
        cmocka_unit_test_teardown(a_share_is_read_or_refused, put_back),
        cmocka_unit_test_teardown(a_budget_within_another_keeps_both_limits, put_back),
        cmocka_unit_test(an_amount_is_read_or_refused),
        cmocka_unit_test_teardown(threads_never_take_more_than_there_is, put_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
