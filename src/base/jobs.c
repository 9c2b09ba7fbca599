// Jobs on a worker, which are counted while they wait or run.
#include "base/jobs.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include "base/worker.h"
#include <pthread.h>

struct jobs {
    worker *threads;
    pthread_mutex_t mutex;
    pthread_cond_t fewer;
    size_t count, most;
    bool failed;
    char message[1024]; // of the first failure
};

typedef struct job {
    jobs *of;
    bool (*run)(void *user);
    void (*release)(void *user);
    void *user;
} job;

jobs *jobs_create(size_t threads, size_t most) {
    jobs *j = mem_alloc(sizeof *j);
    j->most = most;
    pthread_mutex_init(&j->mutex, NULL);
    pthread_cond_init(&j->fewer, NULL);
    j->threads = worker_create(threads);
    if (j->threads) return j;
    jobs_finish(j);
    return NULL;
}

static void jobs_run_next(void *user) {
    job *one = user;
    jobs *j = one->of;
    mem_enter();
    bool done = one->run(one->user);
    one->release(one->user);
    done = mem_leave(done);
    mem_free(one);
    pthread_mutex_lock(&j->mutex);
    if (!done && !j->failed) str_copy(j->message, sizeof j->message, err_get());
    j->failed = j->failed || !done;
    j->count--;
    pthread_cond_signal(&j->fewer);
    pthread_mutex_unlock(&j->mutex);
}

bool jobs_add(jobs *j, bool (*work)(void *user), void (*release)(void *user), void *user) {
    job *one = mem_alloc(sizeof *one);
    *one = (job){j, work, release, user};
    pthread_mutex_lock(&j->mutex);
    while (j->count >= j->most) pthread_cond_wait(&j->fewer, &j->mutex);
    j->count++;
    bool fine = !j->failed || err_set("%s", j->message);
    pthread_mutex_unlock(&j->mutex);
    worker_submit(j->threads, (worker_job){jobs_run_next, one});
    return fine;
}

bool jobs_wait(jobs *j) {
    pthread_mutex_lock(&j->mutex);
    bool waited = j->count > 0;
    while (j->count > 0) pthread_cond_wait(&j->fewer, &j->mutex);
    pthread_mutex_unlock(&j->mutex);
    return waited;
}

bool jobs_finish(jobs *j) {
    if (!j) return true;
    worker_destroy(j->threads);
    bool fine = !j->failed || err_set("%s", j->message);
    pthread_cond_destroy(&j->fewer);
    pthread_mutex_destroy(&j->mutex);
    mem_free(j);
    return fine;
}
