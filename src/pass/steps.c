#include "pass/steps.h"
#include <math.h>

static const double rounding = 1e-6; // of a step

static double steps_at(const pass_steps *s, double time) { // from the beginning, with a fraction
    return fmax((time + s->warm_up) / s->step, 0);
}

double pass_steps_time(const pass_steps *s, uint64_t step) {
    return (double)step * s->step - s->warm_up;
}

int64_t pass_steps_wanted(const pass_steps *s, double time) {
    return (int64_t)floor(steps_at(s, time) + rounding) + 1 + s->late;
}

double pass_steps_reached(const pass_steps *s, int64_t done) {
    return done <= s->late ? -(double)INFINITY : pass_steps_time(s, (uint64_t)(done - s->late));
}

double pass_steps_blend(const pass_steps *s, int64_t done, double time) {
    double blend = steps_at(s, time) - (double)(done - 1 - s->late);
    return blend < rounding ? 0 : fmin(blend, 1);
}

int64_t pass_steps_most(double updates, const gpu_profile *device, bool brief) {
    double most = device->lattice_updates / fmax(updates, device->least_updates);
    if (brief) most /= device->brief_updates;
    return (int64_t)fmax(1, most);
}
