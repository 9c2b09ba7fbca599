// Procedural noise, in 3 or 4 dimensions, over a lattice of cells. Twins in C: src/field/noise.c.
//
// Every lattice point has an integer hash of its coordinates and the seed, instead of Perlin's table
// of permutations. A base noise n lies in -1..1. Octave i of exactly `octaves` has frequency
// frequency * lacunarity^i, weight persistence^i and a seed of its own; the weighted mean over the
// octaves lies in 0..1 and is multiplied by the amplitude.
//
// `drift` (metres) and `phase` (cells) are rates that were multiplied by the time already; phase + w
// is the fourth coordinate. A period repeats the lattice, the fourth dimension too, after so many
// cells; it and the lacunarity are then rounded to whole numbers, so that every octave closes.
#ifndef LIB_NOISE_GLSL
#define LIB_NOISE_GLSL
#include "lib/noise.h"

const uvec4 NOISE_PRIMES = uvec4(0x8da6b343u, 0xd8163841u, 0xcb1ab31fu, 0x165667b1u);
const int NOISE_FOUR = 1;                     // option "dimensions"
const int NOISE_PAPER = 1;                    // option "mode"

uint noise_first_seed(float seed) {
    return noise_hash(uint(int(seed)) + NOISE_NEXT_SEED);
}

// The half cell keeps the quotient away from whole numbers, where its rounding would matter.
vec3 noise_wrap(vec3 cell, float period) {
    return period > 0.0 ? cell - period * floor((cell + 0.5) / period) : cell;
}

vec4 noise_wrap(vec4 cell, float period) {
    return period > 0.0 ? cell - period * floor((cell + 0.5) / period) : cell;
}

// Each coordinate's share of a lattice point's hash: their sum plus the seed is hashed.
uvec3 noise_lattice(vec3 cell, float period) {
    return uvec3(ivec3(noise_wrap(cell, period))) * NOISE_PRIMES.xyz;
}

uvec4 noise_lattice(vec4 cell, float period) {
    return uvec4(ivec4(noise_wrap(cell, period))) * NOISE_PRIMES;
}

