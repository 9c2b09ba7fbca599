// Edits of a curve's keys, and the ranges in which it is plotted. Knows no window.
#pragma once
#include "roil.h"

// Index of the new key; ROIL_MAX_STOPS when there is no room for it.
size_t curve_keys_add(roil_curve *c, float time, const float value[4]);
bool curve_keys_remove(roil_curve *c, size_t index);           // false: one stays
void curve_keys_move(roil_curve *c, size_t index, float time); // short of its neighbours

typedef struct plot_range {
    float low, high;
} plot_range;
// What encloses the values, with a margin; never empty.
plot_range plot_range_of(const float *values, size_t count);
// A step of 1, 2 or 5 times a power of ten that divides the range into at most `count` parts.
float plot_step(plot_range range, int count);
// As round as can be told apart in a plot of the range, and within it.
float plot_round(plot_range range, float value);
