// Jobs on other threads: all are done, few at a time, and the first failure is told.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/jobs.h"
#include "base/memory.h"
#include <pthread.h>
#include <string.h>
#include <unistd.h>

enum { COUNT = 40 };

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static int order[COUNT], done, alive, most_alive, released;

static void reset(void) {
    done = alive = most_alive = released = 0;
}

static bool note(void *user) {
    usleep(200);
    pthread_mutex_lock(&mutex);
    order[done++] = *(int *)user;
    pthread_mutex_unlock(&mutex);
    return *(int *)user % 10 != 7 || err_set("number %d failed", *(int *)user);
}

static void release(void *user) {
    pthread_mutex_lock(&mutex);
    alive--;
    released++;
    pthread_mutex_unlock(&mutex);
    mem_free(user);
}

static bool add(jobs *j, int number) {
    int *user = mem_copy(&number, sizeof number);
    pthread_mutex_lock(&mutex);
    alive++;
    most_alive = alive > most_alive ? alive : most_alive;
    pthread_mutex_unlock(&mutex);
    return jobs_add(j, note, release, user);
}

static void one_thread_keeps_the_order(void **state) {
    (void)state;
    reset();
    jobs *j = jobs_create(1, 3);
    for (int i = 0; i < COUNT; i++) add(j, 10 * i);
    assert_true(jobs_finish(j));
    for (int i = 0; i < COUNT; i++) assert_int_equal(order[i], 10 * i);
    assert_int_equal(released, COUNT);
}

static void few_are_alive_at_a_time(void **state) {
    (void)state;
    reset();
    jobs *j = jobs_create(2, 4);
    for (int i = 0; i < COUNT; i++) add(j, 0);
    assert_true(jobs_finish(j));
    assert_int_equal(done, COUNT);
    assert_true(most_alive <= 5); // one more is made before it is added
}

static void first_failure_is_told_and_all_are_done(void **state) {
    (void)state;
    reset();
    jobs *j = jobs_create(1, 2);
    bool told = false;
    for (int i = 0; i < COUNT; i++) {
        if (add(j, i)) continue;
        assert_string_equal(err_get(), "number 7 failed");
        told = true;
    }
    assert_true(told);
    assert_false(jobs_finish(j));
    assert_string_equal(err_get(), "number 7 failed");
    assert_int_equal(released, COUNT);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_thread_keeps_the_order),
        cmocka_unit_test(few_are_alive_at_a_time),
        cmocka_unit_test(first_failure_is_told_and_all_are_done),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
