// What lib/point_lights.glsl reads, in two stages: records of the point lights and, of every row of pixels of a tile,
// how near and how far away what it shows is (STAGE_RECORDS); then, a bit for each point light, which of them
// reach the points of a tile (STAGE_MASKS). Words of bits have their place whatever is in them, so that
// threads need neither atomics nor each other, no list is ever full, and point lights stay in their order.
//
// A tile is a part of the view's frustum between two depths: a point light is left out where its sphere misses
// the box around that, or one of the four sides (Olsson and Assarsson, "Tiled shading", 2011).
// POINT_LIGHTS_BETWEEN: it begins at the eye, for what is seen before the surfaces.
#undef HAS_LIGHTS // the reader's table of lights is not read here
#define HAS_LIGHTS 0
#define POINT_LIGHTS_ACCESS
#include "lib/frame.glsl"
#include "lib/point_lights.glsl"
#ifndef HAS_DEPTH
#define HAS_DEPTH 0
#endif
#ifndef POINT_LIGHTS_BETWEEN
#define POINT_LIGHTS_BETWEEN 0
#endif
uniform sampler2D depth; //= input optional : how far away what is lit is (m)
uniform int width;       // of the picture
uniform int height;
uniform uint point_light_count;
uniform uint point_light_words;
uniform uint point_light_tiles_across;
#if POINT_LIGHTS_TILES
layout(std430) buffer PointLightBounds { vec2 point_light_bounds[]; }; // m; of the rows, from the top
#endif

const float NOTHING = 1e8; // m: farther is what shows nothing

#if defined(STAGE_RECORDS)
void keep_point_light(uint index) {
    vec4 place = texelFetch(point_lights, ivec2(0, index), 0), shine = texelFetch(point_lights, ivec2(1, index), 0);
    vec4 spread = texelFetch(point_lights, ivec2(3, index), 0);
    point_light_records[index] =
        point_light_record(vec4(place.xyz, spread.z > 0.5 ? -spread.y : spread.y), vec4(shine.rgb, place.w));
}

#if POINT_LIGHTS_TILES
vec2 bounds_of_row(ivec2 first) {
    vec2 bounds = vec2(NOTHING, 0.0);
#if HAS_DEPTH
    vec2 scale = vec2(textureSize(depth, 0)) / vec2(width, height);
    for (int x = first.x; x < min(first.x + POINT_LIGHTS_TILE, width); x++) {
        float deep = texelFetch(depth, ivec2((vec2(x, first.y) + 0.5) * scale), 0).r;
#if POINT_LIGHTS_BETWEEN
        deep = min(deep, frame.lens.w);
#endif
        if (deep < NOTHING) bounds = vec2(min(bounds.x, deep), max(bounds.y, deep));
    }
#else
    bounds = frame.lens.zw;
#endif
#if POINT_LIGHTS_BETWEEN
    bounds.x = 0.0;
#endif
    return bounds;
}
#endif

void main() {
    uvec2 thread = gl_GlobalInvocationID.xy;
    uint across = (point_light_tiles_across + 15u) & ~15u, index = thread.y * across + thread.x;
    if (index < point_light_count) keep_point_light(index);
    if (index == 0u) point_light_head = uvec4(point_light_count, point_light_words, point_light_tiles_across, 0u);
#if POINT_LIGHTS_TILES
    if (thread.x < point_light_tiles_across && thread.y < uint(height))
        point_light_bounds[thread.y * point_light_tiles_across + thread.x] =
            bounds_of_row(ivec2(thread.x * POINT_LIGHTS_TILE, thread.y));
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
    uint first = tile.y * POINT_LIGHTS_TILE, last = min(first + POINT_LIGHTS_TILE, uint(height));
    for (uint y = first; y < last; y++) {
        vec2 row = point_light_bounds[y * point_light_tiles_across + tile.x];
        bounds = vec2(min(bounds.x, row.x), max(bounds.y, row.y));
    }
    vec2 from = vec2(tile * POINT_LIGHTS_TILE) / vec2(width, height), to = from + float(POINT_LIGHTS_TILE) / vec2(width, height);
    v.slopes = (vec4(2.0 * vec2(from.x, to.x) - 1.0, 1.0 - 2.0 * vec2(to.y, from.y)) - frame.shift.xxyy) * frame.lens.xxyy;
    v.longer = sqrt(1.0 + v.slopes * v.slopes);
    vec4 near = v.slopes * bounds.x, far = v.slopes * bounds.y, least = min(near, far), most = max(near, far);
    v.low = vec3(least.xz, -bounds.y);
    v.high = vec3(most.yw, -bounds.x);
    v.slack = 2e-4 + 6e-4 * bounds.y;
    return bounds.x <= bounds.y;
}

bool point_light_meets(tile_volume v, vec4 place) {
    vec3 at = (frame.view * vec4(place.xyz, 1.0)).xyz, away = at - clamp(at, v.low, v.high);
    float reach = abs(place.w) + v.slack;
    vec4 inside = vec4(1.0, -1.0, 1.0, -1.0) * (at.xxyy + v.slopes * at.z); // of each side
    return place.w != 0.0 && dot(away, away) <= reach * reach && all(greaterThanEqual(inside, -reach * v.longer));
}

void main() {
    uvec2 thread = gl_GlobalInvocationID.xy;
    uint word = thread.x % point_light_words, tiles_down = (uint(height) + POINT_LIGHTS_TILE - 1u) / POINT_LIGHTS_TILE;
    uvec2 tile = uvec2(thread.x / point_light_words, thread.y);
    if (tile.x >= point_light_tiles_across || tile.y >= tiles_down) return;
    uint bits = 0u, first = 32u * word, end = min(first + 32u, point_light_count);
    tile_volume v;
    if (volume_of(tile, v))
        for (uint i = first; i < end; i++)
            if (point_light_meets(v, point_light_records[i].place)) bits |= 1u << (i - first);
    point_light_masks[(tile.y * point_light_tiles_across + tile.x) * point_light_words + word] = bits;
}
#endif
