// What a burst of TNT in free air does to the air around, by the distance from it and its charge: the
// front's overpressure and the impulse behind it are the fits of Kinney and Graham, "Explosive shocks in
// air" (1985), over the distance for 1 kg (m/kg^(1/3); Hopkinson and Cranz). The front's speed and that of
// the air behind it follow by Rankine and Hugoniot, when it arrives by the integral of 1 / speed. What
// follows is Friedlander's pulse (1946), (1 - t / d) exp(-t / d), whose impulse is d / e of its peak: so d
// follows. Twins in C: src/field/kinds_blast.c.
#ifndef LIB_BLAST_GLSL
#define LIB_BLAST_GLSL

const float BLAST_AMBIENT = 101325.0, BLAST_SOUND = 340.3; // Pa, m/s: of air at 15 degrees
const float BLAST_SURFACE = 0.053;                         // m: radius of 1 kg; nearer it is as there
const float BLAST_FARTHEST = 1e6;                          // m, for 1 kg; farther it is as there
const float BLAST_LEAST = 1e-6;                            // kg
const float BLAST_SUCTION = 0.1353353;                     // of the peak: the pulse's least, 1 / e^2

// Of the front at the distance z for 1 kg: its overpressure, as a part of the ambient pressure.
float blast_excess(float z) {
    float near = clamp(z, BLAST_SURFACE, BLAST_FARTHEST);
    vec4 q = near / vec4(4.5, 0.048, 0.32, 1.35);
    q = 1.0 + q * q;
    return 808.0 * q.x / (sqrt(q.y) * sqrt(q.z) * sqrt(q.w));
}

// Pa s, for 1 kg: of the overpressure, until it becomes suction.
float blast_impulse(float z) {
    float near = clamp(z, BLAST_SURFACE, BLAST_FARTHEST), a = near / 0.23, b = near / 1.55;
    return 6.7 * sqrt(1.0 + a * a * a * a) / (near * near * pow(1.0 + b * b * b, 1.0 / 3.0));
}

// Mach number of the front, and m/s of the air behind it.
float blast_mach(float excess) { return sqrt(1.0 + 6.0 / 7.0 * excess); }
float blast_speed(float excess) { return 5.0 / 7.0 * BLAST_SOUND * excess / blast_mach(excess); }

// Seconds until the front is at the distance z, for 1 kg, by Gauss's 8 points over its logarithm.
float blast_front(float z) {
    if (z <= BLAST_SURFACE) return z / (BLAST_SOUND * blast_mach(blast_excess(z)));
    const vec4 place = vec4(0.18343464, 0.52553241, 0.79666648, 0.96028986);
    const vec4 weight = vec4(0.36268378, 0.31370665, 0.22238103, 0.10122854);
    float from = log(BLAST_SURFACE), half_way = 0.5 * (log(z) - from), middle = from + half_way, sum = 0.0;
    for (int i = 0; i < 4; i++) {
        float a = exp(middle - half_way * place[i]), b = exp(middle + half_way * place[i]);
        sum += weight[i] * (a / blast_mach(blast_excess(a)) + b / blast_mach(blast_excess(b)));
    }
    return (half_way * sum + BLAST_SURFACE / blast_mach(blast_excess(BLAST_SURFACE))) / BLAST_SOUND;
}

// Root of the charge: metres and seconds are by it what they are for 1 kg.
float blast_scale(float charge) { return pow(max(charge, BLAST_LEAST), 1.0 / 3.0); }

// Friedlander's pulse at the distance z, `age` seconds after the burst of 1 kg, as a part of its peak.
float blast_pulse(float z, float age, float excess) {
    float after = age - blast_front(z), lasts = 2.7182818 * blast_impulse(z) / (BLAST_AMBIENT * excess);
    float t = min(after / lasts, 80.0);
    return after >= 0.0 ? (1.0 - t) * exp(-t) : 0.0;
}

float blast_pressure(vec3 p, vec3 position, float age, float charge) {
    float scale = blast_scale(charge), z = length(p - position) / scale, excess = blast_excess(z);
    return BLAST_AMBIENT * excess * blast_pulse(z, age / scale, excess);
}

vec3 blast_velocity(vec3 p, vec3 position, float age, float charge) {
    float scale = blast_scale(charge), away = length(p - position), z = away / scale, excess = blast_excess(z);
    return blast_speed(excess) * blast_pulse(z, age / scale, excess) / max(away, 1e-20) * (p - position);
}

float blast_impulse(vec3 p, vec3 position, float charge) {
    float scale = blast_scale(charge);
    return scale * blast_impulse(length(p - position) / scale);
}

float blast_arrival(vec3 p, vec3 position, float charge) {
    float scale = blast_scale(charge);
    return scale * blast_front(length(p - position) / scale);
}

#endif
