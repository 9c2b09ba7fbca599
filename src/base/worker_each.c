// Indices are handed out in rising order, and none after a failure. Every index before the first
// that fails was therefore handed out, so that the message does not depend on the speed of the
// threads.
#include "base/error.h"
#include "base/memory.h"
#include "base/time_limit.h"
#include "base/worker.h"
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

enum { MAX_THREADS = 8 };

uint32_t worker_cores(void) {
    static atomic_uint known;
    uint32_t cores = atomic_load(&known);
    if (cores) return cores;
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    cores = online > 0 ? (uint32_t)online : 1;
    atomic_store(&known, cores);
    return cores;
}

typedef struct loop {
    bool (*run)(void *user, size_t index);
    void *user;
    size_t count;
    time_limit *budget;   // of the thread that waits
    pthread_mutex_t lock; // guards what follows
    size_t next, failed;  // failed: the first that was; `count`: none
    char *message;
} loop;

static bool loop_take(loop *l, size_t *index) {
    pthread_mutex_lock(&l->lock);
    bool more = l->next < l->count && l->failed == l->count;
    if (more) *index = l->next++;
    pthread_mutex_unlock(&l->lock);
    return more;
}

static void note_failure(loop *l, size_t index) {
    const char *message = err_get(); // of this thread
    pthread_mutex_lock(&l->lock);
    if (index < l->failed) {
        l->failed = index;
        mem_free(l->message);
        l->message = mem_copy(message, strlen(message) + 1);
    }
    pthread_mutex_unlock(&l->lock);
}

static void loop_work(loop *l) {
    size_t index;
    while (loop_take(l, &index))
        if (!l->run(l->user, index)) note_failure(l, index);
}

static void *help(void *user) {
    loop *l = user;
    time_limit_adopt(l->budget);
    loop_work(l);
    time_limit_charge(time_limit_thread_seconds());
    return NULL;
}

bool worker_each(size_t count, bool (*run)(void *user, size_t index), void *user) {
    loop l = {
        .run = run, .user = user, .count = count, .budget = time_limit_now(), .failed = count};
    pthread_mutex_init(&l.lock, NULL);
    pthread_t threads[MAX_THREADS];
    size_t started = 0; // fewer than wanted do as well
    while (started + 1 < count && started < MAX_THREADS && started + 1 < worker_cores() &&
           pthread_create(&threads[started], NULL, help, &l) == 0)
        started++;
    loop_work(&l);
    for (size_t i = 0; i < started; i++) pthread_join(threads[i], NULL);
    pthread_mutex_destroy(&l.lock);
    bool done = l.failed == count || err_set("%s", l.message);
    mem_free(l.message);
    return done;
}
