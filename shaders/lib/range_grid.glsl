// Ranges of grids and palettes, from textures of the least and greatest values.
//
// A grid's texture (src/pass/ranges.c) has levels beside each other along x, each of half the
// size of the one before it, rounded up. At even z are the least values, above them the greatest.
#ifndef LIB_RANGE_GRID_GLSL
#define LIB_RANGE_GRID_GLSL
#include "lib/range.glsl"
#include "lib/grid.glsl"

// Of the bricks at eight corners, of a level that lies at x.
range4 range_corners(sampler3D ranges, int x, ivec3 a, ivec3 b) {
    vec4 least = vec4(RANGE_END), most = vec4(-RANGE_END);
    for (int i = 0; i < 8; i++) {
        ivec3 at = mix(a, b, notEqual(ivec3(i) & ivec3(1, 2, 4), ivec3(0)));
        least = min(least, texelFetch(ranges, ivec3(x + at.x, at.y, 2 * at.z), 0));
        most = max(most, texelFetch(ranges, ivec3(x + at.x, at.y, 2 * at.z + 1), 0));
    }
    return range_vec(range_make(least.x, most.x), range_make(least.y, most.y),
                     range_make(least.z, most.z), range_make(least.w, most.w));
}

// Of all bricks from a to b, of a level that lies at x.
range4 range_each(sampler3D ranges, int x, ivec3 a, ivec3 b) {
    vec4 least = vec4(RANGE_END), most = vec4(-RANGE_END);
    ivec3 side = b - a + 1;
    for (int i = 0; i < side.x * side.y * side.z; i++) {
        ivec3 at = a + ivec3(i % side.x, i / side.x % side.y, i / (side.x * side.y));
        least = min(least, texelFetch(ranges, ivec3(x + at.x, at.y, 2 * at.z), 0));
        most = max(most, texelFetch(ranges, ivec3(x + at.x, at.y, 2 * at.z + 1), 0));
    }
    return range_vec(range_make(least.x, most.x), range_make(least.y, most.y),
                     range_make(least.z, most.z), range_make(least.w, most.w));
}

// Over a box given in bricks, of which there are `count` along each axis: at the first level where
// no more than two along an axis cover it (hierarchical min/max; Greene, "Hierarchical Z-buffer
// visibility", 1993). Where these do not agree, at one where they are smaller: they reach far
// beyond the box.
range4 range_bricks(sampler3D ranges, vec3 count, vec3 low, vec3 high) {
    const int MANY = 4;
    ivec3 size = ivec3(ceil(count));
    ivec3 a = ivec3(clamp(floor(low), vec3(0.0), vec3(size - 1)));
    ivec3 b = ivec3(clamp(floor(high), vec3(0.0), vec3(size - 1)));
    ivec3 fine_a = a, fine_b = b;
    int x = 0, fine_x = 0;
    while (any(greaterThan(b - a, ivec3(1)))) {
        x += size.x;
        size.x = (size.x + 1) / 2;
        a >>= 1;
        b >>= 1;
        if (all(lessThan(fine_b - fine_a, ivec3(MANY)))) continue;
        fine_a = a;
        fine_b = b;
        fine_x = x;
    }
    range4 all_of = range_corners(ranges, x, a, b);
    return fine_x == x || all_of.low == all_of.high ? all_of : range_each(ranges, fine_x, fine_a, fine_b);
}

// Over a box given in texels, by these themselves, where no more than RANGE_TEXELS along an axis take
// part in what is sampled there: bricks would be coarser than the box is.
const int RANGE_TEXELS = 6;
#if SAMPLING == SAMPLING_CUBIC
const int RANGE_REACH = 1; // beyond the two texels of a linear filter
#else
const int RANGE_REACH = 0;
#endif

bool range_few_texels(vec3 low, vec3 high, ivec3 size, out ivec3 a, out ivec3 b) {
    const float inexact = 1.0 / 128.0; // filters are
    a = clamp(ivec3(floor(low - 0.5 - inexact)) - RANGE_REACH, ivec3(0), size - 1);
    b = clamp(ivec3(floor(high + 0.5 + inexact)) + RANGE_REACH, ivec3(0), size - 1);
    return all(lessThan(b - a, ivec3(RANGE_TEXELS)));
}

struct range_sum {
    vec4 low, high;
};

void range_add_texel(inout range_sum sum, vec4 v) {
    bvec4 number = lessThanEqual(abs(v), vec4(65504.0));
    sum.low = min(sum.low, mix(vec4(-RANGE_END), v, number));
    sum.high = max(sum.high, mix(vec4(RANGE_END), v, number));
}

range4 range_summed(range_sum s) {
    return range_vec(range_make(s.low.x, s.high.x), range_make(s.low.y, s.high.y),
                     range_make(s.low.z, s.high.z), range_make(s.low.w, s.high.w));
}

// Of texels from a to b; those of a sparse grid are looked up as grid_brick (lib/grid.glsl) does.
range4 range_texels(sampler3D values, ivec3 a, ivec3 b) {
    range_sum sum = range_sum(vec4(RANGE_END), vec4(-RANGE_END));
    for (int z = a.z; z <= b.z; z++)
        for (int y = a.y; y <= b.y; y++)
            for (int x = a.x; x <= b.x; x++) range_add_texel(sum, texelFetch(values, ivec3(x, y, z), 0));
    return range_summed(sum);
}

