// When particles are born: a rate, carried on from step to step so that none is lost to rounding,
// and bursts. Each has its own moment within the step, so that the step is not seen in what is
// drawn.
#include "pass/particles/particles_parts.h"
#include <math.h>

static const double rounding = 1e-9;    // of a step, of a period
static const double most_births = 1e12; // of a step: beyond any that could be counted

// Bursts that begin within the step, and the seconds that are left of it then.
static double count_bursts(const particles_rates *r, double *rest) {
    double end = r->begin + r->step, slack = rounding * r->step, moment = r->burst_time;
    if (r->burst_period > 0 && moment < r->begin - slack)
        moment += r->burst_period * ceil((r->begin - slack - moment) / r->burst_period);
    if (moment < r->begin - slack || moment >= end - slack) return 0;
    *rest = fmin(end - moment, r->step);
    return r->burst_period > 0 ? 1 + floor((end - slack - moment) / r->burst_period) : 1;
}

static uint32_t at_most(double count, uint32_t most) {
    return count < most ? (uint32_t)count : most;
}

particles_births particles_next(particles_clock *clock, const particles_rates *rates,
                                uint32_t most) {
    particles_births out = {0};
    double bursts = fmin(count_bursts(rates, &out.burst_rest) * round(rates->burst), most_births);
    double owed = clock->owed + rates->rate * rates->step, steady = floor(owed);
    out.steady = at_most(steady, most);
    out.burst = at_most(bursts, most - out.steady);
    if (steady > 0) {
        out.every = 1 / rates->rate;
        double left_out = steady - out.steady;
        out.steady_rest = rates->step - (1 + left_out - clock->owed) * out.every;
    }
    out.first = clock->born + (uint64_t)(steady + bursts) - out.steady - out.burst;
    clock->born = out.first + out.steady + out.burst;
    clock->owed = owed - steady;
    clock->steps++;
    return out;
}
