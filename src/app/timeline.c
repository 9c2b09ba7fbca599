#include "app/timeline.h"
#include <math.h>

static double clamped(double v, double low, double high) {
    return v < low ? low : v > high ? high : v;
}

void timeline_init(timeline *t, double fps, double first, double frames) {
    *t = (timeline){.speed = 1, .loop = true, .frame = first};
    timeline_set_range(t, fps, first, frames);
}

void timeline_set_range(timeline *t, double fps, double first, double frames) {
    double last = first + fmax(frames, 1) - 1;
    bool whole = t->from <= t->first && t->to >= t->last; // all of it was played: so it is again
    t->fps = fps > 0 ? fps : 1;
    t->first = first;
    t->last = last;
    timeline_set_loop(t, whole ? first : t->from, whole ? last : t->to);
    double frame = clamped(t->frame, first, last);
    if (frame != t->frame) timeline_seek(t, frame);
}

void timeline_set_loop(timeline *t, double from, double to) {
    double low = fmin(from, to), high = fmax(from, to);
    t->from = clamped(round(low), t->first, t->last);
    t->to = clamped(round(high), t->from, t->last);
}

void timeline_seek(timeline *t, double frame) {
    t->frame = clamped(t->smooth ? frame : round(frame), t->first, t->last);
    t->owed = 0;
}

void timeline_step(timeline *t, int frames) {
    t->playing = false;
    t->frame = clamped(round(t->frame) + frames, t->first, t->last);
    t->owed = 0;
}

// Takes the whole frames from those that have passed; the rest stays for later.
static double take_owed(timeline *t) {
    if (t->smooth) {
        double all = t->owed;
        t->owed = 0;
        return all;
    }
    double whole = trunc(t->owed);
    t->owed -= whole;
    if (t->every) return clamped(whole, -1, 1); // what is late is forgiven
    return whole;
}

// Beyond one end of the range, time continues at the other: frame `from` follows `to`. Times
// between frames end at `to`, since nothing follows the last frame.
static double wrapped(const timeline *t, double frame, bool backwards) {
    double period = t->smooth ? t->to - t->from : t->to - t->from + 1;
    if (!(period > 0)) return t->from;
    if (!backwards && frame > t->to) return t->from + fmod(frame - t->from, period);
    if (backwards && frame < t->from) return t->to - fmod(t->to - frame, period);
    return frame;
}

bool timeline_advance(timeline *t, double seconds) {
    if (!t->playing || !(seconds > 0) || !isfinite(seconds)) return false;
    double before = t->frame;
    if (!t->smooth) t->frame = round(t->frame);
    t->owed += seconds * t->fps * t->speed;
    double step = take_owed(t);
    if (step == 0) return t->frame != before;
    bool backwards = step < 0;
    double start = backwards ? t->to : t->from, end = backwards ? t->from : t->to;
    double next = t->frame + step;
    bool reached = backwards ? next <= end : next >= end;
    if (t->loop) {
        t->frame = wrapped(t, next, backwards);
    } else if (t->frame == end && start != end) { // it was started again where it had stopped
        t->frame = start;
    } else if (reached) {
        t->frame = end;
        t->playing = false;
        t->owed = 0;
    } else {
        t->frame = next;
    }
    t->frame = clamped(t->frame, t->first, t->last);
    return t->frame != before;
}

double timeline_seconds(const timeline *t) {
    return (t->frame - t->first) / t->fps;
}
