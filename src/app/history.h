// Times of the last frames, pass by pass, in a ring buffer. Needs no window.
#pragma once
#include "roil.h"

enum { HISTORY_FRAMES = 240, HISTORY_RECENT = 60, HISTORY_PASSES = 256 };

typedef struct history_pass {
    char name[64];
    uint64_t last;            // the frame in which it ran last; 0: this place is free
    size_t order;             // index among the passes of that frame
    float ms[HISTORY_FRAMES]; // negative where it did not run
} history_pass;

typedef struct history_frame {
    float gpu, cpu, interval; // milliseconds; gpu: sum of the passes
} history_frame;

typedef struct history { // zero at first; a quarter of a megabyte
    uint64_t count;      // frames that were ever added
    history_frame frames[HISTORY_FRAMES];
    history_pass passes[HISTORY_PASSES]; // a pass never changes its place
} history;

// Adds a frame. `cpu` and `interval` are seconds. Times with the same name are added up.
void history_add(history *h, const roil_time *times, size_t count, double cpu, double interval);
size_t history_length(const history *h); // frames that are kept

// `ago`: 0 is the newest frame, less than history_length.
const history_frame *history_get(const history *h, size_t ago);
float history_pass_ms(const history *h, size_t pass, size_t ago); // negative: it did not run
// Lists the passes that ran in the frame, in their order. Returns how many there are.
size_t history_list(const history *h, size_t ago, size_t out[HISTORY_PASSES]);

// Medians over the last HISTORY_RECENT frames, in milliseconds.
float history_pass_median(const history *h, size_t pass); // of those in which it ran
history_frame history_median(const history *h);           // zeros when there is no frame
double history_rate(const history *h);                    // frames per second; 0: unknown
float history_peak(const history *h);                     // greatest GPU time of all
