// Workers: every job once, in order, and nothing left running after a wait.
#include "base_test.h"

#include "base/worker.h"
#include <pthread.h>
#include <stdatomic.h>

enum { JOBS = 1000 };

typedef struct gate { // holds jobs back until the test opens it
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    bool open;
    int waiting;
} gate;

static gate *gate_create(void) {
    gate *g = calloc(1, sizeof *g);
    pthread_mutex_init(&g->mutex, NULL);
    pthread_cond_init(&g->changed, NULL);
    return g;
}

static void gate_pass(void *user) {
    gate *g = user;
    pthread_mutex_lock(&g->mutex);
    g->waiting++;
    pthread_cond_broadcast(&g->changed);
    while (!g->open) pthread_cond_wait(&g->changed, &g->mutex);
    pthread_mutex_unlock(&g->mutex);
}

static void gate_await(gate *g, int waiting) {
    pthread_mutex_lock(&g->mutex);
    while (g->waiting < waiting) pthread_cond_wait(&g->changed, &g->mutex);
    pthread_mutex_unlock(&g->mutex);
}

static void gate_open(gate *g) {
    pthread_mutex_lock(&g->mutex);
    g->open = true;
    pthread_cond_broadcast(&g->changed);
    pthread_mutex_unlock(&g->mutex);
}

static void gate_destroy(gate *g) {
    pthread_cond_destroy(&g->changed);
    pthread_mutex_destroy(&g->mutex);
    free(g);
}

typedef struct record {
    int number, *order;
    atomic_int *done;
} record;

static void run_record(void *user) {
    record *r = user;
    r->order[atomic_fetch_add(r->done, 1)] = r->number;
}

// Runs JOBS jobs by one thread that is held back until all are in the queue, so that the ring grows
// and wraps; returns their numbers as they ran.
static const int *run_held_back(void (*submit)(worker *w, worker_job job, int number)) {
    static record records[JOBS];
    static int order[JOBS];
    atomic_int done = 0;
    gate *g = gate_create();
    worker *w = worker_create(1);
    worker_submit(w, (worker_job){gate_pass, g});
    gate_await(g, 1);
    for (int i = 0; i < JOBS; i++) {
        records[i] = (record){i, order, &done};
        submit(w, (worker_job){run_record, &records[i]}, i);
    }
    assert_int_equal(atomic_load(&done), 0);
    gate_open(g);
    worker_wait(w);
    assert_int_equal(atomic_load(&done), JOBS);
    worker_destroy(w);
    gate_destroy(g);
    return order;
}

static void submit_last(worker *w, worker_job job, int number) {
    (void)number;
    worker_submit(w, job);
}

static void submit_odd_first(worker *w, worker_job job, int number) {
    (number % 2 ? worker_submit_first : worker_submit)(w, job);
}

static void one_thread_keeps_the_order(void **state) {
    (void)state;
    const int *order = run_held_back(submit_last);
    for (int i = 0; i < JOBS; i++) assert_int_equal(order[i], i);
}

// The latest of them first.
static void what_is_urgent_goes_first(void **state) {
    (void)state;
    const int *order = run_held_back(submit_odd_first);
    for (int i = 0; i < JOBS / 2; i++) {
        assert_int_equal(order[i], JOBS - 1 - 2 * i);
        assert_int_equal(order[JOBS / 2 + i], 2 * i);
    }
}

static void add_one(void *user) {
    atomic_fetch_add((atomic_int *)user, 1);
}

static void wait_sees_every_job_ended(void **state) {
    (void)state;
    atomic_int done = 0;
    worker *w = worker_create(4);
    worker_wait(w); // nothing to wait for
    for (int round = 1; round <= 50; round++) {
        for (int i = 0; i < 20; i++) worker_submit(w, (worker_job){add_one, &done});
        worker_wait(w);
        assert_int_equal(atomic_load(&done), round * 20);
    }
    worker_destroy(w);
}

// Three jobs that wait for one another could not end on fewer than three threads.
static void threads_run_side_by_side(void **state) {
    (void)state;
    gate *g = gate_create();
    worker *w = worker_create(3);
    for (int i = 0; i < 3; i++) worker_submit(w, (worker_job){gate_pass, g});
    gate_await(g, 3);
    gate_open(g);
    worker_wait(w);
    worker_destroy(w);
    gate_destroy(g);
}

static void destroying_runs_what_is_queued(void **state) {
    (void)state;
    atomic_int done = 0;
    gate *g = gate_create();
    worker *w = worker_create(1);
    worker_submit(w, (worker_job){gate_pass, g});
    for (int i = 0; i < 100; i++) worker_submit(w, (worker_job){add_one, &done});
    gate_await(g, 1);
    gate_open(g);
    worker_destroy(w);
    assert_int_equal(atomic_load(&done), 100);
    gate_destroy(g);
    worker_destroy(NULL);
    worker_destroy(worker_create(2)); // never used
}

typedef struct chain {
    worker *owner;
    atomic_int left;
} chain;

static void run_chain(void *user) {
    chain *c = user;
    if (atomic_fetch_sub(&c->left, 1) > 1) worker_submit(c->owner, (worker_job){run_chain, c});
}

static void job_may_submit_the_next(void **state) {
    (void)state;
    chain c = {.owner = worker_create(2), .left = 100};
    worker_submit(c.owner, (worker_job){run_chain, &c});
    worker_wait(c.owner);
    assert_int_equal(atomic_load(&c.left), 0);
    worker_destroy(c.owner);
}

// ---- a loop over all cores --------------------------------------------------------------------

static bool count_index(void *user, size_t index) {
    atomic_int *counts = user;
    atomic_fetch_add(&counts[index], 1);
    return true;
}

static void each_index_is_called_once(void **state) {
    (void)state;
    static atomic_int counts[JOBS];
    for (size_t count = 0; count <= JOBS; count = 2 * count + 1) {
        memset(counts, 0, sizeof counts);
        assert_true(worker_each(count, count_index, counts));
        for (size_t i = 0; i < JOBS; i++) assert_int_equal(counts[i], i < count);
    }
}

static bool fail_from_300(void *user, size_t index) {
    atomic_fetch_add((atomic_int *)user, 1);
    return index < 300 || err_set("index %zu", index);
}

static void the_first_failure_is_told(void **state) {
    (void)state;
    for (int round = 0; round < 50; round++) {
        atomic_int calls = 0;
        err_clear();
        assert_false(worker_each(JOBS, fail_from_300, &calls));
        assert_string_equal(err_get(), "index 300");
        assert_true(calls > 300 && calls < JOBS);
    }
}

static bool nest(void *user, size_t index) {
    (void)index;
    return worker_each(20, count_index, user);
}

static void loops_nest(void **state) {
    (void)state;
    static atomic_int counts[20];
    memset(counts, 0, sizeof counts);
    assert_true(worker_each(10, nest, counts));
    for (int i = 0; i < 20; i++) assert_int_equal(counts[i], 10);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_thread_keeps_the_order),
        cmocka_unit_test(what_is_urgent_goes_first),
        cmocka_unit_test(wait_sees_every_job_ended),
        cmocka_unit_test(threads_run_side_by_side),
        cmocka_unit_test(destroying_runs_what_is_queued),
        cmocka_unit_test(job_may_submit_the_next),
        cmocka_unit_test(each_index_is_called_once),
        cmocka_unit_test(the_first_failure_is_told),
        cmocka_unit_test(loops_nest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
