// Limits on the time that a load or a frame may take: by the clock, and of the processors that work
// for it in other threads and processes. The working thread enters a limit; worker_each passes it
// on to its threads. Code that runs for long asks how much is left: scripts do (script/vm.c), and
// so does code that waits for a child process, which also charges the time that the child used.
//
// Time counts only while the limit is entered. What a device does between two calls of a script
// counts for neither.
#pragma once
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    TIME_LIMIT_LOAD_SECONDS = 120,
    TIME_LIMIT_FRAMES = 10,    // a frame gets one part in so many of what a load gets
    TIME_LIMIT_PROCESSORS = 8, // seconds of other processors for each second by the clock
};

typedef struct time_limit {
    const char *what;        // "load", "frame"
    double limit;            // seconds
    double used, start;      // by the clock: seconds of earlier entries; start of this one
    _Atomic uint64_t others; // nanoseconds of other threads and processes
    atomic_bool stopped;     // by time_limit_stop
    // Called on the working thread with the parts of the work that are done and the whole.
    // Returning false cancels the work. May be NULL.
    bool (*progress)(void *user, double done, double whole);
    void *user; // passed to progress
} time_limit;

// Enters a limit on the calling thread. Within another limit nothing changes: that one continues.
// Pass the result to time_limit_leave.
time_limit *time_limit_enter(time_limit *b);
void time_limit_leave(time_limit *before);

// Returns the calling thread's limit; NULL: it has none.
time_limit *time_limit_now(void);
void time_limit_adopt(time_limit *b); // makes a thread work under another's limit; NULL: ends that

double time_limit_left(void); // seconds; INFINITY: no limit; 0 also when memory is short
void time_limit_charge(double processor_seconds); // adds time of another thread or process
double time_limit_thread_seconds(void);           // processor time of the calling thread so far
bool time_limit_check(void);                      // false with a message when no time is left
// Checks the limit and reports progress: `done` of `whole` parts.
bool time_limit_progress(double done, double whole);
void time_limit_tell(char *out, size_t size); // writes the message of time_limit_check
void time_limit_stop(time_limit *b);          // leaves no time; any thread