range4 range_texels(sampler3D atlas, usampler3D index, ivec3 a, ivec3 b) {
    range_sum sum = range_sum(vec4(RANGE_END), vec4(-RANGE_END));
    for (int z = a.z; z <= b.z; z++)
        for (int y = a.y; y <= b.y; y++)
            for (int x = a.x; x <= b.x; x++) {
                uint place = texelFetch(index, ivec3(x, y, z) >> 3, 0).r;
                ivec3 corner = ivec3(place & 1023u, (place >> 10) & 1023u, (place >> 20) & 1023u) * 9;
                range_add_texel(sum, place == 0u ? vec4(0.0) : texelFetch(atlas, corner + (ivec3(x, y, z) & 7), 0));
            }
    return range_summed(sum);
}

// Of a grid whose box begins at `from` and is 1 / scale large: nothing outside of the active box,
// `least` to `most`. SIZE: in texels; TEXELS: what follows of range_texels.
#define RANGE_FETCH(SIZE, TEXELS)                                                                  \
    range4 none = range_number(vec4(0.0));                                                         \
    if (any(greaterThan(p.low, most)) || any(lessThan(p.high, least)) ||                           \
        any(greaterThan(least, most)))                                                             \
        return none;                                                                               \
    vec3 low = (max(p.low, least) - from) * scale, high = (min(p.high, most) - from) * scale;      \
    range4 inside = count.x > 0.0 ? range_bricks(ranges, count, low * count, high * count)         \
                                  : range_unknown4();                                              \
    ivec3 a, b;                                                                                    \
    if (inside.low != inside.high && range_few_texels(low * vec3(SIZE), high * vec3(SIZE), SIZE, a, b)) \
        inside = range_texels TEXELS;                                                              \
    bool leaves = any(lessThan(p.low, least)) || any(greaterThan(p.high, most));                   \
    return leaves ? range_union(inside, none) : inside

range4 range_fetch(sampler3D ranges, sampler3D values, range3 p, vec3 from, vec3 scale, vec3 least, vec3 most, vec3 count) {
    ivec3 size = textureSize(values, 0);
    RANGE_FETCH(size, (values, a, b));
}

range4 range_fetch(sampler3D ranges, sampler3D atlas, usampler3D index, ivec3 size, range3 p, vec3 from, vec3 scale, vec3 least, vec3 most, vec3 count) {
    RANGE_FETCH(size, (atlas, index, a, b));
}

// Greatest width (m, as grid_width) of the samples that ranges are asked for; a shader may set it.
// Below 0: they may be of any.
float range_width = -1.0;

// By bricks of one that repeats; from a to b of them, of `count`. Their levels repeat like the grid
// while they can be halved.
range4 range_repeated(sampler3D ranges, vec3 count, vec3 a, vec3 b) {
    int x = 0;
    vec3 size = count;
    while (any(greaterThan(b - a, vec3(1.0)))) {
        if (any(notEqual(fract(0.5 * size), vec3(0.0)))) return range_bricks(ranges, count, vec3(0.0), count);
        x += int(size.x);
        size *= 0.5;
        a = floor(0.5 * a);
        b = floor(0.5 * b);
    }
    a -= size * floor((a + 0.5) / size);
    b -= size * floor((b + 0.5) / size);
    return range_corners(ranges, x, ivec3(a), ivec3(b));
}

// Of one that repeats, taken at levels where samples are as wide as so many texels: those filter as
// far as three times the width.
range4 range_tile(sampler3D ranges, sampler3D values, range3 p, float width, vec3 from, vec3 scale, vec3 count) {
    vec3 size = vec3(textureSize(values, 0)), low = (p.low - from) * scale, high = (p.high - from) * scale;
    if (width < 0.0 || any(notEqual(count, floor(count))) || any(greaterThanEqual(high - low, vec3(1.0))) ||
        any(greaterThan(abs(low), vec3(1e4))))
        return range_bricks(ranges, count, vec3(0.0), count);
    const float inexact = 1.0 / 128.0; // filters are
    vec3 a = floor(low * size - 0.5 - inexact), b = floor(high * size + 0.5 + inexact);
    if (width > 1.0 || any(greaterThanEqual(b - a, vec3(RANGE_TEXELS)))) {
        float beside = width > 1.0 ? 0.75 * width : 0.0; // bricks have 4 texels
        return range_repeated(ranges, count, floor(low * count - beside), floor(high * count + beside));
    }
    range_sum sum = range_sum(vec4(RANGE_END), vec4(-RANGE_END));
    for (float z = a.z; z <= b.z; z++)
        for (float y = a.y; y <= b.y; y++)
            for (float x = a.x; x <= b.x; x++) {
                vec3 at = vec3(x, y, z);
                range_add_texel(sum, texelFetch(values, ivec3(at - size * floor((at + 0.5) / size)), 0));
            }
    return range_summed(sum);
}

// Of a palette, between two positions in 0..1.
range4 range_palette(sampler2D texels, range1 at) {
    float size = float(textureSize(texels, 0).x);
    int first = int(clamp(floor(at.low * size - 0.51), 0.0, size - 1.0)); // filtered: two texels
    int last = int(clamp(floor(at.high * size + 0.51), 0.0, size - 1.0));
    range4 all = range4(vec4(RANGE_END), vec4(-RANGE_END));
    for (int i = first; i <= last; i++) {
        vec4 texel = texelFetch(texels, ivec2(i, 0), 0);
        all = range4(min(all.low, texel), max(all.high, texel));
    }
    return range4(all.low * (1.0 - 1e-3), all.high * (1.0 + 1e-3)); // filters are inexact
}

#endif
