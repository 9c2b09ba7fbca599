// A few threads that run queued jobs in order of submission.
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct worker worker;
typedef struct worker_job {
    void (*run)(void *user);
    void *user;
} worker_job;

worker *worker_create(size_t threads); // threads >= 1
void worker_submit(worker *w, worker_job job);
void worker_wait(worker *w);    // until every submitted job has ended
void worker_destroy(worker *w); // runs what is queued, then joins; NULL is fine
