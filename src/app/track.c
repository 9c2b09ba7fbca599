// Frames to pixels and back.
#include "app/track.h"
#include <math.h>

static const float BETWEEN_PIXELS = 5; // least, of the small ticks

static double span(const track *t) {
    return t->last > t->first ? t->last - t->first : 1;
}

static double pixels_per_frame(const track *t) {
    return (double)(t->right - t->left) / span(t);
}

float track_x(const track *t, double frame) {
    return t->left + (float)((frame - t->first) * pixels_per_frame(t));
}

double track_frame(const track *t, float x) {
    if (!(t->right > t->left)) return t->first;
    double frame = t->first + (double)(x - t->left) / pixels_per_frame(t);
    return fmin(fmax(frame, t->first), fmax(t->last, t->first));
}

track_ticks track_ticks_of(const track *t, float least) {
    double pixels = pixels_per_frame(t);
    if (!(pixels > 0)) return (track_ticks){span(t), 0};
    double power = 1, step = 1, between = 0;
    static const int steps[] = {1, 2, 5}, parts[] = {5, 2, 5}; // 10: in fives, as 20 in tens
    for (int i = 0;; i = (i + 1) % 3) {
        step = steps[i] * power;
        between = step / parts[i];
        if (step * pixels >= (double)least || step >= span(t)) break;
        if (i == 2) power *= 10;
    }
    bool fits = between >= 1 && between * pixels >= (double)BETWEEN_PIXELS;
    return (track_ticks){step, fits ? between : 0};
}
