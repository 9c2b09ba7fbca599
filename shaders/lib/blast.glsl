// Fields of lib/blast.h around a position.
#ifndef LIB_BLAST_GLSL
#define LIB_BLAST_GLSL
#include "lib/blast.h"

float blast_pressure(vec3 p, vec3 position, float age, float charge) {
    return blast_pressure(length(p - position), age, charge);
}

vec3 blast_velocity(vec3 p, vec3 position, float age, float charge) {
    float away = length(p - position);
    return blast_velocity(away, age, charge) / max(away, 1e-20) * (p - position);
}

float blast_impulse(vec3 p, vec3 position, float charge) {
    return blast_impulse(length(p - position), charge);
}

float blast_arrival(vec3 p, vec3 position, float charge) {
    return blast_arrival(length(p - position), charge);
}

#endif
