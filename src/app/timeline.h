// The time of the live window: which frame is shown, and how it moves on. Knows no window.
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct timeline {
    double fps;
    double first, last; // frames of the effect, both shown
    double from, to;    // the range that is looped or stopped at; inside of first..last
    double frame;       // current; whole unless `smooth`
    double speed;       // 1: the effect's own; negative: backwards
    double owed;        // part of a frame that has passed and is not shown yet
    bool playing, loop;
    bool every; // shows every frame, however long each takes; else frames are left out to keep time
    bool smooth; // shows times between frames, as often as the window is drawn
} timeline;

void timeline_init(timeline *t, double fps, double first, double frames);
// A reload may change it: what still fits is kept.
void timeline_set_range(timeline *t, double fps, double first, double frames);
// `seconds` of the clock have passed. True when the frame changed. At the end of the range it
// starts again, or stops when it does not loop.
bool timeline_advance(timeline *t, double seconds);
void timeline_seek(timeline *t, double frame);               // clamped to first..last
void timeline_step(timeline *t, int frames);                 // pauses
void timeline_set_loop(timeline *t, double from, double to); // ordered and clamped
double timeline_seconds(const timeline *t);                  // effect time of the current frame
