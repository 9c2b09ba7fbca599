#include "pass/steps.h"
#include <math.h>

static const double most_updates = 2e9, most_in_software = 1.5e7;
static const double least_updates = 2e6, least_in_software = 2e4; // of a small lattice's step
static const double rounding = 1e-6;                              // of a step
enum { BRIEF = 64, BRIEF_IN_SOFTWARE = 20 };

static double steps_at(const pass_steps *s, double time) { // from the beginning, with a fraction
    return fmax((time + s->warm_up) / s->step, 0);
}

double pass_steps_time(const pass_steps *s, uint64_t step) {
    return (double)step * s->step - s->warm_up;
}

int64_t pass_steps_wanted(const pass_steps *s, double time) {
    return (int64_t)floor(steps_at(s, time) + rounding) + 2;
}

double pass_steps_reached(const pass_steps *s, int64_t done) {
    return done < 2 ? -(double)INFINITY : pass_steps_time(s, (uint64_t)done - 1);
}

double pass_steps_blend(const pass_steps *s, int64_t done, double time) {
    double blend = steps_at(s, time) - (double)(done - 2);
    return blend < rounding ? 0 : fmin(blend, 1);
}

int64_t pass_steps_most(double updates, bool software, bool brief) {
    double most = software ? most_in_software / fmax(updates, least_in_software)
                           : most_updates / fmax(updates, least_updates);
    if (brief) most /= software ? BRIEF_IN_SOFTWARE : BRIEF;
    return (int64_t)fmax(1, most);
}
