// glslang in a process of its own, so that no shader can crash, stall or exhaust this one. GLSL
// comes from strangers, and twenty lines of it, macros that double each other, keep glslang busy
// for years or eat all memory; others crash it.
//
//   this process (isolate.c)         server (server.c)            worker (server.c)
//   paper: a memory file
//   with the source  ------------->  fork ----------------------> limits, compile,
//   and a pipe, over a socket        wait for the worker          rehearse the reflection,
//   wait for the pipe    <---------  its exit status <----------- answer, onto the paper
//
// A worker that was killed has left on the paper what the C++ runtime said (its stderr) instead.
// Reflecting the code is this process's work, but a worker has done just that before: what ended
// there ends here. All this guards against faults, not against code that takes over a worker.
//
// Workers are not forked from this process but from a server that was forked from it once, early:
// - A fork costs 0.1 ms for each MB in use, and as much again when pages are then written. The
//   server holds glslang's tables and little else. A compile costs 3 ms more than one in process.
// - After a fork from many threads, locks that other threads held stay locked for ever. The
//   server has one thread, so its workers are sound. Should the server itself be caught, its alarm
//   ends it and another one is forked.
// - This process sees one child that ends when it does, whatever is compiled.
//
// Private to src/shader.
#pragma once
#include "shader/unit.h"

// Compiles with limits of time and memory. False with "the compiler ran out of time (10 s)" and
// the like, without a position; true when the compiler gave an answer, which may be a refusal.
// Free the answer's data with mem_free. Any thread may call this.
bool isolate_compile(const char *source, shader_stage stage, glsl_answer *out);

// Of one compile: processor time, and memory beyond the server's. Tests set less.
enum { ISOLATE_MILLISECONDS = 10000, ISOLATE_MEGABYTES = 1024 };
void isolate_set_limits(uint32_t milliseconds, uint32_t megabytes);

// ---- between the processes --------------------------------------------------------------------

enum {
    ISOLATE_PATIENCE = 10,  // seconds of real time beyond thrice the processor time: other
                            // programs may keep the machine busy
    ISOLATE_WARM_UP = 30,   // seconds, after which the server gives itself up
    ISOLATE_NO_WORKER = -1, // in place of a status: fork failed
};

typedef struct isolate_request { // the socket carries it, with two files: paper and pipe
    shader_stage stage;
    uint32_t milliseconds, megabytes;
    size_t length; // of the source on the paper; a zero byte and the answer follow
} isolate_request;

typedef struct isolate_answer { // then `size` bytes
    glsl_outcome outcome;
    size_t size;
} isolate_answer;

_Noreturn void isolate_serve(int control);             // the socket
uint64_t isolate_real_limit(const isolate_request *r); // milliseconds
bool isolate_write(int file, const void *data, size_t size);
