// The clock of what goes on from frame to frame in steps, each a fixed part of a second, whatever
// is drawn. The state stands a step ahead: the time of a picture lies between the states that the
// last two steps left behind, and is a mixture of these.
#pragma once
#include "gpu/profile.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct pass_steps {
    double step;    // seconds
    double warm_up; // seconds before time 0
} pass_steps;

// The time at which step `step` begins.
double pass_steps_time(const pass_steps *s, uint64_t step);
// Steps that must be done for a time: two beyond the state before it, which leave that state and
// the one after it.
int64_t pass_steps_wanted(const pass_steps *s, double time);
// The latest time that so many steps show; -INFINITY: none yet.
double pass_steps_reached(const pass_steps *s, int64_t done);
// How the last two states are mixed for a time: 0 the earlier one, 1 the later.
double pass_steps_blend(const pass_steps *s, int64_t done, double time);
// Steps of one submit, where each takes as long as so many updates of a lattice's cells, or as long
// as its dispatches alone: about 0.1 s of a large device, half a second of a software one. `brief`:
// a part of that, so that a window stays awake.
int64_t pass_steps_most(double updates, const gpu_profile *device, bool brief);
