// What a burst of TNT does to the air around: fields of shaders/lib/blast.h.
#include "field/kinds.h"
#include <math.h>

static float away_from(const float centre[4], float3 p, float way[3]) {
    way[0] = p.x - centre[0];
    way[1] = p.y - centre[1];
    way[2] = p.z - centre[2];
    return sqrtf(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
}

void eval_blast_pressure(const field_point *at, const float (*a)[4], float out[4]) {
    float way[3];
    out[0] = blast_pressure(away_from(a[0], at->p, way), a[1][0], a[2][0]);
}

void eval_blast_velocity(const field_point *at, const float (*a)[4], float out[4]) {
    float way[3];
    const float away = away_from(a[0], at->p, way), fast = blast_velocity(away, a[1][0], a[2][0]);
    for (int i = 0; i < 3; i++) out[i] = fast / fmaxf(away, 1e-20f) * way[i];
}

void eval_blast_impulse(const field_point *at, const float (*a)[4], float out[4]) {
    float way[3];
    out[0] = blast_impulse(away_from(a[0], at->p, way), a[1][0]);
}

void eval_blast_arrival(const field_point *at, const float (*a)[4], float out[4]) {
    float way[3];
    out[0] = blast_arrival(away_from(a[0], at->p, way), a[1][0]);
}
