// Edits of a curve's keys, and the ranges of its plot. Needs no window.
#pragma once
#include "roil.h"

// Adds a key and returns its index; ROIL_MAX_STOPS when there is no room.
size_t curve_keys_add(roil_curve *c, float time, const float value[4]);
bool curve_keys_remove(roil_curve *c, size_t index);           // false: it is the last one
void curve_keys_move(roil_curve *c, size_t index, float time); // stops before its neighbours

typedef struct plot_range {
    float low, high;
} plot_range;
// Returns a range that encloses the values with a margin. It is never empty.
plot_range plot_range_of(const float *values, size_t count);
// Returns a step of 1, 2 or 5 times a power of ten that divides the range into at most `count`
// parts.
float plot_step(plot_range range, int count);
// Clamps a value to the range and rounds it to the precision that is visible in its plot.
float plot_round(plot_range range, float value);
