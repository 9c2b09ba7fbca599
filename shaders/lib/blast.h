// What a burst of TNT in free air does to the air around, by the distance from it and its charge: the
// front's overpressure and the impulse behind it are the fits of Kinney and Graham, "Explosive shocks in
// air" (1985), over the distance for 1 kg (m/kg^(1/3); Hopkinson and Cranz). The front's speed and that of
// the air behind it follow by Rankine and Hugoniot, when it arrives by the integral of 1 / speed. What
// follows is Friedlander's pulse (1946), (1 - t / d) exp(-t / d), whose impulse is d / e of its peak: so d
// follows. C compiles this text too (src/field/glsl.h).
#ifndef LIB_BLAST_H
#define LIB_BLAST_H
#ifndef SHARED
#define SHARED
#endif

#define BLAST_AMBIENT 101325.0f // Pa: of air at 15 degrees
#define BLAST_SOUND 340.3f      // m/s
#define BLAST_SURFACE 0.053f    // m: radius of 1 kg; nearer it is as there
#define BLAST_FARTHEST 1e6f     // m, for 1 kg; farther it is as there
#define BLAST_LEAST 1e-6f       // kg
#define BLAST_SUCTION 0.1353353f // of the peak: the pulse's least, 1 / e^2

// Of the front at the distance z for 1 kg: its overpressure, as a part of the ambient pressure.
SHARED float blast_excess(float z) {
    float near = clamp(z, BLAST_SURFACE, BLAST_FARTHEST);
    float a = near / 4.5f, b = near / 0.048f, c = near / 0.32f, d = near / 1.35f;
    return 808.0f * (1.0f + a * a) / (sqrt(1.0f + b * b) * sqrt(1.0f + c * c) * sqrt(1.0f + d * d));
}

// Pa s, for 1 kg: of the overpressure, until it becomes suction.
SHARED float blast_impulse_1(float z) {
    float near = clamp(z, BLAST_SURFACE, BLAST_FARTHEST), a = near / 0.23f, b = near / 1.55f;
    return 6.7f * sqrt(1.0f + a * a * a * a) / (near * near * pow(1.0f + b * b * b, 1.0f / 3.0f));
}

// Mach number of the front, and m/s of the air behind it.
SHARED float blast_mach(float excess) {
    return sqrt(1.0f + 6.0f / 7.0f * excess);
}

SHARED float blast_speed(float excess) {
    return 5.0f / 7.0f * BLAST_SOUND * excess / blast_mach(excess);
}

// A pair of the 8 points of Gauss's rule, `reach` on both sides of the middle, in logarithms.
SHARED float blast_slowness(float middle, float reach) {
    float a = exp(middle - reach), b = exp(middle + reach);
    return a / blast_mach(blast_excess(a)) + b / blast_mach(blast_excess(b));
}

// Seconds until the front is at the distance z, for 1 kg, by Gauss's rule over its logarithm.
SHARED float blast_front(float z) {
    if (z <= BLAST_SURFACE) return z / (BLAST_SOUND * blast_mach(blast_excess(z)));
    float from = log(BLAST_SURFACE), half_way = 0.5f * (log(z) - from), middle = from + half_way;
    float sum = 0.36268378f * blast_slowness(middle, half_way * 0.18343464f) +
                0.31370665f * blast_slowness(middle, half_way * 0.52553241f) +
                0.22238103f * blast_slowness(middle, half_way * 0.79666648f) +
                0.10122854f * blast_slowness(middle, half_way * 0.96028986f);
    return (half_way * sum + BLAST_SURFACE / blast_mach(blast_excess(BLAST_SURFACE))) / BLAST_SOUND;
}

// Root of the charge: metres and seconds are by it what they are for 1 kg.
SHARED float blast_scale(float charge) {
    return pow(max(charge, BLAST_LEAST), 1.0f / 3.0f);
}

// Friedlander's pulse at the distance z, `age` seconds after the burst of 1 kg, as a part of its peak.
SHARED float blast_pulse(float z, float age, float excess) {
    float after = age - blast_front(z);
    float lasts = 2.7182818f * blast_impulse_1(z) / (BLAST_AMBIENT * excess), t = min(after / lasts, 80.0f);
    return after >= 0.0f ? (1.0f - t) * exp(-t) : 0.0f;
}

// ---- of any charge, so far away ---------------------------------------------------------------

SHARED float blast_pressure(float away, float age, float charge) { // Pa
    float scale = blast_scale(charge), z = away / scale, excess = blast_excess(z);
    return BLAST_AMBIENT * excess * blast_pulse(z, age / scale, excess);
}

SHARED float blast_velocity(float away, float age, float charge) { // m/s, away from the burst
    float scale = blast_scale(charge), z = away / scale, excess = blast_excess(z);
    return blast_speed(excess) * blast_pulse(z, age / scale, excess);
}

SHARED float blast_impulse(float away, float charge) { // Pa s
    float scale = blast_scale(charge);
    return scale * blast_impulse_1(away / scale);
}

SHARED float blast_arrival(float away, float charge) { // s
    float scale = blast_scale(charge);
    return scale * blast_front(away / scale);
}

#endif
