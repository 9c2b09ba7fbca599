// A ring buffer of times. A pass keeps its place while any of its frames is in the buffer, so that
// its curve survives a reload and another pass does not continue it.
#include "app/history.h"
#include "base/str.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const float ABSENT = -1;

static size_t slot_of(uint64_t frame) { // frames count from 1
    return (size_t)(frame % HISTORY_FRAMES);
}

static uint64_t frame_ago(const history *h, size_t ago) {
    return h->count - ago;
}

size_t history_length(const history *h) {
    return h->count < HISTORY_FRAMES ? (size_t)h->count : HISTORY_FRAMES;
}

// ---- adding -----------------------------------------------------------------------------------

// Returns the pass's place, else a free one, else that of the pass that has not run for longest.
static history_pass *place_of(history *h, const char *name) {
    history_pass *oldest = h->passes;
    for (size_t i = 0; i < HISTORY_PASSES; i++) {
        history_pass *p = &h->passes[i];
        if (p->last && strcmp(p->name, name) == 0) return p;
        if (p->last < oldest->last) oldest = p;
    }
    str_copy(oldest->name, sizeof oldest->name, name);
    for (size_t i = 0; i < HISTORY_FRAMES; i++) oldest->ms[i] = ABSENT;
    return oldest;
}

void history_add(history *h, const roil_time *times, size_t count, double cpu, double interval) {
    uint64_t frame = ++h->count;
    size_t slot = slot_of(frame);
    if (count > HISTORY_PASSES) count = HISTORY_PASSES;
    for (size_t i = 0; i < HISTORY_PASSES; i++) h->passes[i].ms[slot] = ABSENT;
    double gpu = 0;
    for (size_t i = 0; i < count; i++) {
        history_pass *p = place_of(h, times[i].pass);
        float ms = (float)times[i].milliseconds;
        if (p->last == frame) {
            p->ms[slot] += ms;
        } else {
            p->ms[slot] = ms;
            p->last = frame;
            p->order = i;
        }
        gpu += times[i].milliseconds;
    }
    h->frames[slot] = (history_frame){(float)gpu, (float)(cpu * 1000), (float)(interval * 1000)};
}

// ---- asking -----------------------------------------------------------------------------------

const history_frame *history_get(const history *h, size_t ago) {
    return &h->frames[slot_of(frame_ago(h, ago))];
}

float history_pass_ms(const history *h, size_t pass, size_t ago) {
    const history_pass *p = &h->passes[pass];
    return p->last ? p->ms[slot_of(frame_ago(h, ago))] : ABSENT;
}

size_t history_list(const history *h, size_t ago, size_t out[HISTORY_PASSES]) {
    size_t count = 0;
    for (size_t i = 0; i < HISTORY_PASSES; i++) {
        if (history_pass_ms(h, i, ago) < 0) continue;
        size_t at = count++;
        for (; at > 0 && h->passes[out[at - 1]].order > h->passes[i].order; at--)
            out[at] = out[at - 1];
        out[at] = i;
    }
    return count;
}

// ---- medians ----------------------------------------------------------------------------------

static int compare_entries(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static float median(float *values, size_t count) {
    if (count == 0) return 0;
    qsort(values, count, sizeof *values, compare_entries);
    return count % 2 ? values[count / 2] : 0.5f * (values[count / 2 - 1] + values[count / 2]);
}

static size_t recent(const history *h) {
    size_t length = history_length(h);
    return length < HISTORY_RECENT ? length : HISTORY_RECENT;
}

float history_pass_median(const history *h, size_t pass) {
    float values[HISTORY_RECENT];
    size_t count = 0, length = recent(h);
    for (size_t ago = 0; ago < length; ago++) {
        float ms = history_pass_ms(h, pass, ago);
        if (ms >= 0) values[count++] = ms;
    }
    return median(values, count);
}

history_frame history_median(const history *h) {
    float gpu[HISTORY_RECENT], cpu[HISTORY_RECENT], interval[HISTORY_RECENT];
    size_t length = recent(h);
    for (size_t ago = 0; ago < length; ago++) {
        const history_frame *f = history_get(h, ago);
        gpu[ago] = f->gpu;
        cpu[ago] = f->cpu;
        interval[ago] = f->interval;
    }
    return (history_frame){median(gpu, length), median(cpu, length), median(interval, length)};
}

double history_rate(const history *h) {
    float interval = history_median(h).interval;
    return interval > 0 ? 1000 / (double)interval : 0;
}

float history_peak(const history *h) {
    float peak = 0;
    size_t length = history_length(h);
    for (size_t ago = 0; ago < length; ago++) peak = fmaxf(peak, history_get(h, ago)->gpu);
    return peak;
}
