// Runs libraries on files of strangers that they may not withstand: GLSL that keeps a compiler busy
// for years, meshes and pictures that crash their importer. The work is done in another process,
// `roil-reader`, where a crash, a hang or a lack of memory does no harm.
//
//   this process (isolate.c)        the reader (reader/server.c)   a worker (reader/worker.c)
//   the input: a file, or bytes
//   in a memory file; a memory
//   file for the result  ---------> fork -----------------------> limits and a filter of system
//   wait                                                          calls, the work, its result
//   open a file that it asks for <------------------------------- by name
//   wait              <------------ status of the worker
//   map the result
//
// The reader is another program, started once with posix_spawn. The host is never forked, because a
// fork of a process with many threads leaves locks locked forever and costs 0.1 ms for each MB in
// use. The reader has one working thread and little memory, so forking it is safe and cheap. It has
// no signal handler, file or memory of the host, and ends when the host does. A worker can open no
// file: this process opens those that it may read and passes them on.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// ---- the client -------------------------------------------------------------------------------

typedef struct isolate_limits { // of one job
    uint32_t processor_ms;      // processor time; the limit of real time is 10 s plus thrice this
    uint64_t memory;            // bytes, in addition to the reader's own
    uint64_t result;            // bytes
} isolate_limits;

enum { ISOLATE_ARGUMENTS = 64, ISOLATE_KIND = 16 };

typedef struct isolate_job {
    const char *kind;      // a name of the table in reader/main.c
    const char *name;      // the file that is read, for messages; NULL: the caller adds it to them
    const char *who;       // for messages: "the compiler"; NULL: "the reader"
    const void *arguments; // at most ISOLATE_ARGUMENTS bytes
    size_t argument_size;
    int file; // the input, from its beginning; used when `bytes` is NULL
    const void *bytes;
    size_t size; // bytes of the input
    // Opens a file that the work asks for and returns its descriptor and size; -1: there is none,
    // or it must not be read. NULL: the work gets no files.
    int (*open)(void *user, const char *name, size_t *size);
    void *user; // passed to open
    isolate_limits limits;
} isolate_job;

typedef struct isolate_result {
    void *data; // may be written to
    size_t size;
    uint32_t processor_ms; // time that the worker took, also when it failed
} isolate_result;

// Runs a job and waits for its result, to be freed with isolate_free. False with the message of the
// work, or with one that says how the worker ended. Any thread.
bool isolate_run(const isolate_job *job, isolate_result *out);
void isolate_free(isolate_result *r);

// Sets the path of the reader for the next one that is started. Default: $ROIL_READER, or else the
// one beside the running program. False with a message when the path is too long.
bool isolate_set_reader(const char *program);
// Starts the reader and makes it prepare for a kind of job, without waiting for it. The first
// shader is then 100 ms faster, the first volume 60 ms.
void isolate_warm_up(const char *kind);

// ---- the worker -------------------------------------------------------------------------------

typedef struct isolate_call isolate_call;
struct isolate_call {
    const char *name; // for messages
    const void *arguments;
    size_t argument_size;
    const void *bytes; // the input, and a zero byte
    size_t size;
    int out, channel; // -1: none
    // Reads a whole file of at most `max` bytes, which the client opens. Free `*data` with
    // mem_free. False with a message when it must not be read.
    bool (*ask)(const isolate_call *call, const char *name, size_t max, void **data, size_t *size);
};

bool isolate_put(const isolate_call *call, const void *data, size_t size); // appends to the result
// Maps `size` bytes of the result from `at` on, to write it without a copy. New bytes are zero.
// `at` must be a multiple of the page size. NULL with a message. Unmap it with munmap.
void *isolate_map(const isolate_call *call, size_t at, size_t size);
bool isolate_cut(const isolate_call *call, size_t size); // sets the size of the result
