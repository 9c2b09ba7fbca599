// Ranges of lib/noise.h, for lib/range_noise.glsl and src/field/noise_range.c. C compiles this text too
// (src/field/glsl.h).
#ifndef LIB_RANGE_NOISE_H
#define LIB_RANGE_NOISE_H
#include "lib/noise.h"
#include "lib/range.h"

// A base noise cannot change by more than its slope times the way. So an octave lies around its
// value at the middle of a box, by the slope times half the diagonal (in its cells), and in -1..1;
// where that says nothing it is not even evaluated.
//
// Slopes, by all gradients (values) that the corners can have: at a point d of the cell, along a
// direction e, a lattice noise rises by sum_c g_c . (w_c e + (e . grad w_c) (d - c)); each corner's
// gradient g_c, an edge of the cube, gives at most the sum of the greatest but one components of
// that vector. What is left, to find the worst d and e, is a search (ascent from 60000 points);
// its results are rounded up by 2 to 3 %. The kernels of simplex noise likewise. Distances to
// feature points change by no more than the way.
#define RANGE_PERLIN3 3.73f
#define RANGE_PERLIN4 3.80f
#define RANGE_VALUE 3.86f
#define RANGE_SIMPLEX3 7.2f
#define RANGE_SIMPLEX4 7.0f
#define RANGE_SIMPLEX4_CLOSED 7.2f
#define RANGE_CURL3 7.45f // the greatest that a component can be
#define RANGE_CURL4 7.6f
#define RANGE_CURL3_SLOPE 21.7f
#define RANGE_CURL4_SLOPE 23.9f

SHARED range1 range_fold(range1 n, int fractal) {
    range1 size = range_abs(n);
    if (fractal == NOISE_RIDGED)
        return range1((1.0f - size.high) * (1.0f - size.high), (1.0f - size.low) * (1.0f - size.low));
    if (fractal == NOISE_BILLOW) return size;
    return range1(0.5f + 0.5f * n.low, 0.5f + 0.5f * n.high);
}

SHARED range1 range_around(float v, float r) {
    return range1(clamp(v - r, -1.0f, 1.0f), clamp(v + r, -1.0f, 1.0f));
}

SHARED range1 range_cells(float f1, float f2, float reach, float power, int distance) {
    range1 first = range1(clamp(f1 - reach, 0.0f, 1.0f), clamp(f1 + reach, 0.0f, 1.0f));
    range1 second = range1(clamp(f2 - reach, 0.0f, 1.0f), clamp(f2 + reach, 0.0f, 1.0f)), at = first;
    if (distance == NOISE_F2) at = second;
    if (distance == NOISE_F2_F1)
        at = range1(max(max(second.low - first.high, f2 - f1 - 2.0f * reach), 0.0f),
                    min(second.high - first.low, f2 - f1 + 2.0f * reach));
    power = clamp(power, 0.01f, 16.0f);
    at = range1(max(pow(at.low, power) - 1e-4f, 0.0f), min(pow(at.high, power) + 1e-4f, 1.0f));
    if (distance == NOISE_F2_F1) return range1(2.0f * at.low - 1.0f, 2.0f * at.high - 1.0f);
    return range1(1.0f - 2.0f * at.high, 1.0f - 2.0f * at.low);
}

#endif
