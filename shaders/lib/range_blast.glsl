// Ranges of what a burst does (lib/blast.glsl): it is strongest, and arrives first, at the nearest
// point and by the largest charge. Twins in C: src/field/range_kinds.c.
#ifndef LIB_RANGE_BLAST_GLSL
#define LIB_RANGE_BLAST_GLSL
#include "lib/range_operator.glsl"
#include "lib/blast.glsl"

const float RANGE_BLAST = 1e-4; // of itself: what drivers make of powers, logarithms and exponents

// The greatest peak of the front, by what it is for 1 kg at that distance; below 0: it is nowhere yet.
float range_blast_peak(range3 p, range3 position, range1 age, range1 charge) {
    float scale = blast_scale(min(charge.high, RANGE_MOST)), near = range_length(range_sub(p, position)).low / scale;
    return age.high < scale * blast_front(near) * (1.0 - RANGE_BLAST) ? -1.0 : blast_excess(near) * (1.0 + RANGE_BLAST);
}

range1 range_blast_pressure(range3 p, range3 position, range1 age, range1 charge) {
    float peak = BLAST_AMBIENT * range_blast_peak(p, position, age, charge);
    return peak < 0.0 ? range1(0.0, 0.0) : range_make(-BLAST_SUCTION * peak, peak);
}

range3 range_blast_velocity(range3 p, range3 position, range1 age, range1 charge) {
    float peak = range_blast_peak(p, position, age, charge), fast = peak < 0.0 ? 0.0 : blast_speed(peak);
    return range_vec3(range_make(-fast, fast));
}

range1 range_blast_impulse(range3 p, range3 position, range1 charge) {
    range1 away = range_length(range_sub(p, position));
    float large = blast_scale(min(charge.high, RANGE_MOST)), small = blast_scale(charge.low);
    return range_make(small * blast_impulse(away.high / small) * (1.0 - RANGE_BLAST),
                      large * blast_impulse(away.low / large) * (1.0 + RANGE_BLAST));
}

range1 range_blast_arrival(range3 p, range3 position, range1 charge) {
    range1 away = range_length(range_sub(p, position));
    float large = blast_scale(min(charge.high, RANGE_MOST)), small = blast_scale(charge.low);
    return range_make(large * blast_front(away.low / large) * (1.0 - RANGE_BLAST),
                      away.high > RANGE_MOST ? RANGE_END : small * blast_front(away.high / small) * (1.0 + RANGE_BLAST));
}

#endif
