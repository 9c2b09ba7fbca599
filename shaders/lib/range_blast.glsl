// Ranges of lib/blast.glsl, by those of lib/range_blast.h.
#ifndef LIB_RANGE_BLAST_GLSL
#define LIB_RANGE_BLAST_GLSL
#include "lib/range_blast.h"
#include "lib/range_operator.glsl"
#include "lib/blast.glsl"

range1 range_blast_pressure(range3 p, range3 position, range1 age, range1 charge) {
    return range_blast_pressure(range_length(range_sub(p, position)), age, charge);
}

range3 range_blast_velocity(range3 p, range3 position, range1 age, range1 charge) {
    return range_vec3(range_blast_velocity(range_length(range_sub(p, position)), age, charge));
}

range1 range_blast_impulse(range3 p, range3 position, range1 charge) {
    return range_blast_impulse(range_length(range_sub(p, position)), charge);
}

range1 range_blast_arrival(range3 p, range3 position, range1 charge) {
    return range_blast_arrival(range_length(range_sub(p, position)), charge);
}

#endif
