// Time that a load, or a frame, may take: by the clock, and of the processors that work for it in
// other threads and processes. A budget is entered by the thread that works; worker_each hands it
// on to its threads. Whoever works long asks what is left: scripts (script/vm.c) and those who wait
// for child processes, which also charge what a child used.
//
// A budget runs only while it is entered: what a device does between two calls of a script counts
// for neither.
#pragma once
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    TIME_LIMIT_LOAD_SECONDS = 120,
    TIME_LIMIT_FRAMES = 10,    // a frame gets this part of what a load gets
    TIME_LIMIT_PROCESSORS = 8, // seconds of other processors for each by the clock
};

typedef struct time_limit {
    const char *what;        // "load", "frame"
    double limit;            // seconds
    double used, start;      // by the clock: of times that ended, and when this one began
    _Atomic uint64_t others; // nanoseconds of other threads and processes
    atomic_bool stopped;
    // Is told by the thread that works of work that is done in parts; false: it is not wanted any
    // more. May be NULL.
    bool (*progress)(void *user, double done, double whole);
    void *user;
} time_limit;

// For the calling thread. Within another budget it changes nothing: that goes on. The result is for
// time_limit_leave.
time_limit *time_limit_enter(time_limit *b);
void time_limit_leave(time_limit *before);

// The calling thread's; NULL: none, and no limit.
time_limit *time_limit_now(void);
void time_limit_adopt(time_limit *b); // for a thread that works for another one; NULL: no more

double time_limit_left(void); // seconds; INFINITY: no budget
void time_limit_charge(double processor_seconds);
double time_limit_thread_seconds(void); // of the processor, by the calling thread so far
bool time_limit_check(void);            // false with a message when nothing is left
// The same where work is done in `whole` parts, of which so many are done: whoever waits is told.
bool time_limit_progress(double done, double whole);
void time_limit_tell(char *out, size_t size); // that message
void time_limit_stop(time_limit *b);          // by any thread: nothing is left
