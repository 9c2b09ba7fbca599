// Positions of frames on the timeline's bar. Needs no window.
#pragma once
#include <stdbool.h>

typedef struct track {
    double first, last; // frames
    float left, right;  // their positions, pixels
} track;

float track_x(const track *t, double frame);
double track_frame(const track *t, float x); // clamped to first..last

typedef struct track_ticks {
    double step, between; // frames between two ticks, and between two small ones; 0: none of these
} track_ticks;
// Chooses steps of 1, 2 or 5 times a power of ten, so that ticks are at least `least` pixels apart.
track_ticks track_ticks_of(const track *t, float least);
