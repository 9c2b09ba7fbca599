// A mutex, a ring of jobs and two conditions: "there is a job (or the end)" and "all jobs are
// done".
#include "base/worker.h"
#include "base/error.h"
#include "base/memory.h"
#include <pthread.h>
#include <string.h>

struct worker {
    pthread_mutex_t mutex;
    pthread_cond_t wake, idle;
    worker_job *jobs; // ring
    size_t first, count, capacity;
    size_t running;
    bool ending;
    pthread_t *threads;
    size_t thread_count;
};

static void *thread_main(void *user) {
    worker *w = user;
    pthread_mutex_lock(&w->mutex);
    for (;;) {
        while (!w->count && !w->ending) pthread_cond_wait(&w->wake, &w->mutex);
        if (!w->count) break;
        worker_job job = w->jobs[w->first];
        w->first = (w->first + 1) % w->capacity;
        w->count--;
        w->running++;
        pthread_mutex_unlock(&w->mutex);
        job.run(job.user);
        pthread_mutex_lock(&w->mutex);
        w->running--;
        if (!w->count && !w->running) pthread_cond_broadcast(&w->idle);
    }
    pthread_mutex_unlock(&w->mutex);
    return NULL;
}

worker *worker_create(size_t threads) {
    worker *w = mem_alloc(sizeof *w);
    pthread_mutex_init(&w->mutex, NULL);
    pthread_cond_init(&w->wake, NULL);
    pthread_cond_init(&w->idle, NULL);
    w->threads = mem_alloc(threads * sizeof *w->threads);
    for (size_t i = 0; i < threads; i++) {
        int failed = pthread_create(&w->threads[i], NULL, thread_main, w);
        if (failed && i > 0) break;
        if (failed) {
            worker_destroy(w);
            return ERR_NULL("no thread can be made: %s", strerror(failed));
        }
        w->thread_count++;
    }
    return w;
}

static void worker_grow(worker *w) {
    size_t capacity = w->capacity ? w->capacity * 2 : 16;
    worker_job *jobs = mem_alloc(capacity * sizeof *jobs);
    for (size_t i = 0; i < w->count; i++) jobs[i] = w->jobs[(w->first + i) % w->capacity];
    mem_free(w->jobs);
    w->jobs = jobs;
    w->first = 0;
    w->capacity = capacity;
}

static void worker_put(worker *w, worker_job job, bool first) {
    pthread_mutex_lock(&w->mutex);
    if (w->count == w->capacity) worker_grow(w);
    size_t place = w->first + w->count++;
    if (first) place = w->first = (w->first + w->capacity - 1) % w->capacity;
    w->jobs[place % w->capacity] = job;
    pthread_cond_signal(&w->wake);
    pthread_mutex_unlock(&w->mutex);
}

void worker_submit(worker *w, worker_job job) {
    worker_put(w, job, false);
}

void worker_submit_first(worker *w, worker_job job) {
    worker_put(w, job, true);
}

void worker_wait(worker *w) {
    pthread_mutex_lock(&w->mutex);
    while (w->count || w->running) pthread_cond_wait(&w->idle, &w->mutex);
    pthread_mutex_unlock(&w->mutex);
}

void worker_destroy(worker *w) {
    if (!w) return;
    pthread_mutex_lock(&w->mutex);
    w->ending = true;
    pthread_cond_broadcast(&w->wake);
    pthread_mutex_unlock(&w->mutex);
    for (size_t i = 0; i < w->thread_count; i++) pthread_join(w->threads[i], NULL);
    pthread_cond_destroy(&w->idle);
    pthread_cond_destroy(&w->wake);
    pthread_mutex_destroy(&w->mutex);
    mem_free(w->threads);
    mem_free(w->jobs);
    mem_free(w);
}
