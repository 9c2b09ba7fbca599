// What a splat is, and how much of it is in a pixel.

const float PI = 3.14159265;
const uint TILE = 16u;
const float LEAST_THROUGH = 1.0 / 1024.0; // what shines through less hides all
const float MOST = 60000.0; // of a colour: half floats hold it

// Sums are in these parts of 1, of colours and of the logarithm of what shines through. So a pixel
// may be a million bright; rounding is by chance, which is right on average however faint a splat.
const float UNIT = 4096.0, LOG_UNIT = 65536.0, PART_MOST = 1e6;

#if BLEND == BLEND_WEIGHTED
#define CHANNELS 5u // weighted colour, weight, logarithm
#else
#define CHANNELS 3u
#endif

struct splat {
    vec2 at;      // pixels, of its middle
    float depth;  // m
    float radius; // pixels
    vec2 along;   // unit, of the picture's x or of the streak
    float reach;  // pixels from the middle to the middle of each round end
    float cell;   // of the flipbook
    vec3 color;
    float opacity;
    uint seed;    // of chance: the same wherever in the lists it is
};

// ---- as it is kept ----------------------------------------------------------------------------

layout(std430) buffer SplatRecords { uvec4 splat_records[]; }; // three for each
layout(std430) buffer SplatSums { uint splat_sums[]; };        // CHANNELS for each pixel
layout(std430) buffer SplatHead { uint splat_found; uint splat_listed; };
layout(std430) buffer SplatTiles { uvec2 splat_tiles[]; };     // where the list of each begins and ends
layout(std430) buffer SplatEntries { uint splat_entries[]; };  // numbers of records

void splat_keep(uint index, splat s) {
    splat_records[3u * index] = uvec4(floatBitsToUint(s.at), floatBitsToUint(s.radius), floatBitsToUint(s.reach));
    splat_records[3u * index + 1u] =
        uvec4(floatBitsToUint(s.along), floatBitsToUint(s.depth), floatBitsToUint(s.cell));
    splat_records[3u * index + 2u] =
        uvec4(packHalf2x16(s.color.rg), packHalf2x16(vec2(s.color.b, s.opacity)), s.seed, 0u);
}

splat splat_kept(uint index) {
    uvec4 a = splat_records[3u * index], b = splat_records[3u * index + 1u], c = splat_records[3u * index + 2u];
    vec2 last = unpackHalf2x16(c.y);
    return splat(uintBitsToFloat(a.xy), uintBitsToFloat(b.z), uintBitsToFloat(a.z), uintBitsToFloat(b.xy),
                 uintBitsToFloat(a.w), uintBitsToFloat(b.w), vec3(unpackHalf2x16(c.x), last.x), last.y, c.z);
}

// Whether nothing of it can be in a pixel, by a third of what is kept.
bool splat_misses(uint index, ivec2 pixel) {
    uvec4 a = splat_records[3u * index];
    vec2 offset = vec2(pixel) + 0.5 - uintBitsToFloat(a.xy);
    float far = uintBitsToFloat(a.z) + uintBitsToFloat(a.w);
    return dot(offset, offset) >= (HAS_SPRITE == 1 ? 2.0 : 1.0) * far * far; // to a picture's corner
}

// As it would be kept.
splat splat_rounded(splat s) {
    s.color = vec3(unpackHalf2x16(packHalf2x16(s.color.rg)), unpackHalf2x16(packHalf2x16(s.color.bb)).x);
    s.opacity = unpackHalf2x16(packHalf2x16(vec2(s.opacity))).x;
    return s;
}

// ---- pixels -----------------------------------------------------------------------------------

// Round ones are (1 - r^2)^2, near to a Gaussian and with an end. What they cover, in squares of the
// radius, and a line through the middle, in radii:
const float ROUND_AREA = PI / 3.0, ROUND_LINE = 16.0 / 15.0;

#if HAS_SPRITE
vec4 sprite_at(vec2 uv, float which) {
    float number = mod(floor(which), flipbook.x * flipbook.y);
    vec2 corner = vec2(mod(number, flipbook.x), floor(number / flipbook.x));
    vec2 texel = 0.5 * flipbook / vec2(textureSize(sprite, 0)); // neighbours stay out
    return max(textureLod(sprite, (corner + clamp(uv, texel, 1.0 - texel)) / flipbook, 0.0), 0.0);
}
#endif

