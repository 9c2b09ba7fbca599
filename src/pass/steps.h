// The clock of what goes on from frame to frame in steps, each a fixed part of a second, whatever
// is drawn. The state stands ahead of the picture, which is a mixture of the two states that were
// written to images last: its time lies between theirs.
#pragma once
#include "gpu/profile.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct pass_steps {
    double step;    // seconds
    double warm_up; // seconds before time 0
    int64_t late;   // 1: a step writes images of the state before it (lbm); 0: of the one after it
} pass_steps;

// The time at which step `step` begins.
double pass_steps_time(const pass_steps *s, uint64_t step);
// Steps that must be done for a time: until there are images of the state after it.
int64_t pass_steps_wanted(const pass_steps *s, double time);
// The latest time that so many steps show; -INFINITY: none yet.
double pass_steps_reached(const pass_steps *s, int64_t done);
// How the two states are mixed for a time: 0 the earlier one, 1 the later.
double pass_steps_blend(const pass_steps *s, int64_t done, double time);
// Steps of one submit, where each takes as long as so many updates of a lattice's cells, or as long
// as its dispatches alone: about 0.1 s of a large device, half a second of a software one. `brief`:
// a part of that, so that a window stays awake.
int64_t pass_steps_most(double updates, const gpu_profile *device, bool brief);
