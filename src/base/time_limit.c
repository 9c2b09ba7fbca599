// Each thread has one pointer to its limit. Only the thread that entered the limit writes `used`
// and `start`, and not while other threads work for it.
#include "base/time_limit.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/memory.h"
#include <math.h>
#include <stdio.h>
#include <time.h>

static _Thread_local time_limit *current;

time_limit *time_limit_enter(time_limit *b) {
    time_limit *before = current;
    if (before) return before;
    b->start = clock_seconds();
    current = b;
    return NULL;
}

void time_limit_leave(time_limit *before) {
    if (before || !current) return;
    current->used += clock_seconds() - current->start;
    current = NULL;
}

time_limit *time_limit_now(void) {
    return current;
}

void time_limit_adopt(time_limit *b) {
    current = b;
}

double time_limit_left(void) {
    const time_limit *b = current;
    if (mem_is_short()) return 0;
    if (!b) return (double)INFINITY;
    if (atomic_load_explicit(&b->stopped, memory_order_relaxed)) return 0;
    double others = (double)atomic_load_explicit(&b->others, memory_order_relaxed) * 1e-9;
    double wall = b->limit - b->used - (clock_seconds() - b->start);
    return fmax(fmin(wall, TIME_LIMIT_PROCESSORS * b->limit - others), 0);
}

void time_limit_charge(double processor_seconds) {
    if (current && processor_seconds > 0)
        atomic_fetch_add(&current->others, (uint64_t)(processor_seconds * 1e9));
}

double time_limit_thread_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

void time_limit_tell(char *out, size_t size) {
    if (mem_is_short())
        snprintf(out, size, "out of memory");
    else if (!current || atomic_load(&current->stopped))
        snprintf(out, size, "given up: nobody waits for it any more");
    else
        snprintf(out, size,
                 "time limit of %g s for a %s exceeded; --time-limit gives more (roil_desc)",
                 current->limit, current->what);
}

bool time_limit_check(void) {
    char text[160];
    if (time_limit_left() > 0) return true;
    time_limit_tell(text, sizeof text);
    return err_set("%s", text);
}

bool time_limit_progress(double done, double whole) {
    return time_limit_check() &&
           (!current || !current->progress || current->progress(current->user, done, whole) ||
            err_set("stopped after %.0f of %.0f", done, whole));
}

void time_limit_stop(time_limit *b) {
    atomic_store(&b->stopped, true);
}
