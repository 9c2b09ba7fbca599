// What lib/lamps.glsl reads, in two stages: records of the lamps and, of every row of pixels of a tile,
// how near and how far away what it shows is (STAGE_RECORDS); then, a bit for each lamp, which of them
// reach the points of a tile (STAGE_MASKS). Words of bits have their place whatever is in them, so that
// threads need neither atomics nor each other, no list is ever full, and lamps stay in their order.
//
// A tile is a part of the view's frustum between two depths: a lamp is left out where its sphere misses
// the box around that, or one of the four sides (Olsson and Assarsson, "Tiled shading", 2011).
// LAMPS_BETWEEN: it begins at the eye, for what is seen before the surfaces.
#undef HAS_LIGHTS // the reader's table of lights is not read here
#define HAS_LIGHTS 0
#define LAMPS_ACCESS
#include "lib/frame.glsl"
#include "lib/lamps.glsl"
#ifndef HAS_DEPTH
#define HAS_DEPTH 0
#endif
#ifndef LAMPS_BETWEEN
#define LAMPS_BETWEEN 0
#endif
uniform sampler2D depth; //= input optional : how far away what is lit is (m)
uniform int width;       // of the picture
uniform int height;
uniform uint lamp_count;
uniform uint lamp_words;
uniform uint lamp_tiles_across;
#if LAMPS_TILES
layout(std430) buffer LampBounds { vec2 lamp_bounds[]; }; // m; of the rows, from the top
#endif

const float NOTHING = 1e8; // m: farther is what shows nothing

#if defined(STAGE_RECORDS)
void keep_lamp(uint index) {
    vec4 place = texelFetch(lamps, ivec2(0, index), 0), shine = texelFetch(lamps, ivec2(1, index), 0);
    vec4 spread = texelFetch(lamps, ivec2(3, index), 0);
    lamp_records[index] =
        lamp_record(vec4(place.xyz, spread.z > 0.5 ? -spread.y : spread.y), vec4(shine.rgb, place.w));
}

#if LAMPS_TILES
vec2 bounds_of_row(ivec2 first) {
    vec2 bounds = vec2(NOTHING, 0.0);
#if HAS_DEPTH
    vec2 scale = vec2(textureSize(depth, 0)) / vec2(width, height);
    for (int x = first.x; x < min(first.x + LAMPS_TILE, width); x++) {
        float deep = texelFetch(depth, ivec2((vec2(x, first.y) + 0.5) * scale), 0).r;
#if LAMPS_BETWEEN
        deep = min(deep, frame.lens.w);
#endif
        if (deep < NOTHING) bounds = vec2(min(bounds.x, deep), max(bounds.y, deep));
    }
#else
    bounds = frame.lens.zw;
#endif
#if LAMPS_BETWEEN
    bounds.x = 0.0;
#endif
    return bounds;
}
#endif

void main() {
    uvec2 thread = gl_GlobalInvocationID.xy;
    uint across = (lamp_tiles_across + 15u) & ~15u, index = thread.y * across + thread.x;
    if (index < lamp_count) keep_lamp(index);
    if (index == 0u) lamp_head = uvec4(lamp_count, lamp_words, lamp_tiles_across, 0u);
#if LAMPS_TILES
    if (thread.x < lamp_tiles_across && thread.y < uint(height))
        lamp_bounds[thread.y * lamp_tiles_across + thread.x] =
            bounds_of_row(ivec2(thread.x * LAMPS_TILE, thread.y));
#endif
}
#endif

#if defined(STAGE_MASKS)
// In the camera's space.
struct tile_volume {
    vec3 low, high;   // box
    vec4 slopes;      // left, right, lower, upper side, per metre of depth
    vec4 longer;      // lengths of the sides' normals
    float slack;      // m: points are lit from off the surface (shade/surface.glsl)
};

bool volume_of(uvec2 tile, out tile_volume v) {
    vec2 bounds = vec2(NOTHING, 0.0);
    uint first = tile.y * LAMPS_TILE, last = min(first + LAMPS_TILE, uint(height));
    for (uint y = first; y < last; y++) {
        vec2 row = lamp_bounds[y * lamp_tiles_across + tile.x];
        bounds = vec2(min(bounds.x, row.x), max(bounds.y, row.y));
    }
    vec2 from = vec2(tile * LAMPS_TILE) / vec2(width, height), to = from + float(LAMPS_TILE) / vec2(width, height);
    v.slopes = vec4(2.0 * vec2(from.x, to.x) - 1.0, 1.0 - 2.0 * vec2(to.y, from.y)) * frame.lens.xxyy;
    v.longer = sqrt(1.0 + v.slopes * v.slopes);
    vec4 near = v.slopes * bounds.x, far = v.slopes * bounds.y, least = min(near, far), most = max(near, far);
    v.low = vec3(least.xz, -bounds.y);
    v.high = vec3(most.yw, -bounds.x);
    v.slack = 2e-4 + 6e-4 * bounds.y;
    return bounds.x <= bounds.y;
}

bool lamp_meets(tile_volume v, vec4 place) {
    vec3 at = (frame.view * vec4(place.xyz, 1.0)).xyz, away = at - clamp(at, v.low, v.high);
    float reach = abs(place.w) + v.slack;
    vec4 inside = vec4(1.0, -1.0, 1.0, -1.0) * (at.xxyy + v.slopes * at.z); // of each side
    return place.w != 0.0 && dot(away, away) <= reach * reach && all(greaterThanEqual(inside, -reach * v.longer));
}

void main() {
    uvec2 thread = gl_GlobalInvocationID.xy;
    uint word = thread.x % lamp_words, tiles_down = (uint(height) + LAMPS_TILE - 1u) / LAMPS_TILE;
    uvec2 tile = uvec2(thread.x / lamp_words, thread.y);
    if (tile.x >= lamp_tiles_across || tile.y >= tiles_down) return;
    uint bits = 0u, first = 32u * word, end = min(first + 32u, lamp_count);
    tile_volume v;
    if (volume_of(tile, v))
        for (uint i = first; i < end; i++)
            if (lamp_meets(v, lamp_records[i].place)) bits |= 1u << (i - first);
    lamp_masks[(tile.y * lamp_tiles_across + tile.x) * lamp_words + word] = bits;
}
#endif
