// Jobs that may fail, run by other threads. Adding a job blocks while too many of them wait.
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct jobs jobs;

// `most`: jobs that wait or run at a time. A single thread runs them in the order of jobs_add;
// several may end them in any order. NULL with a message when there is no thread.
jobs *jobs_create(size_t threads, size_t most);
// Adds a job: another thread calls `run` and then `release`. The job runs also when an earlier one
// has failed; the function then returns false with the message of that one.
bool jobs_add(jobs *j, bool (*run)(void *user), void (*release)(void *user), void *user);
// Waits until all jobs are done. False when there was nothing to wait for.
bool jobs_wait(jobs *j);
// Waits for all jobs and frees. False with the message of the first that failed. NULL is allowed.
bool jobs_finish(jobs *j);
