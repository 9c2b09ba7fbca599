// Elements, cells that a thread does at once, and what is read and written at once.
//
// An element is four cells, or two of halves. Four of the latter can lie side by side, a bundle of the 16
// bytes that memory is read fastest in; who defines LBM_BUNDLED (LBM_BUNDLE > 1) moves whole bundles, and takes their
// elements one after the other. All others read and write elements.
#ifndef SIM_LBM_ELEMENT_GLSL
#define SIM_LBM_ELEMENT_GLSL

// LBM_LANES: cells of an element, 4, or 2 of halves.
#if LBM_LANES == 2
#define lbm_float vec2 // a number in each lane
#define lbm_bool bvec2
#define lbm_element uint
#define lbm_mask bool
#define LBM_EACH_LANE(X) X(0) X(1)
#else
#define lbm_float vec4
#define lbm_bool bvec4
#if LBM_HALF
#define lbm_element uvec2
#define lbm_mask bvec2
#else
#define lbm_element vec4
#define lbm_mask bvec4
#endif
#define LBM_EACH_LANE(X) X(0) X(1) X(2) X(3)
#endif
#if LBM_HALF // times a power of two that keeps small values whole; scalars may be kelvin: up to 13,800
#define LBM_AIR_SCALE 32768.0
#define LBM_SCALAR_SCALE 16.0
#else
#define LBM_AIR_SCALE 1.0
#define LBM_SCALAR_SCALE 1.0
#endif
#define LBM_LAYER (LBM_NX * LBM_NY)           // elements
#define LBM_ELEMENTS (LBM_LAYER * LBM_LAYERS) // of a direction
// LBM_BUNDLE: elements side by side, 4 or 1, which lie LBM_SPAN layers apart along z.
#define LBM_SPAN (LBM_LAYERS / LBM_BUNDLE)

// 1: the device is a processor (llvmpipe) that loads vectors word by word, so that two words of 64
// bits cost half of what four of 32 do, and that converts halves one by one. src/sim/README.md has
// figures.
#ifndef LBM_SOFTWARE
#define LBM_SOFTWARE 0
#endif
#ifndef LBM_BUNDLED
#define LBM_BUNDLED 0
#endif

// ---- cells of an element, as they lie in memory -----------------------------------------------

// next_lane: lane l gets what lane l + 1 has; last_lane: the other way round.
#if LBM_LANES == 2
lbm_float lbm_unpack(lbm_element e, const float scale) {
    return unpackHalf2x16(e) * (1.0 / scale);
}

lbm_element lbm_pack(const float scale, lbm_float v) {
    return packHalf2x16(v * scale);
}

lbm_element lbm_next_lane(lbm_element e) {
    return e >> 16 | e << 16;
}

lbm_element lbm_last_lane(lbm_element e) {
    return lbm_next_lane(e);
}
#elif LBM_HALF
#if LBM_SOFTWARE
// By hand: a half shifted into a float has an exponent that is 112 too low, which the factor mends.
// Halves too small to be normal are 0. Rounded to nearest even, as devices do.
#define LBM_BIAS 5192296858534827628530496329220096.0 // 2^112
lbm_float lbm_unpack(lbm_element e, const float scale) {
    ivec4 bits = ivec4(e.x << 16, e.x, e.y << 16, e.y) >> 3 & 0x8fffe000;
    return intBitsToFloat(bits) * (LBM_BIAS / scale);
}

lbm_element lbm_pack(const float scale, lbm_float v) {
    const float most = 65504.0 / LBM_BIAS;
    uvec4 bits = floatBitsToUint(clamp(v * (scale / LBM_BIAS), -most, most));
    bits += (bits >> 13 & 1u) + 0xfffu;
    uvec2 low = bits.xz >> 13 & 0x7fffu | bits.xz >> 16 & 0x8000u;
    return low | bits.yw << 3 & 0x7fff0000u | bits.yw & 0x80000000u;
}
#else
lbm_float lbm_unpack(lbm_element e, const float scale) {
    return vec4(unpackHalf2x16(e.x), unpackHalf2x16(e.y)) * (1.0 / scale);
}

lbm_element lbm_pack(const float scale, lbm_float v) {
    v *= scale;
    return uvec2(packHalf2x16(v.xy), packHalf2x16(v.zw));
}
#endif

lbm_element lbm_next_lane(lbm_element e) {
    return e >> 16 | e.yx << 16;
}

lbm_element lbm_last_lane(lbm_element e) {
    return e << 16 | e.yx >> 16;
}
#else
lbm_float lbm_unpack(lbm_element e, const float scale) {
    return e * (1.0 / scale);
}

lbm_element lbm_pack(const float scale, lbm_float v) {
    return v * scale;
}

lbm_element lbm_next_lane(lbm_element e) {
    return e.yzwx;
}

lbm_element lbm_last_lane(lbm_element e) {
    return e.wxyz;
}
#endif

// ---- what is read and written at once --------------------------------------------------------

#if LBM_BUNDLED
#define lbm_access uvec4
#define lbm_access_mask bvec4
#define LBM_STRIDE 1 // accesses from one column to the next
#define LBM_DEPTH LBM_SPAN // accesses along z
#define LBM_ROWS LBM_BUNDLE // elements of one
// The element LBM_SPAN layers above the last of a bundle is its first, one lane on.
lbm_access lbm_next_row(lbm_access a) {
    return uvec4(a.yzw, lbm_next_lane(a.x));
}

lbm_access lbm_last_row(lbm_access a) {
    return uvec4(lbm_last_lane(a.w), a.xyz);
}

// One by one: the first is taken, the next becomes the first, what is given is the last.
lbm_element lbm_take(lbm_access a) {
    return a.x;
}

void lbm_give(inout lbm_access a, lbm_element e) {
    a = uvec4(a.yzw, e);
}

lbm_access lbm_in_all_rows(lbm_element e) {
    return uvec4(e);
}
#else
#define lbm_access lbm_element
#define lbm_access_mask lbm_mask
#define LBM_STRIDE LBM_BUNDLE
#define LBM_DEPTH LBM_LAYERS
#define LBM_ROWS 1
lbm_access lbm_next_row(lbm_access a) {
    return lbm_next_lane(a);
}

lbm_access lbm_last_row(lbm_access a) {
    return lbm_last_lane(a);
}

lbm_element lbm_take(lbm_access a) {
    return a;
}

void lbm_give(out lbm_access a, lbm_element e) {
    a = e;
}

lbm_access lbm_in_all_rows(lbm_element e) {
    return e;
}
#endif

#endif
