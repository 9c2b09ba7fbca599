// Least and greatest values of a grid over bricks of its texels, and of bricks of those, level after
// level, laid out as lib/range_grid.glsl says. Not a pass of its own: see src/pass/ranges.c.
//
// Cubic interpolation in a brick reaches two texels beyond it. So a brick is made of whole blocks of
// two by two by two texels, some of which its neighbours need as well: a group finds those of as
// many bricks as 16 texels a side have, and looks at each texel once.
#ifndef BRICK // texels a side: 4 or 8
#define BRICK 4
#endif
#ifndef PACKED
#define PACKED 0
#endif
#ifndef FORMAT
#define FORMAT rgba16f
#endif
layout(local_size_x = 256) in;
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
const int BRICKS = 16 / BRICK, BLOCKS = 10, OWN = BRICK / 2, REACH = OWN + 2; // a side

// Packed where they would not fit, which takes longer. What is stored are halves all the same.
#if PACKED
#define BOUND uvec2
BOUND bound_put(vec4 v) { return uvec2(packHalf2x16(v.xy), packHalf2x16(v.zw)); }
vec4 bound_get(BOUND b) { return vec4(unpackHalf2x16(b.x), unpackHalf2x16(b.y)); }
#else
#define BOUND vec4
#define bound_put(v) (v)
#define bound_get(b) (b)
#endif
shared BOUND least[BLOCKS * BLOCKS * BLOCKS], most[BLOCKS * BLOCKS * BLOCKS];

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

ivec3 place(int i, int side) {
    return ivec3(i % side, i / side % side, i / (side * side));
}

void find_block(int i, ivec3 corner) {
    ivec3 end = ivec3(size);
    vec4 low = vec4(END), high = vec4(-END);
    for (int k = 0; k < 8; k++) {
        ivec3 texel = corner + 2 * place(i, BLOCKS) + place(k, 2);
        vec4 v = value(repeats ? (texel + 2 * end) % end : clamp(texel, ivec3(0), end - 1));
        bvec4 number = lessThanEqual(abs(v), vec4(65504.0));
        low = min(low, mix(vec4(-END), v, number));
        high = max(high, mix(vec4(END), v, number));
    }
    least[i] = bound_put(low);
    most[i] = bound_put(high);
}

#ifdef SPARSE
shared bool held;

// Whether the index says that there is nothing in the group's bricks nor in those around them: so it
// is with most of a large sparse grid. Called by all threads alike.
bool is_empty(int i) {
    if (repeats) return false;
    if (i == 0) held = false;
    barrier();
    ivec3 last = (ivec3(size) - 1) >> 3, cell = 2 * ivec3(gl_WorkGroupID) - 1 + place(i, 4);
    if (i < 64 && texelFetch(index, clamp(cell, ivec3(0), last), 0).r != 0u) held = true;
    barrier();
    return !held;
}
#else
bool is_empty(int i) {
    return false;
}
#endif

void from_values() {
    int i = int(gl_LocalInvocationIndex);
    ivec3 own = BRICKS * ivec3(gl_WorkGroupID) + place(i, BRICKS);
    bool stores = i < BRICKS * BRICKS * BRICKS && all(lessThan(own, ivec3(count)));
    if (is_empty(i)) {
        if (stores) store(own, vec4(0.0), vec4(0.0));
        return;
    }
    ivec3 corner = 16 * ivec3(gl_WorkGroupID) - 2;
    for (int k = i; k < BLOCKS * BLOCKS * BLOCKS; k += 256) find_block(k, corner);
    barrier();
    if (!stores) return;
    ivec3 brick = place(i, BRICKS);
    vec4 low = vec4(END), high = vec4(-END);
    for (int k = 0; k < REACH * REACH * REACH; k++) {
        ivec3 block = OWN * brick + place(k, REACH);
        int b = block.x + BLOCKS * (block.y + BLOCKS * block.z);
        low = min(low, bound_get(least[b]));
        high = max(high, bound_get(most[b]));
    }
    store(own, low, high);
}

void from_level() {
    ivec3 end = ivec3(count);
    int i = int(gl_GlobalInvocationID.x);
    if (i >= end.x * end.y * end.z) return;
    ivec3 at = ivec3(i % end.x, i / end.x % end.y, i / (end.x * end.y));
    vec4 low = vec4(END), high = vec4(-END);
    for (int k = 0; k < 8; k++) {
        ivec3 part = min(2 * at + place(k, 2), ivec3(from) - 1);
        low = min(low, imageLoad(ranges, ivec3(from_x + part.x, part.y, 2 * part.z)));
        high = max(high, imageLoad(ranges, ivec3(from_x + part.x, part.y, 2 * part.z + 1)));
    }
    store(at, low, high);
}

void main() {
    if (level == 0)
        from_values();
    else
        from_level();
}