// Colour and opacity that it has at a point of the picture, `offset` pixels from its middle. Precise:
// the same wherever it is computed, in a list's turn or for want of a place there.
vec4 splat_at(splat s, vec2 offset) {
    precise vec2 q = vec2(offset.x * s.along.x + offset.y * s.along.y, offset.y * s.along.x - offset.x * s.along.y);
#if HAS_SPRITE
    q /= vec2(s.radius + s.reach, s.radius);
    if (max(abs(q.x), abs(q.y)) >= 1.0) return vec4(0.0);
    vec4 c = sprite_at(0.5 + 0.5 * q, s.cell);
    return vec4(s.color * c.rgb, s.opacity * min(c.a, 1.0));
#else
    q.x = max(abs(q.x) - s.reach, 0.0);
    precise float rest = max(1.0 - (q.x * q.x + q.y * q.y) / (s.radius * s.radius), 0.0);
    precise float covers = s.opacity * rest * rest;
    return vec4(s.color, covers);
#endif
}

// What of it is before the surface in a pixel.
float splat_visible(ivec2 pixel, float away) {
#if HAS_DEPTH
    ivec2 size = textureSize(depth, 0);
    vec2 uv = (vec2(pixel) + 0.5) / picture;
    float before = texelFetch(depth, clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1), 0).r - away;
    return soften > 0.0 ? clamp(before / soften, 0.0, 1.0) : before > 0.0 ? 1.0 : 0.0;
#else
    return 1.0;
#endif
}

// ---- sums -------------------------------------------------------------------------------------

struct splat_sum {
    uvec3 color;
    uint weight, log;
};

// Nearer ones count more (McGuire and Bavoil 2013, section 4, where weights fall with the fourth
// power of the distance too).
float splat_weight(float away) {
    float near = weight_distance / away;
    return clamp(near * near * near * near, 1.0 / 256.0, 64.0);
}

splat_sum splat_part(vec3 light, float opacity, float away, uint seed, ivec2 pixel) {
    float chance = float(random_hash(seed ^ random_hash(uint(pixel.y) << 16 | uint(pixel.x))) >> 8) / 16777216.0;
#if BLEND == BLEND_WEIGHTED
    float covered = min(opacity, 0.999), weight = covered * splat_weight(away);
    precise vec3 sum = min(weight * light, PART_MOST) * UNIT + chance;
    precise vec2 more = vec2(weight * UNIT, -log2(1.0 - covered) * LOG_UNIT) + chance;
    return splat_sum(uvec3(sum), uint(more.x), uint(more.y));
#else
    precise vec3 sum = min(opacity * light, PART_MOST) * UNIT + chance;
    return splat_sum(uvec3(sum), 0u, 0u);
#endif
}

void splat_add(splat_sum part, ivec2 pixel) {
    uint at = CHANNELS * uint(pixel.y * int(picture.x) + pixel.x);
    for (uint i = 0u; i < 3u; i++) atomicAdd(splat_sums[at + i], part.color[i]);
#if BLEND == BLEND_WEIGHTED
    atomicAdd(splat_sums[at + 3u], part.weight);
    atomicAdd(splat_sums[at + 4u], part.log);
#endif
}

// Part of a large one in a pixel.
splat_sum splat_part_at(splat s, ivec2 pixel) {
    vec4 c = splat_at(s, vec2(pixel) + 0.5 - s.at);
    if (c.a <= 0.0) return splat_sum(uvec3(0u), 0u, 0u);
    return splat_part(c.rgb, c.a * splat_visible(pixel, s.depth), s.depth, s.seed, pixel);
}

// ---- tiles ------------------------------------------------------------------------------------

uint splat_tile(ivec2 tile) {
    return uint(tile.y) * tiles_across + uint(tile.x);
}

vec2 splat_extent(splat s) { // half of the box around it
#if HAS_SPRITE
    return (s.radius + s.reach) * abs(s.along) + s.radius * abs(s.along.yx);
#else
    return s.radius + s.reach * abs(s.along);
#endif
}

// Tiles from the first up to before the last: none where it is beside the picture.
ivec4 splat_tile_box(splat s) {
    vec2 extent = splat_extent(s);
    vec2 tiles = vec2(tiles_across, tiles_down);
    vec2 low = clamp(floor((s.at - extent) / float(TILE)), vec2(0.0), tiles);
    vec2 high = clamp(floor((s.at + extent) / float(TILE)) + 1.0, vec2(0.0), tiles);
    return ivec4(low, high);
}

// Whether it may be in a tile of its box: streaks leave most of them out.
bool splat_meets(splat s, ivec2 tile) {
    vec2 offset = float(TILE) * (vec2(tile) + 0.5) - s.at;
    float apart = abs(dot(offset, vec2(-s.along.y, s.along.x)));
    return apart < s.radius + 0.5 * float(TILE) * (abs(s.along.x) + abs(s.along.y));
}

// Pixels of a tile, by atomics: where there is no place in its list.
void splat_add_tile(splat s, ivec2 tile) {
    ivec2 end = min(int(TILE) * (tile + 1), ivec2(picture));
    for (int y = int(TILE) * tile.y; y < end.y; y++)
        for (int x = int(TILE) * tile.x; x < end.x; x++) splat_add(splat_part_at(s, ivec2(x, y)), ivec2(x, y));
}
