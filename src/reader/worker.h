// A worker: one job in a process of its own. Private to src/reader.
#pragma once
#include "base/isolate_wire.h"
#include "reader/reader.h"

// Does the job with the files of the request and exits. `said` becomes its stderr.
_Noreturn void worker_run(const reader_job *job, const wire_request *r, const int files[WIRE_FILES],
                          int said);

void worker_limit(const isolate_limits *limits); // limits time, memory, result and open files
// Leaves the process only memory, its open files and the channel. It can open no file by name and
// no socket, start no process and send no signal: such calls fail with EPERM. Has no effect on a
// kernel without filters, and in sanitized builds, whose reports need more calls.
void worker_confine(void);
