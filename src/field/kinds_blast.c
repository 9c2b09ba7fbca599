// What a burst of TNT does to the air around: the twin of shaders/lib/blast.glsl, which has the
// papers.
#include "field/kinds.h"
#include <math.h>

static const float ambient = 101325, sound = 340.3f, surface = 0.053f, farthest = 1e6f,
                   least = 1e-6f;

float blast_excess(float z) {
    const float near = clampf(z, surface, farthest);
    const float a = near / 4.5f, b = near / 0.048f, c = near / 0.32f, d = near / 1.35f;
    return 808 * (1 + a * a) / (sqrtf(1 + b * b) * sqrtf(1 + c * c) * sqrtf(1 + d * d));
}

float blast_impulse(float z) {
    const float near = clampf(z, surface, farthest), a = near / 0.23f, b = near / 1.55f;
    return 6.7f * sqrtf(1 + a * a * a * a) / (near * near * powf(1 + b * b * b, 1.0f / 3));
}

static float mach(float excess) {
    return sqrtf(1 + 6.0f / 7 * excess);
}

float blast_speed(float excess) {
    return 5.0f / 7 * sound * excess / mach(excess);
}

float blast_front(float z) {
    static const float places[] = {0.18343464f, 0.52553241f, 0.79666648f, 0.96028986f};
    static const float weights[] = {0.36268378f, 0.31370665f, 0.22238103f, 0.10122854f};
    if (z <= surface) return z / (sound * mach(blast_excess(z)));
    const float from = logf(surface), half = 0.5f * (logf(z) - from), middle = from + half;
    float sum = 0;
    for (int i = 0; i < 4; i++) {
        const float a = expf(middle - half * places[i]), b = expf(middle + half * places[i]);
        sum += weights[i] * (a / mach(blast_excess(a)) + b / mach(blast_excess(b)));
    }
    return (half * sum + surface / mach(blast_excess(surface))) / sound;
}

float blast_scale(float charge) {
    return powf(fmaxf(charge, least), 1.0f / 3);
}

static float pulse(float z, float age, float excess) {
    const float after = age - blast_front(z);
    const float lasts = 2.7182818f * blast_impulse(z) / (ambient * excess),
                t = fminf(after / lasts, 80);
    return after >= 0 ? (1 - t) * expf(-t) : 0;
}

static float away_from(const float centre[4], float3 p, float way[3]) {
    way[0] = p.x - centre[0];
    way[1] = p.y - centre[1];
    way[2] = p.z - centre[2];
    return sqrtf(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
}

void eval_blast_pressure(const field_point *at, const float (*a)[4], float out[4]) {
    float way[3];
    const float scale = blast_scale(a[2][0]), z = away_from(a[0], at->p, way) / scale;
    const float excess = blast_excess(z);
    out[0] = ambient * excess * pulse(z, a[1][0] / scale, excess);
}

void eval_blast_velocity(const field_point *at, const float (*a)[4], float out[4]) {
    float way[3];
    const float scale = blast_scale(a[2][0]), away = away_from(a[0], at->p, way), z = away / scale;
    const float excess = blast_excess(z);
    const float fast = blast_speed(excess) * pulse(z, a[1][0] / scale, excess);
    for (int i = 0; i < 3; i++) out[i] = fast / fmaxf(away, 1e-20f) * way[i];
}

void eval_blast_impulse(const field_point *at, const float (*a)[4], float out[4]) {
    float way[3];
    const float scale = blast_scale(a[1][0]);
    out[0] = scale * blast_impulse(away_from(a[0], at->p, way) / scale);
}

void eval_blast_arrival(const field_point *at, const float (*a)[4], float out[4]) {
    float way[3];
    const float scale = blast_scale(a[1][0]);
    out[0] = scale * blast_front(away_from(a[0], at->p, way) / scale);
}
