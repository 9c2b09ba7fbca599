// What is seen of the sky: its light, and at night stars, the band of the Milky Way and the moon, all of
// them made up, the same on every device. They shine on nothing: the moon's light is that of the sun.
#ifndef LIB_NIGHT_GLSL
#define LIB_NIGHT_GLSL
#include "lib/sky.glsl"

#if SKY_NIGHT
#include "lib/across.glsl"
#include "lib/random.glsl"

const vec3 NIGHT_POLE = vec3(0.36, -0.48, 0.8); // of the Milky Way, unit
const vec3 MOONLIGHT = vec3(1.0, 0.95, 0.84);

// A random number of a cell (0..1).
float night_random(ivec3 cell, uint seed) {
    uint h = random_hash(uint(cell.x) + random_hash(uint(cell.y) + random_hash(uint(cell.z) + seed)));
    return float(h) * (1.0 / 4294967296.0);
}

// Smooth noise, 0..1.
float night_noise(vec3 p, uint seed) {
    ivec3 cell = ivec3(floor(p));
    vec3 f = fract(p), t = f * f * (3.0 - 2.0 * f);
    float sum = 0.0;
    for (int i = 0; i < 8; i++) {
        ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
        vec3 w = mix(1.0 - t, t, vec3(corner));
        sum += w.x * w.y * w.z * night_random(cell + corner, seed);
    }
    return sum;
}

// At most one star in each cell of a cube around the eye, away from the cell's walls. `radius` and
// `pixel` in radians: what is smaller than a pixel is spread over one.
vec3 night_star(vec3 d, float cells, float share, float radius, float pixel, uint seed) {
    vec3 size = abs(d);
    int axis = size.x > max(size.y, size.z) ? 0 : size.y > size.z ? 1 : 2;
    vec3 q = d / size[axis]; // on the cube
    vec3 at = (q * 0.5 + 0.5) * cells;
    ivec3 cell = ivec3(floor(at));
    cell[axis] = d[axis] > 0.0 ? -1 : -2;
    if (night_random(cell, seed) > share) return vec3(0.0);
    vec3 place = vec3(cell) + 0.1 + 0.8 * vec3(night_random(cell, seed + 1u), night_random(cell, seed + 2u),
                                                night_random(cell, seed + 3u));
    vec3 star = (place / cells - 0.5) * 2.0;
    star[axis] = sign(d[axis]);
    vec3 apart = d - normalize(star);
    float chance = night_random(cell, seed + 4u), bright = 0.05 + 0.95 * pow(chance, 7.0); // few are bright
    radius *= 0.75 + 0.5 * chance;
    float r = max(radius, 0.8 * pixel);
    float twinkle = 1.0 + 0.3 * sin(frame.time.x * (1.5 + 4.0 * chance) + 40.0 * chance);
    vec3 tint = mix(vec3(1.0, 0.80, 0.62), vec3(0.70, 0.82, 1.0), night_random(cell, seed + 5u));
    return tint * bright * twinkle * exp(-dot(apart, apart) / (r * r)) * min(1.0, radius * radius / (r * r));
}

vec3 night_stars(vec3 d, float pixel) {
    float band = dot(d, NIGHT_POLE) / 0.22, near = exp(-band * band);
    float cloud = 0.6 * night_noise(9.0 * d, 71u) + 0.4 * night_noise(23.0 * d, 72u);
    vec3 sum = vec3(0.006, 0.007, 0.012) * near * smoothstep(0.3, 0.9, cloud);
    sum += 2.5 * night_star(d, 17.0, 0.40, 0.0017, pixel, 11u);
    sum += 1.2 * night_star(d, 41.0, 0.22 + 0.3 * near * cloud, 0.0011, pixel, 17u);
    sum += 0.6 * night_star(d, 97.0, 0.25 + 0.6 * near * cloud, 0.0008, pixel, 23u);
    return sum * smoothstep(-0.02, 0.25, d.z); // the air hides those that stand low
}

// A disc with dark seas, and the glow round it.
vec3 night_moon(vec3 d, float pixel, inout float stars) {
    float radius = frame.sun_direction.w;
    vec3 towards = frame.sun_direction.xyz;
    if (radius <= 0.0) return vec3(0.0);
    float away = acos(clamp(dot(d, towards), -1.0, 1.0)) / radius;
    float inside = clamp(0.5 + (1.0 - away) * radius / max(pixel, 1e-6), 0.0, 1.0);
    vec2 q = (d - towards) * across(towards) / radius;
    float seas = 0.65 * night_noise(vec3(2.1 * q, 3.0), 5u) + 0.35 * night_noise(vec3(5.3 * q, 9.0), 6u);
    float face = (1.0 - 0.35 * smoothstep(0.46, 0.62, seas)) * (1.0 - 0.15 * dot(q, q));
    stars *= 1.0 - inside;
    return MOONLIGHT * (inside * face + (1.0 - inside) * 0.10 * exp(-0.9 * max(away - 1.0, 0.0)));
}
#endif

// `pixel`: angle across one, radians.
vec3 night_sky(vec3 direction, float pixel) {
    vec3 light = sky_radiance(direction);
#if SKY_NIGHT
    float shine = frame.night_zenith.w * frame.night_horizon.w, stars = 1.0;
    if (shine <= 0.0) return light;
    vec3 moon = night_moon(direction, pixel, stars);
    light += shine * (moon + stars * night_stars(direction, pixel));
#endif
    return light;
}

#endif
