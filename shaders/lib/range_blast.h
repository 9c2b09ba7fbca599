// Ranges of lib/blast.h: a burst is strongest, and arrives first, at the nearest point and by the largest
// charge. C compiles this text too (src/field/glsl.h).
#ifndef LIB_RANGE_BLAST_H
#define LIB_RANGE_BLAST_H
#include "lib/blast.h"
#include "lib/range.h"

#define RANGE_BLAST 1e-4f // of itself: what drivers make of powers, logarithms and exponents

// The greatest peak of the front, by what it is for 1 kg at that distance; below 0: it is nowhere yet.
SHARED float range_blast_peak(range1 away, range1 age, range1 charge) {
    float scale = blast_scale(min(charge.high, RANGE_MOST)), near = away.low / scale;
    bool nowhere = age.high < scale * blast_front(near) * (1.0f - RANGE_BLAST);
    return nowhere ? -1.0f : blast_excess(near) * (1.0f + RANGE_BLAST);
}

SHARED range1 range_blast_pressure(range1 away, range1 age, range1 charge) {
    float peak = BLAST_AMBIENT * range_blast_peak(away, age, charge);
    return peak < 0.0f ? range1(0.0f, 0.0f) : range_make(-BLAST_SUCTION * peak, peak);
}

// Of each component.
SHARED range1 range_blast_velocity(range1 away, range1 age, range1 charge) {
    float peak = range_blast_peak(away, age, charge), fast = peak < 0.0f ? 0.0f : blast_speed(peak);
    return range_make(-fast, fast);
}

SHARED range1 range_blast_impulse(range1 away, range1 charge) {
    return range_make(blast_impulse(away.high, charge.low) * (1.0f - RANGE_BLAST),
                      blast_impulse(away.low, min(charge.high, RANGE_MOST)) * (1.0f + RANGE_BLAST));
}

SHARED range1 range_blast_arrival(range1 away, range1 charge) {
    float last = blast_arrival(away.high, charge.low) * (1.0f + RANGE_BLAST);
    return range_make(blast_arrival(away.low, min(charge.high, RANGE_MOST)) * (1.0f - RANGE_BLAST),
                      away.high > RANGE_MOST ? RANGE_END : last);
}

#endif
