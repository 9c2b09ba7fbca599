// One job, in a process of its own. Private to src/reader.
#pragma once
#include "base/isolate_wire.h"
#include "reader/reader.h"

// With the files of the request. `said` becomes its stderr.
_Noreturn void worker_run(const reader_job *job, const wire_request *r, const int files[WIRE_FILES],
                          int said);

void worker_limit(const isolate_limits *limits); // time, memory, result, files
// Leaves the process nothing but memory, its files and the channel: no file by name, no socket, no
// process, no signal to another. What is asked for fails with EPERM. Without effect on a kernel
// that has no filters, and in sanitized builds, whose reports need more.
void worker_confine(void);
