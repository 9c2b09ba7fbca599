// Progress and the time left: a line that is redrawn on a terminal, else a line from time to time.
#include "app/app.h"
#include "base/clock.h"
#include <math.h>
#include <stdio.h>
#include <unistd.h>

enum { BAR_WIDTH = 24 };
static const double TERMINAL_SECONDS = 0.1, FILE_SECONDS = 5;

void app_progress_begin(app_progress *p, size_t total, const char *unit) {
    *p = (app_progress){
        .start = clock_seconds(), .total = total, .unit = unit, .terminal = isatty(2) == 1};
}

// "[#####-----] "
static void print_bar(double part) {
    char bar[BAR_WIDTH + 1];
    for (int i = 0; i < BAR_WIDTH; i++) bar[i] = i < part * BAR_WIDTH ? '#' : '-';
    bar[BAR_WIDTH] = '\0';
    fprintf(stderr, "\r[%s] ", bar);
}

void app_progress_step(app_progress *p, size_t done) {
    double now = clock_seconds();
    if (now - p->printed < (p->terminal ? TERMINAL_SECONDS : FILE_SECONDS) && done != p->total)
        return;
    p->printed = now;
    if (p->terminal) print_bar((double)done / (double)p->total);
    fprintf(stderr, "%zu of %zu %s", done, p->total, p->unit);
    if (done > 0) {
        double each = (now - p->start) / (double)done;
        long left = lround(each * (double)(p->total - done));
        if (each < 0.01)
            fprintf(stderr, ", %.0f a second", 1 / each);
        else
            fprintf(stderr, ", %.2f s each", each);
        fprintf(stderr, ", %ld:%02ld left", left / 60, left % 60);
    }
    fputs(p->terminal ? "\033[K" : "\n", stderr);
}

void app_progress_clear(app_progress *p) {
    if (p->terminal) fputs("\r\033[K", stderr);
    p->printed = 0;
}

void app_progress_end(app_progress *p) {
    if (p->terminal) fputc('\n', stderr);
}

static bool progress_report(app_progress *p, double done, double whole, const char *unit) {
    if (p->total != (size_t)whole) {
        app_progress_begin(p, (size_t)whole, unit);
        p->printed = p->start;
    }
    bool shown = p->printed > p->start; // what is done at once needs no words
    if (done < whole || shown) app_progress_step(p, (size_t)done);
    if (done >= whole) *p = (app_progress){0};
    return !app_is_interrupted(NULL);
}

bool app_tell_steps(void *user, double done, double whole) {
    return progress_report(user, done, whole, "steps");
}

bool app_tell_files(void *user, double done, double whole) {
    return progress_report(user, done, whole, "files");
}

bool app_tell_frames(void *user, double done, double whole) {
    return progress_report(user, done, whole, "frames");
}
