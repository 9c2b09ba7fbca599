// The process that does the work on what strangers wrote: see base/isolate.h.
#pragma once
#include "base/isolate.h"

typedef struct reader_job {
    const char *kind;
    // In a worker. True: what was put is the result. False: the error is err_get(). It may leave by
    // _exit(0) once all is put.
    bool (*work)(const isolate_call *call);
    void (*get_ready)(void); // once, so that workers find it done; may be NULL
    // Instead of `work`: the name of the program beside this one that does it. Its libraries are
    // then loaded when they are first needed, and in no other worker.
    const char *program;
} reader_job;

// Serves until the socket WIRE_CONTROL is closed on the other side. The exit status of the process:
// it returns only when there is no such socket.
int reader_serve(const reader_job *jobs, size_t count);
