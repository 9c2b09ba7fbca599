// Progress with time left: one line that renews itself on a terminal, else a line now and then.
#include "app/app.h"
#include "base/clock.h"
#include <math.h>
#include <stdio.h>
#include <unistd.h>

static const double TERMINAL_SECONDS = 0.1, FILE_SECONDS = 5;

void app_progress_begin(app_progress *p, size_t total, const char *unit) {
    *p = (app_progress){
        .start = clock_seconds(), .total = total, .unit = unit, .terminal = isatty(2) == 1};
}

void app_progress_step(app_progress *p, size_t done) {
    double now = clock_seconds();
    if (now - p->printed < (p->terminal ? TERMINAL_SECONDS : FILE_SECONDS) && done != p->total)
        return;
    p->printed = now;
    double each = (now - p->start) / (double)done;
    long left = lround(each * (double)(p->total - done));
    fprintf(stderr, "%s  %zu of %zu %s, %.2f s each, %ld:%02ld left %s", p->terminal ? "\r" : "",
            done, p->total, p->unit, each, left / 60, left % 60, p->terminal ? "   " : "\n");
}

void app_progress_end(app_progress *p) {
    if (p->terminal) fputc('\n', stderr);
}
