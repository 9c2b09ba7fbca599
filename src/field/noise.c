// Bases of procedural noise and their octaves. Every function computes what the function of the
// same name in shaders/lib/noise.glsl computes, in the same order, so that both agree to rounding;
// the reasons are given there. Points have four coordinates; the fourth is unused in 3D.
#include "field/noise_parts.h"
#include <math.h>
#include <string.h>

enum { X, Y, Z, W };

static const uint32_t primes[4] = {0x8da6b343u, 0xd8163841u, 0xcb1ab31fu, 0x165667b1u};

static uint32_t whole(float v) { // as GLSL's uint(int(v)), defined for every float
    return v >= -2147483648.0f && v < 2147483648.0f ? (uint32_t)(int32_t)v : 0x80000000u;
}

static float wrap(float cell, float period) {
    return period > 0 ? cell - period * floorf((cell + 0.5f) / period) : cell;
}

static uint32_t lattice(float cell, float period, int axis) {
    return whole(wrap(cell, period)) * primes[axis];
}

static float fade(float t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

typedef struct cell {
    float at[4], inside[4], fade[4];
    uint32_t hash[2][4]; // shares of the near and the far side
} cell;

static cell find_cell(const float q[4], float period) {
    cell c;
    for (int i = 0; i < 4; i++) {
        c.at[i] = floorf(q[i]);
        c.inside[i] = q[i] - c.at[i];
        c.fade[i] = fade(c.inside[i]);
        c.hash[0][i] = lattice(c.at[i], period, i);
        c.hash[1][i] = lattice(c.at[i] + 1, period, i);
    }
    return c;
}

static float edge3(uint32_t h, const float d[4]) {
    uint32_t k = h >> 28;
    float u = k < 8 ? d[X] : d[Y];
    float v = k < 4 ? d[Y] : k == 12 || k == 14 ? d[X] : d[Z];
    return (k & 1 ? -u : u) + (k & 2 ? -v : v);
}

static float edge4(uint32_t h, const float d[4]) {
    uint32_t k = h >> 27;
    float u = k < 24 ? d[X] : d[Y], v = k < 16 ? d[Y] : d[Z], w = k < 8 ? d[Z] : d[W];
    return (k & 1 ? -u : u) + (k & 2 ? -v : v) + (k & 4 ? -w : w);
}

static float value(uint32_t h) {
    return (float)(noise_hash(h) >> 8) * (1.0f / 8388608.0f) - 1;
}

// Interpolation over the corners of a cell, 8 or 16, whose values are in order of their bits.
static float interpolate(float n[16], const float t[4], bool four) {
    int count = four ? 16 : 8;
    for (int axis = 0; count > 1; axis++, count /= 2)
        for (int i = 0; i < count / 2; i++) n[i] = mixf(n[2 * i], n[2 * i + 1], t[axis]);
    return n[0];
}

static float cell_noise(noise_base base, const cell *c, uint32_t seed, bool four) {
    float n[16];
    for (int i = 0; i < (four ? 16 : 8); i++) {
        uint32_t h = seed;
        float d[4];
        for (int axis = 0; axis < (four ? 4 : 3); axis++) {
            int far = i >> axis & 1;
            h += c->hash[far][axis];
            d[axis] = c->inside[axis] - (float)far;
        }
        if (base == NOISE_VALUE)
            n[i] = value(h);
        else
            n[i] = four ? edge4(noise_hash(h), d) : edge3(noise_hash(h), d);
    }
    float result = interpolate(n, c->fade, four);
    if (base == NOISE_VALUE) return result;
    return result * (four ? NOISE_PERLIN4 : NOISE_PERLIN3);
}

static float lattice_noise(noise_base base, const float q[4], uint32_t seed, float period,
                           bool four) {
    cell c = find_cell(q, period);
    return cell_noise(base, &c, seed, four);
}

// ---- simplex ----------------------------------------------------------------------------------

// Periods are explained in shaders/lib/noise.glsl.
typedef struct simplex_grid {
    int dimensions;
    float skew, back, reach, period;
} simplex_grid;

static simplex_grid find_grid(bool four, float period) {
    if (!four) return (simplex_grid){3, 1.0f / 3, 1.0f / 6, 0.5f, period};
    if (period > 0) return (simplex_grid){4, 1.0f / 3, 1.0f / 7, 9.0f / 19, period};
    return (simplex_grid){4, 0.309016994f, 0.138196601f, 0.5f, 0};
}

// A corner moved by whole periods to where the first one of its kind lies.
static void wrap_corner(const simplex_grid *g, float at[4]) {
    float whole_part = g->dimensions == 4 ? 7 : 6, cells = 0, turns[4], all = 0;
    for (int i = 0; i < g->dimensions; i++) cells += at[i];
    for (int i = 0; i < g->dimensions; i++) {
        turns[i] = floorf((whole_part * at[i] - cells + 0.5f) / (whole_part * g->period));
        all += turns[i];
    }
    for (int i = 0; i < g->dimensions; i++) at[i] -= turns[i] * g->period + all * (g->period / 3);
}

static float kernel(const simplex_grid *g, float at[4], const float d[4], uint32_t seed) {
    int dimensions = g->dimensions;
    float square = 0;
    if (g->period > 0) wrap_corner(g, at);
    uint32_t h = seed;
    for (int i = 0; i < dimensions; i++) {
        square += d[i] * d[i];
        h += lattice(at[i], 0, i);
    }
    float t = fmaxf(g->reach - square, 0);
    return t * t * t * t * (dimensions == 4 ? edge4(noise_hash(h), d) : edge3(noise_hash(h), d));
}

// From the corner at the base of the simplex to the opposite one, coordinates advance in falling
// order of the position inside the cell.
static float simplex_noise(const float q[4], uint32_t seed, float period, bool four) {
    simplex_grid g = find_grid(four, period);
    int dimensions = g.dimensions;
    float sum = 0, cells = 0, at[4], d[4], result = 0;
    for (int i = 0; i < dimensions; i++) sum += q[i];
    for (int i = 0; i < dimensions; i++) {
        at[i] = floorf(q[i] + sum * g.skew);
        cells += at[i];
    }
    for (int i = 0; i < dimensions; i++) d[i] = q[i] - (at[i] - cells * g.back);
    int rank[4] = {0, 0, 0, 0}; // how many coordinates it is ahead of
    for (int i = 0; i < dimensions; i++)
        for (int k = i + 1; k < dimensions; k++) rank[d[i] >= d[k] ? i : k]++;
    for (int step = 0; step <= dimensions; step++) {
        float corner[4], r[4];
        for (int i = 0; i < dimensions; i++) {
            float ahead = rank[i] >= dimensions - step ? 1 : 0;
            corner[i] = at[i] + ahead;
            r[i] = d[i] - ahead + (float)step * g.back;
        }
        result += kernel(&g, corner, r, seed);
    }
    if (!four) return result * NOISE_SIMPLEX3;
    return result * (period > 0 ? NOISE_SIMPLEX4_CLOSED : NOISE_SIMPLEX4);
}

// ---- Worley -----------------------------------------------------------------------------------

static float fraction(float v) {
    return v - floorf(v);
}

static void paper_hash(const float c[3], float out[3]) {
    float a[3] = {fraction(c[X] * 0.1031f), fraction(c[Y] * 0.1030f), fraction(c[Z] * 0.0973f)};
    float b[3] = {a[Y] + 33.33f, a[X] + 33.33f, a[Z] + 33.33f};
    float dot = a[X] * b[X] + a[Y] * b[Y] + a[Z] * b[Z];
    float e[3] = {a[X] + dot, a[Y] + dot, a[Z] + dot};
    out[X] = fraction((e[X] + e[Y]) * e[Z]);
    out[Y] = fraction((e[X] + e[X]) * e[Y]);
    out[Z] = fraction((e[Y] + e[X]) * e[X]);
}

static void feature(const float c[4], uint32_t seed, float period, float shift, bool four,
                    float out[4]) {
    if (shift >= 0) {
        float w[4];
        for (int i = 0; i < 4; i++) w[i] = wrap(c[i], period) + shift;
        if (four) {
            float xyz[3] = {w[X] + 7 * w[W], w[Y] + 7 * w[W], w[Z] + 7 * w[W]};
            float wxy[3] = {w[W], w[X], w[Y]}, last[3];
            paper_hash(xyz, out);
            paper_hash(wxy, last);
            out[W] = last[Z];
        } else {
            paper_hash(w, out);
        }
        return;
    }
    uint32_t h = seed;
    for (int i = 0; i < (four ? 4 : 3); i++) h += lattice(c[i], period, i);
    h = noise_hash(h);
    for (int i = 0; i < 4; i++)
        out[i] =
            four ? (float)(h >> (8 * i) & 255) / 256 : (float)(h >> 10 * (i % 3) & 1023) / 1024;
    if (!four) out[Z] = (float)(h >> 22) / 1024;
}

void noise_base_distances(const noise_desc *desc, const noise_octave *octave, float f[2]) {
    float at[4], inside[4], best[2] = {1, 1}, shift = desc->paper ? octave->shift : -1;
    for (int i = 0; i < 4; i++) {
        at[i] = floorf(octave->q[i]);
        inside[i] = octave->q[i] - at[i];
    }
    for (int k = 0; k < (desc->four ? 81 : 27); k++) {
        float o[4] = {(float)(k % 3) - 1, (float)(k / 3 % 3) - 1, (float)(k / 9 % 3) - 1,
                      (float)(k / 27) - 1};
        float c[4] = {at[X] + o[X], at[Y] + o[Y], at[Z] + o[Z], at[W] + o[W]}, point[4], square = 0;
        feature(c, octave->seed, octave->period, shift, desc->four, point);
        for (int i = 0; i < (desc->four ? 4 : 3); i++) {
            float r = o[i] + point[i] - inside[i];
            square += r * r;
        }
        best[1] = fminf(best[1], fmaxf(best[0], square));
        best[0] = fminf(best[0], square);
    }
    f[0] = sqrtf(best[0]);
    f[1] = sqrtf(best[1]);
}

static float worley_noise(const noise_desc *desc, const noise_octave *octave) {
    float f[2];
    noise_base_distances(desc, octave, f);
    return noise_cells(f[0], f[1], desc->power, desc->distance);
}

// ---- octaves ----------------------------------------------------------------------------------

noise_octave noise_begin(const noise_desc *desc, float3 p) {
    bool closed = desc->period >= 0.5f;
    float octaves = desc->octaves + 0.5f;
    return (noise_octave){
        .q = {(p.x + desc->drift[X]) * desc->frequency, (p.y + desc->drift[Y]) * desc->frequency,
              (p.z + desc->drift[Z]) * desc->frequency, desc->phase},
        .lacunarity = closed ? fmaxf(floorf(desc->lacunarity + 0.5f), 1) : desc->lacunarity,
        .period = closed ? floorf(desc->period + 0.5f) : 0,
        .weight = 1,
        .shift = desc->seed,
        .seed = noise_hash(whole(desc->seed) + NOISE_NEXT_SEED),
        .count = octaves >= 1 ? (int)fminf(octaves, NOISE_MAX_OCTAVES) : 1,
    };
}

void noise_next(noise_octave *o, const noise_desc *desc) {
    for (int i = 0; i < 4; i++) o->q[i] *= o->lacunarity;
    o->period *= o->lacunarity;
    o->weight *= fmaxf(desc->persistence, 0);
    o->shift += 1;
    o->seed += NOISE_NEXT_SEED;
}

float noise_base_value(noise_base base, const noise_desc *desc, const noise_octave *o) {
    switch (base) {
    case NOISE_SIMPLEX:
        return simplex_noise(o->q, o->seed, o->period, desc->four);
    case NOISE_WORLEY:
        return worley_noise(desc, o);
    default:
        return lattice_noise(base, o->q, o->seed, o->period, desc->four);
    }
}

float noise_eval(noise_base base, const noise_desc *desc, float3 p) {
    noise_octave o = noise_begin(desc, p);
    float sum = 0, total = 0;
    for (int i = 0; i < o.count; i++) {
        sum +=
            o.weight * noise_fold(clampf(noise_base_value(base, desc, &o), -1, 1), desc->fractal);
        total += o.weight;
        noise_next(&o, desc);
    }
    return desc->amplitude * sum / total;
}

// ---- curl -------------------------------------------------------------------------------------

static void gradient3(uint32_t k, float g[4]) {
    float u = k & 1 ? -1 : 1, v = k & 2 ? -1 : 1;
    memset(g, 0, 4 * sizeof *g);
    g[k < 8 ? X : Y] = u;
    g[k < 4 ? Y : k == 12 || k == 14 ? X : Z] = v;
}

static void gradient4(uint32_t k, float g[4]) {
    float u = k & 1 ? -1 : 1, v = k & 2 ? -1 : 1, w = k & 4 ? -1 : 1;
    memset(g, 0, 4 * sizeof *g);
    g[k < 24 ? X : Y] = u;
    g[k < 16 ? Y : Z] = v;
    g[k < 8 ? Z : W] = w;
}

static void curl_corner(const cell *c, int corner, uint32_t seed, bool four, float sum[3]) {
    float r[4] = {0}, w[4] = {1, 1, 1, 1}, away[3], g[3][4], potential[3];
    uint32_t h = seed;
    for (int axis = 0; axis < (four ? 4 : 3); axis++) {
        int far = corner >> axis & 1;
        float d = c->inside[axis];
        h += c->hash[far][axis];
        r[axis] = d - (float)far;
        w[axis] = far ? c->fade[axis] : 1 - c->fade[axis];
        if (axis < 3) away[axis] = (far ? 30.0f : -30.0f) * d * d * (d * (d - 2) + 1);
    }
    h = noise_hash(h);
    for (int i = 0; i < 3; i++) {
        if (four)
            gradient4(h >> (27 - 5 * i) & 31, g[i]);
        else
            gradient3(h >> (28 - 4 * i) & 15, g[i]);
        potential[i] = g[i][X] * r[X] + g[i][Y] * r[Y] + g[i][Z] * r[Z] + g[i][W] * r[W];
    }
    float rise[3] = {away[X] * w[Y] * w[Z] * w[W], w[X] * away[Y] * w[Z] * w[W],
                     w[X] * w[Y] * away[Z] * w[W]};
    float weight = w[X] * w[Y] * w[Z] * w[W];
    sum[X] += rise[Y] * potential[Z] - rise[Z] * potential[Y] + weight * (g[2][Y] - g[1][Z]);
    sum[Y] += rise[Z] * potential[X] - rise[X] * potential[Z] + weight * (g[0][Z] - g[2][X]);
    sum[Z] += rise[X] * potential[Y] - rise[Y] * potential[X] + weight * (g[1][X] - g[0][Y]);
}

// How far in cells the ends of a difference may lie for the polynomial of its middle's cell to do
// (shaders/lib/noise.glsl).
static const float paper_near = 0.025f;

// Perlin noise of one octave, `along` further in cells.
static float paper_perlin(const noise_desc *desc, const noise_octave *o, float reach,
                          const float along[3]) {
    float q[4];
    memcpy(q, o->q, sizeof q);
    cell c = find_cell(q, o->period);
    for (int i = 0; i < 3; i++) {
        q[i] += along[i];
        c.inside[i] += along[i];
        c.fade[i] = fade(c.inside[i]);
    }
    if (desc->four || fabsf(reach) > paper_near)
        return lattice_noise(NOISE_PERLIN, q, o->seed, o->period, desc->four);
    return cell_noise(NOISE_PERLIN, &c, o->seed, false);
}

static void paper_curl(const noise_desc *desc, float3 p, float out[3]) {
    noise_octave o = noise_begin(desc, p);
    float reach = desc->delta * desc->frequency;
    memset(out, 0, 3 * sizeof *out);
    for (int k = 0; k < o.count; k++) {
        for (int i = 0; i < 3; i++) { // one diagonal, and the other way
            float ahead[3], behind[3];
            for (int axis = 0; axis < 3; axis++) {
                ahead[axis] = axis == i ? 0 : reach;
                behind[axis] = -ahead[axis];
            }
            out[i] +=
                desc->amplitude * o.weight *
                (paper_perlin(desc, &o, reach, ahead) - paper_perlin(desc, &o, reach, behind));
        }
        noise_next(&o, desc);
        reach *= o.lacunarity;
    }
}

void noise_base_curl(const noise_desc *desc, const noise_octave *o, float out[3]) {
    cell c = find_cell(o->q, o->period);
    float curl[3] = {0}, factor = desc->four ? NOISE_PERLIN4 : NOISE_PERLIN3;
    for (int k = 0; k < (desc->four ? 16 : 8); k++) curl_corner(&c, k, o->seed, desc->four, curl);
    for (int k = 0; k < 3; k++) out[k] = factor * curl[k];
}

void noise_curl(const noise_desc *desc, float3 p, float out[3]) {
    if (desc->paper) {
        paper_curl(desc, p, out);
        return;
    }
    noise_octave o = noise_begin(desc, p);
    float sum[3] = {0}, total = 0;
    for (int i = 0; i < o.count; i++) {
        float curl[3];
        noise_base_curl(desc, &o, curl);
        for (int k = 0; k < 3; k++) sum[k] += o.weight * curl[k];
        total += o.weight;
        noise_next(&o, desc);
    }
    for (int k = 0; k < 3; k++) out[k] = desc->amplitude * sum[k] / total;
}
