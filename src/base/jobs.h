// Jobs that may fail, done on other threads, at most so many at a time: whoever adds more waits.
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct jobs jobs;

// One thread does them in the order of jobs_add; several end them in any order.
jobs *jobs_create(size_t threads, size_t most);
// `run` and then `release`, also when one before it has failed; false with the message of that one,
// though this one is done, too.
bool jobs_add(jobs *j, bool (*run)(void *user), void (*release)(void *user), void *user);
// Waits until all that were added are done; false when there was nothing to wait for.
bool jobs_wait(jobs *j);
// Waits for all and frees. False with the message of the first that failed. NULL is fine.
bool jobs_finish(jobs *j);
