// Worley noise in one octave, for lib/noise.glsl.
#ifndef LIB_NOISE_WORLEY_GLSL
#define LIB_NOISE_WORLEY_GLSL

// Worley, "A cellular texture basis function", 1996: one feature point a cell. Distances are
// limited to 1 cell, within which the search of the neighbouring cells is exact.

// The hash of Raseta, Lesar and Bohak, section 3.7.2. `precise`, and sums written out, because
// its fractions magnify every rounding.
vec3 noise_paper_fractions(vec3 cell) {
    precise vec3 a = fract(cell * vec3(0.1031, 0.1030, 0.0973));
    return a;
}

vec3 noise_paper_mixed(vec3 a) {
    precise vec3 b = a.yxz + 33.33;
    precise float c = a.x * b.x + a.y * b.y + a.z * b.z;
    precise vec3 e = a + c;
    precise vec3 f = (e.xxy + e.yxx) * e.zyx;
    return fract(f);
}

vec3 noise_paper_hash(vec3 cell) {
    return noise_paper_mixed(noise_paper_fractions(cell));
}

vec2 noise_nearer(vec2 best, float squared) {
    return vec2(min(best.x, squared), min(best.y, max(best.x, squared)));
}

// Squared distances to the nearest and second nearest feature point. `shift`: seed of the paper's
// hash; negative: the integer hash. What coordinates are hashed to is found once along each axis.
vec2 noise_worley3(vec3 q, uint seed, float period, float shift) {
    vec3 cell = floor(q), d = q - cell;
    vec3 near[3];
    [[unroll]] for (int i = 0; i < 3; i++) near[i] = noise_wrap(cell + float(i - 1), period);
    vec2 best = vec2(1.0);
    if (shift >= 0.0) {
        [[unroll]] for (int i = 0; i < 3; i++) near[i] = noise_paper_fractions(near[i] + shift);
        [[unroll]] for (int z = 0; z < 3; z++)
            [[unroll]] for (int y = 0; y < 3; y++)
                [[unroll]] for (int x = 0; x < 3; x++) {
                    vec3 point = noise_paper_mixed(vec3(near[x].x, near[y].y, near[z].z));
                    vec3 r = vec3(x - 1, y - 1, z - 1) + point - d;
                    best = noise_nearer(best, dot(r, r));
                }
        return best;
    }
    uvec3 share[3];
    [[unroll]] for (int i = 0; i < 3; i++) share[i] = noise_lattice(near[i], 0.0);
    [[unroll]] for (int z = 0; z < 3; z++)
        [[unroll]] for (int y = 0; y < 3; y++)
            [[unroll]] for (int x = 0; x < 3; x++) {
                uint h = noise_hash(share[x].x + share[y].y + share[z].z + seed);
                vec3 point = vec3(h & 1023u, (h >> 10u) & 1023u, h >> 22u) * (1.0 / 1024.0);
                vec3 r = vec3(x - 1, y - 1, z - 1) + point - d;
                best = noise_nearer(best, dot(r, r));
            }
    return best;
}

vec2 noise_worley4(vec4 q, uint seed, float period, float shift) {
    vec4 cell = floor(q), d = q - cell;
    vec4 near[3];
    uvec4 share[3];
    [[unroll]] for (int i = 0; i < 3; i++) {
        near[i] = noise_wrap(cell + float(i - 1), period) + max(shift, 0.0);
        share[i] = noise_lattice(near[i], 0.0);
    }
    vec2 best = vec2(1.0);
    for (int w = 0; w < 3; w++) {
        float side = w == 0 ? near[0].w : w == 1 ? near[1].w : near[2].w;
        uint last = (w == 0 ? share[0].w : w == 1 ? share[1].w : share[2].w) + seed;
        [[unroll]] for (int z = 0; z < 3; z++)
            [[unroll]] for (int y = 0; y < 3; y++)
                [[unroll]] for (int x = 0; x < 3; x++) {
                    vec4 point;
                    if (shift >= 0.0) {
                        vec4 c = vec4(near[x].x, near[y].y, near[z].z, side);
                        point = vec4(noise_paper_hash(c.xyz + 7.0 * c.w), noise_paper_hash(c.wxy).z);
                    } else {
                        uint h = noise_hash(share[x].x + share[y].y + share[z].z + last);
                        point = vec4(h & 255u, (h >> 8u) & 255u, (h >> 16u) & 255u, h >> 24u) / 256.0;
                    }
                    vec4 r = vec4(x - 1, y - 1, z - 1, w - 1) + point - d;
                    best = noise_nearer(best, dot(r, r));
                }
    }
    return best;
}

float noise_cells(vec2 squared, float power, int distance) {
    return noise_cells(sqrt(squared.x), sqrt(squared.y), power, distance);
}

#endif
