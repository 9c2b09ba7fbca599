// Work on files from strangers by libraries that do not stand them: it runs in a child process, so
// that a crash, a hang or a flood of memory ends there. The child has nothing but its own copy of
// our memory; what it wants to hand back it writes to a descriptor.
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct isolate_job {
    const char *name; // for messages: the file that is read
    // In the child. True: what was written is the result. False: the error is err_get().
    bool (*work)(void *user, int out);
    void *user;
} isolate_job;

// Limits: 60 s of processor time, 120 s in all, 4 GiB of memory, 2 GiB of result. Free `*data` with
// mem_free. The child has only the calling thread, so `work` must not touch what another thread
// may hold locked: no GPU, no log, no workers.
bool isolate_run(const isolate_job *job, void **data, size_t *size);

// For `work`: writes all of it.
bool isolate_put(int out, const void *data, size_t size);
