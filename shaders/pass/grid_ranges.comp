// Least and greatest values of a grid over bricks of its texels, and of bricks of those, level after
// level, laid out as lib/range_grid.glsl says. Not a pass of its own: see src/pass/ranges.c.
#ifndef BRICK // texels a side
#define BRICK 4
#endif
#ifndef FORMAT
#define FORMAT rgba16f
#endif
layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler3D values;  //= input : the grid; of a sparse one the atlas of its bricks
uniform usampler3D index;  //= input optional : of a sparse grid, where the bricks lie
layout(FORMAT) uniform image3D ranges; //= output rgba16f : the least values at even z, the greatest above them
uniform vec3 size;         // of the grid
uniform vec3 count;        // of bricks, at the level at hand
uniform vec3 from;         // and at the one before
uniform int level;
uniform bool repeats;      // the grid goes on beyond its sides as it begins at the others
uniform int x;             // where the level lies
uniform int from_x;        // and the one before

#define END uintBitsToFloat(0x7f800000u) // of a value that is no number nothing is known
const int SHARE = 8, REACH = BRICK / 2 + 2;     // threads a brick; texels along their part of it

shared vec4 least[64], most[64];

#ifdef SPARSE
vec4 value(ivec3 at) {
    uint place = texelFetch(index, at >> 3, 0).r;
    ivec3 corner = ivec3(place & 1023u, (place >> 10) & 1023u, (place >> 20) & 1023u) * 9;
    return place == 0u ? vec4(0.0) : texelFetch(values, corner + (at & 7), 0);
}
#else
vec4 value(ivec3 at) {
    return texelFetch(values, at, 0);
}
#endif

void store(ivec3 at, vec4 low, vec4 high) {
    imageStore(ranges, ivec3(x + at.x, at.y, 2 * at.z), low);
    imageStore(ranges, ivec3(x + at.x, at.y, 2 * at.z + 1), high);
}

// Cubic interpolation in a brick reaches two texels beyond it. Each thread has an eighth of all.
void from_values(ivec3 at, bool inside) {
    uint i = gl_LocalInvocationIndex;
    ivec3 part = ivec3(i, i >> 1, i >> 2) & 1, corner = BRICK * at - 2 + REACH * part;
    vec4 low = vec4(END), high = vec4(-END);
    for (int k = 0; inside && k < REACH * REACH * REACH; k++) {
        ivec3 texel = corner + ivec3(k % REACH, k / REACH % REACH, k / (REACH * REACH));
        ivec3 end = ivec3(size);
        vec4 v = value(repeats ? (texel + 2 * end) % end : clamp(texel, ivec3(0), end - 1));
        bvec4 number = lessThanEqual(abs(v), vec4(65504.0));
        low = min(low, mix(vec4(-END), v, number));
        high = max(high, mix(vec4(END), v, number));
    }
    least[i] = low;
    most[i] = high;
    barrier();
    if (!inside || i % SHARE != 0u) return;
    for (uint k = i + 1u; k < i + SHARE; k++) {
        low = min(low, least[k]);
        high = max(high, most[k]);
    }
    store(at, low, high);
}

void from_level(ivec3 at) {
    vec4 low = vec4(END), high = vec4(-END);
    for (int k = 0; k < 8; k++) {
        ivec3 part = min(2 * at + (ivec3(k, k >> 1, k >> 2) & 1), ivec3(from) - 1);
        low = min(low, imageLoad(ranges, ivec3(from_x + part.x, part.y, 2 * part.z)));
        high = max(high, imageLoad(ranges, ivec3(from_x + part.x, part.y, 2 * part.z + 1)));
    }
    store(at, low, high);
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (level == 0) at.x /= SHARE;
    bool inside = all(lessThan(at, ivec3(count)));
    if (level == 0)
        from_values(at, inside);
    else if (inside)
        from_level(at);
}
