// The time of the live window: which frame is shown, and how it advances. Needs no window.
#pragma once
#include <stdbool.h>

typedef struct timeline {
    double fps;
    double first, last; // frames of the effect, both shown
    double from, to;    // range that is played, within first to last
    double frame;       // current frame; an integer unless `smooth`
    double speed;       // 1: the effect's own; negative: backwards
    double owed;        // frames that have passed and were not shown yet
    bool playing, loop;
    bool every;  // shows every frame, however long it takes; else frames are skipped to keep time
    bool smooth; // shows times between frames, as often as the window is drawn
} timeline;

void timeline_init(timeline *t, double fps, double first, double frames);
// Sets the range after a reload, and keeps what still fits.
void timeline_set_range(timeline *t, double fps, double first, double frames);
// Advances by `seconds` of the clock. True when the frame changed. At the end of the range it loops
// or stops.
bool timeline_advance(timeline *t, double seconds);
void timeline_seek(timeline *t, double frame);               // clamped to first to last
void timeline_step(timeline *t, int frames);                 // pauses
void timeline_set_loop(timeline *t, double from, double to); // ordered and clamped
double timeline_seconds(const timeline *t);                  // effect time of the current frame
