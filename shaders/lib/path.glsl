// Random numbers and directions for paths of light.
#ifndef LIB_PATH_GLSL
#define LIB_PATH_GLSL
#include "lib/across.glsl"
#include "lib/light.glsl"
#include "lib/medium.glsl"

const float PATH_PI = 3.14159265;

// Four hashes of four counters: pcg4d by Jarzynski and Olano (JCGT 9(3), 2020).
uvec4 path_hash(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v += v.yzxy * v.wxyz;
    v ^= v >> 16u;
    v += v.yzxy * v.wxyz;
    return v;
}

// Pixel, sample and how often it was asked: every sample of every pixel has numbers of its own.
struct path_random {
    uvec3 key;
    uint turn;
};

// Four numbers in 0..1, without the 1.
vec4 path_next(inout path_random random) {
    return vec4(path_hash(uvec4(random.key, random.turn++)) >> 8u) * (1.0 / 16777216.0);
}

// A unit vector turned away from the unit vector `axis` by the angle of this cosine and sine.
vec3 path_around(vec3 axis, float cosine, float sine, float turn) {
    float angle = 2.0 * PATH_PI * turn;
    return normalize(cosine * axis + sine * (across(axis) * vec2(cos(angle), sin(angle))));
}

// Directions of a Lambertian surface: their density is the cosine over pi.
vec3 path_sample_cosine(vec3 normal, vec2 random) {
    return path_around(normal, sqrt(1.0 - random.x), sqrt(random.x), random.y);
}

// Exact draws from phase_lobe: its integral, inverted.
float path_sample_lobe(float g, float random) {
    float centred = 2.0 * random - 1.0;
#if defined(PHASE_SCHLICK) && PHASE == PHASE_SCHLICK
    float k = 1.55 * g - 0.55 * g * g * g;
    return (centred + k) / (1.0 + k * centred);
#else
    if (abs(g) < 1e-3) return centred;
    float part = (1.0 - g * g) / (1.0 + g * centred);
    return (1.0 + g * g - part * part) / (2.0 * g);
#endif
}

// Directions after scattering of a way `before`: their density is medium_phase.
vec3 path_sample_phase(vec3 before, vec3 random) {
    float g = anisotropy, left = random.z * dot(lobe_weights, vec4(1.0));
    for (int i = 0; i < 4 && left >= 0.0; i++) {
        if (lobe_weights[i] > 0.0) g = lobe_anisotropies[i];
        left -= lobe_weights[i];
        if (left < 0.0) break;
    }
    float cosine = clamp(path_sample_lobe(g, random.x), -1.0, 1.0);
    return path_around(before, cosine, sqrt(max(1.0 - cosine * cosine, 0.0)), random.y);
}

struct path_light {
    vec3 way;          // unit, towards a point of the light
    float far;         // metres to it
    vec3 radiance;     // of the light, times the solid angle that it fills
    float solid_angle; // 0: it is a point, or the vertex lies within it
};

// Sine of half the angle that a light fills; 1 from within a sphere.
float path_sine(light l, light_ray at) {
    return l.kind == LIGHT_SUN ? l.radius : min(l.radius / at.distance, 1.0);
}

float path_solid_angle(float sine) {
    return sine < 1.0 ? 2.0 * PATH_PI * sine * sine / (1.0 + sqrt(1.0 - sine * sine)) : 0.0;
}

// Irradiance on a surface across each of the light's rays; `at` is what light_at says of it: that on
// a surface that faces the whole light.
vec3 path_irradiance(light_ray at, float sine) {
    return at.irradiance * (2.0 / (1.0 + sqrt(1.0 - sine * sine)));
}

// Metres to the light along a ray from the vertex; negative: the ray passes it.
float path_meet_light(light l, light_ray at, float sine, vec3 way) {
    vec3 aside = cross(way, at.direction);
    float off = dot(aside, aside), along = dot(way, at.direction);
    if (along <= 0.0 || off > sine * sine) return -1.0;
    if (l.kind == LIGHT_SUN) return 1e9;
    float room = l.radius * l.radius - at.distance * at.distance * off;
    return max(at.distance * along - sqrt(max(room, 0.0)), 0.0);
}

// A point of a sphere or of the sun's disc, drawn from the solid angle that it fills.
path_light path_sample_light(light l, light_ray at, vec2 random) {
    float sine = path_sine(l, at), edge = sqrt(1.0 - sine * sine);
    float away = random.x * sine * sine / (1.0 + edge); // one minus the cosine
    path_light s;
    s.way = path_around(at.direction, 1.0 - away, sqrt(away * (2.0 - away)), random.y);
    s.radiance = path_irradiance(at, sine);
    s.solid_angle = path_solid_angle(sine);
    s.far = at.distance;
    if (l.kind != LIGHT_SUN && l.radius > 0.0) {
        float middle = at.distance * (1.0 - away);
        float beside = at.distance * at.distance - middle * middle;
        s.far = max(middle - sqrt(max(l.radius * l.radius - beside, 0.0)), 0.0);
    }
    return s;
}

// Where in a pixel a sample lies, from its middle: drawn from the filter, so that all count alike.
// Blackman and Harris' window is 1.5 pixels wide, as in Cycles; its integral is inverted by Newton.
float path_blackman_harris(float random) {
    float x = 0.5;
    for (int i = 0; i < 12; i++) {
        vec3 angle = vec3(2.0, 4.0, 6.0) * PATH_PI * x;
        vec3 share = vec3(-0.48829, 0.14128, -0.01168) / 0.35875;
        float below = x + dot(share / (vec3(2.0, 4.0, 6.0) * PATH_PI), sin(angle)) - random;
        float height = 1.0 + dot(share, cos(angle));
        x = clamp(x - clamp(below / max(height, 0.05), -0.1, 0.1), 0.0, 1.0);
    }
    return 1.5 * (x - 0.5);
}

vec2 path_sample_pixel(int kind, vec2 random) {
    if (kind == 0) return vec2(0.0);
    if (kind == 1) return random - 0.5;
    return vec2(path_blackman_harris(random.x), path_blackman_harris(random.y));
}

#endif
