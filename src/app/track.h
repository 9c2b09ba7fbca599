// Where frames lie on the bar of time. Knows no window.
#pragma once
#include <stdbool.h>

typedef struct track {
    double first, last; // frames
    float left, right;  // pixels, where they lie
} track;

float track_x(const track *t, double frame);
double track_frame(const track *t, float x); // clamped to first..last

// Frames from one tick to the next, a 1, 2 or 5 times a power of ten, so that ticks are at least
// `least` pixels apart; and those between them, 0 when there is no room for any.
typedef struct track_ticks {
    double step, between;
} track_ticks;
track_ticks track_ticks_of(const track *t, float least);

bool track_near(const track *t, double frame, float x, float reach); // pixels
