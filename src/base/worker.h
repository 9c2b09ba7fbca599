// A few threads that run queued jobs in order; and a loop over all cores.
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct worker worker;
typedef struct worker_job {
    void (*run)(void *user);
    void *user;
} worker_job;

// `threads`: at least 1; fewer are made where the system gives no more. NULL, with a message: none.
worker *worker_create(size_t threads);
void worker_submit(worker *w, worker_job job);
void worker_submit_first(worker *w, worker_job job); // before all that still wait
void worker_wait(worker *w);                         // until every submitted job has ended
void worker_destroy(worker *w); // runs what is queued, then joins; NULL is fine

// Calls run(user, 0) to run(user, count - 1), shared out over the machine's cores, this thread
// among them; returns when all calls have. False when one was, with the message of the first by
// index; later ones may then not have been called.
bool worker_each(size_t count, bool (*run)(void *user, size_t index), void *user);
