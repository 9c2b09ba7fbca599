// The process that reads files of strangers: see base/isolate.h.
#pragma once
#include "base/isolate.h"

typedef struct reader_job {
    const char *kind;
    // Does the job, in a worker. True: the result is what was put. False: the error is err_get().
    // It may call _exit(0) once the result is complete.
    bool (*work)(const isolate_call *call);
    void (*get_ready)(void); // prepares once for all workers; may be NULL
    // Instead of `work`: the name of the program beside this one that does the job. Its libraries
    // are then loaded only when they are first needed, and in no other worker.
    const char *program;
} reader_job;

// Serves requests until the client closes the socket WIRE_CONTROL, and then ends the process. It
// returns, with an exit status, only when there is no such socket.
int reader_serve(const reader_job *jobs, size_t count);
