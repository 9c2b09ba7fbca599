// Threads that run queued jobs in order, and a loop over all cores.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

uint32_t worker_cores(void); // of the machine, at least 1; the system is asked once

typedef struct worker worker;
typedef struct worker_job {
    void (*run)(void *user);
    void *user;
} worker_job;

// Creates `threads` threads, at least 1; fewer when the system refuses more. NULL with a message
// when it refuses all.
worker *worker_create(size_t threads);
void worker_submit(worker *w, worker_job job);       // any thread
void worker_submit_first(worker *w, worker_job job); // the same, before all jobs that wait
void worker_wait(worker *w);                         // until every submitted job has ended
void worker_destroy(worker *w); // runs the queued jobs and joins the threads; NULL is allowed

// Calls run(user, 0) to run(user, count - 1) on all cores, this thread among them, and returns when
// all calls have ended. When a call returns false, so does this function, with the message of the
// lowest such index; later calls may then be left out.
bool worker_each(size_t count, bool (*run)(void *user, size_t index), void *user);
