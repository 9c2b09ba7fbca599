// Work on what strangers wrote, by libraries that do not stand it: GLSL that keeps a compiler busy
// for years, meshes and pictures that crash their importer. It is done by a process of its own,
// `roil-reader`, so that a crash, a hang or a flood of memory ends there.
//
//   this process (isolate.c)        the reader (reader/server.c)   a worker (reader/worker.c)
//   the input: a file, or bytes
//   in a memory file; a memory
//   file for the result  ---------> fork -----------------------> limits, no system calls but a
//   wait                                                          few, the work; its result
//   open a file that it asks for <------------------------------- by name
//   wait              <------------ how the worker ended
//   map the result
//
// The reader is another program, started once with posix_spawn: a host that embeds the library is
// never forked, which from many threads leaves locks locked for ever and costs 0.1 ms for each MB
// in use. The reader has one thread that works and little memory, so its workers are sound and
// cheap. It has no handler, file or memory of the host's, and ends when the host does. A worker can
// open nothing: what it reads beside its input this process opens for it, if it may.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// ---- who has work -----------------------------------------------------------------------------

typedef struct isolate_limits { // of one job
    uint32_t processor_ms;      // of processor time; three times as much, and 10 s, of real time
    uint64_t memory;            // bytes, beyond what the reader has anyway
    uint64_t result;            // bytes
} isolate_limits;

enum { ISOLATE_ARGUMENTS = 64, ISOLATE_KIND = 16 };

typedef struct isolate_job {
    const char *kind; // a name of the table in reader/main.c
    const char
        *name;       // the file that is read, for messages; NULL: whoever asked puts it before them
    const char *who; // for messages: "the compiler"; NULL: "the reader"
    const void *arguments; // at most ISOLATE_ARGUMENTS bytes
    size_t argument_size;
    int file; // the input, from its beginning; used when `bytes` is NULL
    const void *bytes;
    size_t size; // of either
    // Opens a file that the work asks for and gives its size; -1: it may not have it, or there is
    // none. NULL: it gets none.
    int (*open)(void *user, const char *name, size_t *size);
    void *user;
    isolate_limits limits;
} isolate_job;

typedef struct isolate_result {
    void *data; // may be written to
    size_t size;
    uint32_t processor_ms; // that the worker took, also when it failed
} isolate_result;

// False with a message: the work's own, or how it ended. Any thread.
bool isolate_run(const isolate_job *job, isolate_result *out);
void isolate_free(isolate_result *r);

// Where the reader is, for the next one that is started; not said: $ROIL_READER, else beside the
// running program. False with a message when the path is too long.
bool isolate_set_reader(const char *program);
// Starts the reader and, without waiting, lets it get ready for a kind of job: the first shader
// costs 100 ms without, the first volume 60.
void isolate_warm_up(const char *kind);

// ---- the work, in a worker --------------------------------------------------------------------

typedef struct isolate_call isolate_call;
struct isolate_call {
    const char *name; // for messages
    const void *arguments;
    size_t argument_size;
    const void *bytes; // the input, and a zero byte
    size_t size;
    int out, channel; // -1 without
    // Reads a whole file of at most `max` bytes, which is opened on the other side; free `*data`
    // with mem_free. False when it may not be read, with a message.
    bool (*ask)(const isolate_call *call, const char *name, size_t max, void **data, size_t *size);
};

bool isolate_put(const isolate_call *call, const void *data, size_t size); // adds to the result
// Instead, without a copy: `size` bytes of the result from `at` on, zeroed if they are new; `at` is
// a multiple of the page's size. NULL with a message. munmap ends it.
void *isolate_map(const isolate_call *call, size_t at, size_t size);
bool isolate_cut(const isolate_call *call, size_t size); // the result has so many bytes