vec3 noise_fade(vec3 t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

vec4 noise_fade(vec4 t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// ---- Perlin -----------------------------------------------------------------------------------
// Perlin, "Improving noise", 2002: gradients are the edges of the cube. The factors bring the
// extremes to 1.


float noise_edge(uint h, vec3 d) { // one of 12 edges, four of them twice
    uint k = h >> 28u;
    float u = k < 8u ? d.x : d.y;
    float v = k < 4u ? d.y : (k == 12u || k == 14u ? d.x : d.z);
    return ((k & 1u) == 0u ? u : -u) + ((k & 2u) == 0u ? v : -v);
}

float noise_edge(uint h, vec4 d) { // one of 32 edges of the hypercube
    uint k = h >> 27u;
    float u = k < 24u ? d.x : d.y;
    float v = k < 16u ? d.y : d.z;
    float w = k < 8u ? d.z : d.w;
    return ((k & 1u) == 0u ? u : -u) + ((k & 2u) == 0u ? v : -v) + ((k & 4u) == 0u ? w : -w);
}

float noise_perlin3(vec3 q, uint seed, float period) {
    vec3 cell = floor(q), d = q - cell, e = d - 1.0, t = noise_fade(d);
    uvec3 a = noise_lattice(cell, period), b = noise_lattice(cell + 1.0, period);
    uint aa = a.y + a.z + seed, ba = b.y + a.z + seed;
    uint ab = a.y + b.z + seed, bb = b.y + b.z + seed;
    float n00 = mix(noise_edge(noise_hash(a.x + aa), d),
                    noise_edge(noise_hash(b.x + aa), vec3(e.x, d.yz)), t.x);
    float n10 = mix(noise_edge(noise_hash(a.x + ba), vec3(d.x, e.y, d.z)),
                    noise_edge(noise_hash(b.x + ba), vec3(e.xy, d.z)), t.x);
    float n01 = mix(noise_edge(noise_hash(a.x + ab), vec3(d.xy, e.z)),
                    noise_edge(noise_hash(b.x + ab), vec3(e.x, d.y, e.z)), t.x);
    float n11 = mix(noise_edge(noise_hash(a.x + bb), vec3(d.x, e.yz)),
                    noise_edge(noise_hash(b.x + bb), e), t.x);
    return mix(mix(n00, n10, t.y), mix(n01, n11, t.y), t.z) * NOISE_PERLIN3;
}

float noise_perlin4(vec4 q, uint seed, float period) {
    vec4 cell = floor(q), d = q - cell, t = noise_fade(d);
    uvec4 a = noise_lattice(cell, period), b = noise_lattice(cell + 1.0, period);
    float n[8];
    for (int i = 0; i < 8; i++) { // y, z, w of the corner are the bits of i
        bvec3 far = notEqual(ivec3(i) & ivec3(1, 2, 4), ivec3(0));
        uint h = (far.x ? b.y : a.y) + (far.y ? b.z : a.z) + (far.z ? b.w : a.w) + seed;
        vec4 r = d - vec4(0.0, far);
        n[i] = mix(noise_edge(noise_hash(a.x + h), r),
                   noise_edge(noise_hash(b.x + h), vec4(r.x - 1.0, r.yzw)), t.x);
    }
    for (int i = 0; i < 4; i++) n[i] = mix(n[2 * i], n[2 * i + 1], t.y);
    return mix(mix(n[0], n[1], t.z), mix(n[2], n[3], t.z), t.w) * NOISE_PERLIN4;
}

// ---- simplex ----------------------------------------------------------------------------------
// Perlin's simplex noise ("Noise hardware", 2001) as Gustavson explains it, with the kernel
// radius^2 of 1/2, which is continuous across simplices. The factors bring the extremes to 1.
//
// Periods: with a skew of 1/3 the lattice falls on itself when moved by a multiple of 3 along an
// axis, by whole steps of its own. In three dimensions that is the skew; in four it is near to it,
// so a repeating noise takes it, with the lower simplices' radius^2 of 9/19 and a factor for that.


float noise_kernel(uint h, vec3 d) {
    float t = max(0.5 - dot(d, d), 0.0);
    return t * t * t * t * noise_edge(noise_hash(h), d);
}

float noise_kernel(uint h, vec4 d, float reach) {
    float t = max(reach - dot(d, d), 0.0);
    return t * t * t * t * noise_edge(noise_hash(h), d);
}

uint noise_corner(vec3 cell, uint seed, float period) {
    if (period > 0.0) { // six times the corner's place is whole
        vec3 turns = floor((6.0 * cell - (cell.x + cell.y + cell.z) + 0.5) / (6.0 * period));
        cell -= turns * period + (turns.x + turns.y + turns.z) * (period / 3.0);
    }
    uvec3 h = noise_lattice(cell, 0.0);
    return h.x + h.y + h.z + seed;
}

uint noise_corner(vec4 cell, uint seed, float period) {
    if (period > 0.0) { // and seven times it here
        float cells = cell.x + cell.y + cell.z + cell.w;
        vec4 turns = floor((7.0 * cell - cells + 0.5) / (7.0 * period));
        cell -= turns * period + (turns.x + turns.y + turns.z + turns.w) * (period / 3.0);
    }
    uvec4 h = noise_lattice(cell, 0.0);
    return h.x + h.y + h.z + h.w + seed;
}

float noise_simplex3(vec3 q, uint seed, float period) {
    const float skew = 1.0 / 3.0, back = 1.0 / 6.0;
    vec3 cell = floor(q + (q.x + q.y + q.z) * skew);
    vec3 d = q - (cell - (cell.x + cell.y + cell.z) * back);
    vec3 g = step(d.yzx, d), l = 1.0 - g; // which coordinates come first
    vec3 one = min(g, l.zxy), two = max(g, l.zxy);
    return (noise_kernel(noise_corner(cell, seed, period), d) +
            noise_kernel(noise_corner(cell + one, seed, period), d - one + back) +
            noise_kernel(noise_corner(cell + two, seed, period), d - two + 2.0 * back) +
            noise_kernel(noise_corner(cell + 1.0, seed, period), d - 1.0 + 3.0 * back)) *
           NOISE_SIMPLEX3;
}

float noise_simplex4(vec4 q, uint seed, float period) {
    bool closed = period > 0.0;
    float skew = closed ? 1.0 / 3.0 : 0.309016994; // (sqrt(5) - 1) / 4
    float back = closed ? 1.0 / 7.0 : 0.138196601; // (5 - sqrt(5)) / 20
    float reach = closed ? 9.0 / 19.0 : 0.5;
    vec4 cell = floor(q + (q.x + q.y + q.z + q.w) * skew);
    vec4 d = q - (cell - (cell.x + cell.y + cell.z + cell.w) * back);
    vec3 x = step(d.yzw, d.xxx), y = step(d.zww, d.yyz);
    vec4 rank = vec4(x.x + x.y + x.z, 1.0 - x);
    rank.y += y.x + y.y;
    rank.zw += 1.0 - y.xy;
    rank.z += y.z;
    rank.w += 1.0 - y.z;
    vec4 one = clamp(rank - 2.0, 0.0, 1.0), two = clamp(rank - 1.0, 0.0, 1.0);
    vec4 three = clamp(rank, 0.0, 1.0);
    return (noise_kernel(noise_corner(cell, seed, period), d, reach) +
            noise_kernel(noise_corner(cell + one, seed, period), d - one + back, reach) +
            noise_kernel(noise_corner(cell + two, seed, period), d - two + 2.0 * back, reach) +
            noise_kernel(noise_corner(cell + three, seed, period), d - three + 3.0 * back, reach) +
            noise_kernel(noise_corner(cell + 1.0, seed, period), d - 1.0 + 4.0 * back, reach)) *
           (closed ? NOISE_SIMPLEX4_CLOSED : NOISE_SIMPLEX4);
}

// ---- value ------------------------------------------------------------------------------------

float noise_value(uint h) { // -1..1
    return float(noise_hash(h) >> 8u) * (1.0 / 8388608.0) - 1.0;
}

float noise_value3(vec3 q, uint seed, float period) {
    vec3 cell = floor(q), t = noise_fade(q - cell);
    uvec3 a = noise_lattice(cell, period), b = noise_lattice(cell + 1.0, period);
    float n[4];
    for (int i = 0; i < 4; i++) {
        uint h = ((i & 1) == 0 ? a.y : b.y) + ((i & 2) == 0 ? a.z : b.z) + seed;
        n[i] = mix(noise_value(a.x + h), noise_value(b.x + h), t.x);
    }
    return mix(mix(n[0], n[1], t.y), mix(n[2], n[3], t.y), t.z);
}

float noise_value4(vec4 q, uint seed, float period) {
    vec4 cell = floor(q), t = noise_fade(q - cell);
    uvec4 a = noise_lattice(cell, period), b = noise_lattice(cell + 1.0, period);
    float n[8];
    for (int i = 0; i < 8; i++) {
        uint h = ((i & 1) == 0 ? a.y : b.y) + ((i & 2) == 0 ? a.z : b.z) +
                 ((i & 4) == 0 ? a.w : b.w) + seed;
        n[i] = mix(noise_value(a.x + h), noise_value(b.x + h), t.x);
    }
    for (int i = 0; i < 4; i++) n[i] = mix(n[2 * i], n[2 * i + 1], t.y);
    return mix(mix(n[0], n[1], t.z), mix(n[2], n[3], t.z), t.w);
}

#include "lib/noise_worley.glsl"

// ---- octaves ----------------------------------------------------------------------------------

struct noise_octave {
    vec4 q;
    float lacunarity, period, weight, shift;
    uint seed;
    int count;
};

noise_octave noise_begin(vec3 p, float frequency, float octaves, float lacunarity, float seed,
                         vec3 drift, float phase, float period) {
    noise_octave o;
    bool closed = period >= 0.5;
    o.q = vec4((p + drift) * frequency, phase);
    o.lacunarity = closed ? max(floor(lacunarity + 0.5), 1.0) : lacunarity;
    o.period = closed ? floor(period + 0.5) : 0.0;
    o.weight = 1.0;
    o.shift = seed;
    o.seed = noise_first_seed(seed);
    o.count = clamp(int(octaves + 0.5), 1, NOISE_MAX_OCTAVES);
    return o;
}

void noise_next(inout noise_octave o, float persistence) {
    o.q *= o.lacunarity;
    o.period *= o.lacunarity;
    o.weight *= max(persistence, 0.0);
    o.shift += 1.0;
    o.seed += NOISE_NEXT_SEED;
}

// GLSL has no function arguments: the body of every noise, with its base in three and four
// dimensions as expressions of the octave `o`.
#define NOISE_SUM(THREE, FOUR)                                                                     \
    noise_octave o =                                                                               \
        noise_begin(p, frequency, octaves, lacunarity, seed, drift, phase + w, period);            \
    float sum = 0.0, total = 0.0;                                                                  \
    for (int i = 0; i < o.count; i++) {                                                            \
        float n = dimensions == NOISE_FOUR ? FOUR : THREE;                                         \
        sum += o.weight * noise_fold(clamp(n, -1.0, 1.0), fractal);                                \
        total += o.weight;                                                                         \
        noise_next(o, persistence);                                                                \
    }                                                                                              \
    return amplitude * sum / total

float noise_perlin(vec3 p, float frequency, float octaves, float persistence, float lacunarity,
                   float seed, float amplitude, vec3 drift, float phase, float w, float period,
                   int fractal, int dimensions) {
    NOISE_SUM(noise_perlin3(o.q.xyz, o.seed, o.period), noise_perlin4(o.q, o.seed, o.period));
}

float noise_value(vec3 p, float frequency, float octaves, float persistence, float lacunarity,
                  float seed, float amplitude, vec3 drift, float phase, float w, float period,
                  int fractal, int dimensions) {
    NOISE_SUM(noise_value3(o.q.xyz, o.seed, o.period), noise_value4(o.q, o.seed, o.period));
}

float noise_simplex(vec3 p, float frequency, float octaves, float persistence, float lacunarity,
                    float seed, float amplitude, vec3 drift, float phase, float w, float period,
                    int fractal, int dimensions) {
    period = period >= 0.5 ? 3.0 * max(floor(period / 3.0 + 0.5), 1.0) : 0.0;
    NOISE_SUM(noise_simplex3(o.q.xyz, o.seed, o.period), noise_simplex4(o.q, o.seed, o.period));
}

float noise_worley(vec3 p, float frequency, float octaves, float persistence, float lacunarity,
                   float seed, float amplitude, vec3 drift, float phase, float w, float period,
                   float power, int fractal, int dimensions, int distance, int mode) {
    NOISE_SUM(noise_cells(noise_worley3(o.q.xyz, o.seed, o.period,
                                        mode == NOISE_PAPER ? o.shift : -1.0), power, distance),
              noise_cells(noise_worley4(o.q, o.seed, o.period,
                                        mode == NOISE_PAPER ? o.shift : -1.0), power, distance));
}

// ---- curl -------------------------------------------------------------------------------------
// Bridson, Hourihan and Nordenstam, "Curl-noise for procedural fluid flow", 2007: the curl of a
// vector potential has no divergence. The potential is three Perlin noises whose gradients come
// from different bits of one hash. At a corner, with weight w and gradients g, U_i = g_i . d:
// curl(w U) = grad(w) x U + w curl(U). So the derivative is exact and costs no further evaluation.

vec4 noise_gradient3(uint k) { // the edges of noise_edge, as vectors; k: 0..15
    float u = (k & 1u) == 0u ? 1.0 : -1.0, v = (k & 2u) == 0u ? 1.0 : -1.0;
    vec4 g = k < 8u ? vec4(u, 0.0, 0.0, 0.0) : vec4(0.0, u, 0.0, 0.0);
    return g + (k < 4u                    ? vec4(0.0, v, 0.0, 0.0)
                : k == 12u || k == 14u ? vec4(v, 0.0, 0.0, 0.0)
                                       : vec4(0.0, 0.0, v, 0.0));
}

vec4 noise_gradient4(uint k) { // k: 0..31
    float u = (k & 1u) == 0u ? 1.0 : -1.0, v = (k & 2u) == 0u ? 1.0 : -1.0;
    float w = (k & 4u) == 0u ? 1.0 : -1.0;
    if (k < 8u) return vec4(u, v, w, 0.0);
    if (k < 16u) return vec4(u, v, 0.0, w);
    return k < 24u ? vec4(u, 0.0, v, w) : vec4(0.0, u, v, w);
}

vec3 noise_curl_base(vec4 q, uint seed, float period, int dimensions) {
    bool four = dimensions == NOISE_FOUR;
    vec4 cell = floor(q), d = q - cell, t = noise_fade(d);
    vec3 slope = 30.0 * d.xyz * d.xyz * (d.xyz * (d.xyz - 2.0) + 1.0); // derivative of the fade
    uvec4 a = noise_lattice(cell, period), b = noise_lattice(cell + 1.0, period);
    if (!four) {
        d.w = 0.0;
        a.w = 0u;
    }
    vec3 sum = vec3(0.0);
    for (int i = 0; i < (four ? 16 : 8); i++) {
        bvec4 far = notEqual(ivec4(i) & ivec4(1, 2, 4, 8), ivec4(0));
        uvec4 l = uvec4(far.x ? b.x : a.x, far.y ? b.y : a.y, far.z ? b.z : a.z, far.w ? b.w : a.w);
        uint h = noise_hash(l.x + l.y + l.z + l.w + seed);
        vec4 r = d - vec4(far), w = mix(1.0 - t, t, far);
        vec4 g0, g1, g2;
        if (four) {
            g0 = noise_gradient4(h >> 27u);
            g1 = noise_gradient4((h >> 22u) & 31u);
            g2 = noise_gradient4((h >> 17u) & 31u);
        } else {
            w.w = 1.0;
            g0 = noise_gradient3(h >> 28u);
            g1 = noise_gradient3((h >> 24u) & 15u);
            g2 = noise_gradient3((h >> 20u) & 15u);
        }
        vec3 away = mix(-slope, slope, far.xyz);
        vec3 rise = vec3(away.x * w.y * w.z, w.x * away.y * w.z, w.x * w.y * away.z) * w.w;
        vec3 potential = vec3(dot(g0, r), dot(g1, r), dot(g2, r));
        sum += cross(rise, potential) +
               w.x * w.y * w.z * w.w * vec3(g2.y - g1.z, g0.z - g2.x, g1.x - g0.y);
    }
    return sum * (four ? NOISE_PERLIN4 : NOISE_PERLIN3);
}

// The paper's differences, of a plain sum of Perlin octaves. A difference spans a small part of a
// cell, so its ends are taken by the polynomial of the cell that p lies in, whose corners are hashed
// once: by how far (e, in cells) an end lies beyond, noise is off by no more than 20 e^3, since
// the fade has no first and second derivative there.
const float NOISE_NEAR = 0.025; // cells

struct noise_cell3 {
    vec3 gradients[8];
};

noise_cell3 noise_cell_at(vec3 cell, uint seed, float period) {
    uvec3 a = noise_lattice(cell, period), b = noise_lattice(cell + 1.0, period);
    noise_cell3 c;
    [[unroll]] for (int i = 0; i < 8; i++) {
        uint h = ((i & 1) == 0 ? a.x : b.x) + ((i & 2) == 0 ? a.y : b.y) + ((i & 4) == 0 ? a.z : b.z);
        c.gradients[i] = noise_gradient3(noise_hash(h + seed) >> 28u).xyz;
    }
    return c;
}

float noise_perlin_in(noise_cell3 c, vec3 d) {
    vec3 e = d - 1.0, t = noise_fade(d);
    float n00 = mix(dot(c.gradients[0], d), dot(c.gradients[1], vec3(e.x, d.yz)), t.x);
    float n10 = mix(dot(c.gradients[2], vec3(d.x, e.y, d.z)), dot(c.gradients[3], vec3(e.xy, d.z)), t.x);
    float n01 = mix(dot(c.gradients[4], vec3(d.xy, e.z)), dot(c.gradients[5], vec3(e.x, d.y, e.z)), t.x);
    float n11 = mix(dot(c.gradients[6], vec3(d.x, e.yz)), dot(c.gradients[7], e), t.x);
    return mix(mix(n00, n10, t.y), mix(n01, n11, t.y), t.z) * NOISE_PERLIN3;
}

// Differences of one octave along the three diagonals.
vec3 noise_paper_differences(vec4 q, uint seed, float period, float reach, int dimensions) {
    const vec3 diagonals[3] = vec3[](vec3(0, 1, 1), vec3(1, 0, 1), vec3(1, 1, 0));
    vec3 sum = vec3(0.0);
    if (dimensions == NOISE_FOUR || abs(reach) > NOISE_NEAR) {
        for (int i = 0; i < 3; i++) {
            vec3 along = reach * diagonals[i];
            float way = dimensions == NOISE_FOUR
                            ? noise_perlin4(q + vec4(along, 0.0), seed, period) -
                                  noise_perlin4(q - vec4(along, 0.0), seed, period)
                            : noise_perlin3(q.xyz + along, seed, period) -
                                  noise_perlin3(q.xyz - along, seed, period);
            sum += way * (1.0 - diagonals[i]);
        }
        return sum;
    }
    vec3 cell = floor(q.xyz), d = q.xyz - cell;
    noise_cell3 c = noise_cell_at(cell, seed, period);
    [[unroll]] for (int i = 0; i < 3; i++) {
        vec3 along = reach * diagonals[i];
        sum += (noise_perlin_in(c, d + along) - noise_perlin_in(c, d - along)) * (1.0 - diagonals[i]);
    }
    return sum;
}

vec3 noise_curl(vec3 p, float frequency, float octaves, float persistence, float lacunarity,
                float seed, float amount, vec3 drift, float phase, float w, float period,
                float delta, int mode, int dimensions) {
    noise_octave o = noise_begin(p, frequency, octaves, lacunarity, seed, drift, phase + w, period);
    vec3 sum = vec3(0.0);
    float total = 0.0;
    if (mode == NOISE_PAPER) { // diagonal differences of one scalar: not free of divergence
        float reach = delta * frequency;
        for (int i = 0; i < o.count; i++) {
            sum += o.weight * noise_paper_differences(o.q, o.seed, o.period, reach, dimensions);
            noise_next(o, persistence);
            reach *= o.lacunarity;
        }
        return amount * sum;
    }
    for (int i = 0; i < o.count; i++) {
        sum += o.weight * noise_curl_base(o.q, o.seed, o.period, dimensions);
        total += o.weight;
        noise_next(o, persistence);
    }
    return amount * sum / total;
}

#endif
