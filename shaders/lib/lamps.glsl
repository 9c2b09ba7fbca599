// Reads the pass `point_lights`: the lamps that may light what a pixel of the picture shows.
//
//     for (lamp_list list = lamps_at(pixel); lamps_next(list);) {
//         lamp l = lamps_get(list);
//         light_ray ray = lamp_ray(l, p);
//         ... ray.irradiance ...
//     }
//
// What the loop goes over is made before the shader runs (src/pass/light/lamps_lists.c): all lamps that are
// on, or (LAMPS_TILES) those that reach what the tile of the pixel shows. Both give the same light,
// but for rounding; lamps come in the order of their numbers.
uniform sampler2D lamps; //= input optional : point lights by the hundred (of the pass point_lights)

#ifndef LIB_LAMPS_GLSL
#define LIB_LAMPS_GLSL
#include "lib/light.glsl"

#ifndef HAS_LAMPS
#define HAS_LAMPS 0
#endif
#ifndef LAMPS_TILES
#define LAMPS_TILES 0
#endif
#ifndef LAMPS_VOLUMES // 1: the reader draws spheres around them, and no lists are made
#define LAMPS_VOLUMES 0
#endif
#ifndef LAMPS_ACCESS // of the buffers
#define LAMPS_ACCESS readonly
#endif
#define LAMPS_TILE 16 // pixels along a tile
// Whether a branch leaves out lamps that do not reach a point, of those that reach its tile. Of 200 in
// effects/deferred_lights.lua a tile has 13, a pixel 7, and 5 of these are before its surface. lavapipe
// loses 0 to 3 percent by it.
const bool LAMPS_SKIP = true;

struct lamp {
    vec3 position; // m
    float radius;  // m
    vec3 color;    // W/sr
    float range;   // m
    bool linear;   // falloff
    int index;     // its number
};

#if HAS_LAMPS

struct lamp_record {
    vec4 place; // xyz: m; w: range (m), 0: it is off; below 0: it falls off linearly
    vec4 shine; // rgb: W/sr; w: radius (m)
};
// The head is: how many lamps, words of a tile's masks, tiles side by side. Not uniforms: a software
// driver (Mesa's lavapipe 22.3) compiles loops for the values of their ends, and crashes over this one.
layout(std430) LAMPS_ACCESS buffer LampRecords {
    uvec4 lamp_head;
    lamp_record lamp_records[];
};
#if LAMPS_TILES
layout(std430) LAMPS_ACCESS buffer LampMasks { uint lamp_masks[]; }; // a bit for each lamp, tile by tile
#endif

lamp lamp_of(uint index) {
    lamp_record r = lamp_records[index];
    return lamp(r.place.xyz, r.shine.w, r.shine.rgb, abs(r.place.w), r.place.w < 0.0, int(index));
}

struct lamp_list {
    uint next; // lamp, or word of masks
    uint end;
    uint bits; // left of the word
    uint index;
};

#if LAMPS_TILES
lamp_list lamps_at(ivec2 pixel) {
    uvec2 tile = uvec2(pixel) / LAMPS_TILE;
    uint first = (tile.y * lamp_head.z + tile.x) * lamp_head.y;
    return lamp_list(first, first + lamp_head.y, 0u, 0u - 32u);
}

bool lamps_next(inout lamp_list list) {
    while (list.bits == 0u) {
        if (list.next == list.end) return false;
        list.bits = lamp_masks[list.next++];
        list.index = (list.index & ~31u) + 32u;
    }
    list.index = (list.index & ~31u) + uint(findLSB(list.bits));
    list.bits &= list.bits - 1u;
    return true;
}
#else
lamp_list lamps_at(ivec2 pixel) {
    return lamp_list(0u, lamp_head.x, 0u, 0u);
}

bool lamps_next(inout lamp_list list) {
    while (list.next < list.end && lamp_records[list.next].place.w == 0.0) list.next++;
    list.index = list.next++;
    return list.index < list.end;
}
#endif

lamp lamps_get(lamp_list list) {
    return lamp_of(list.index);
}
#endif

// False: a surface there gets none of its light.
bool lamp_reaches(lamp l, vec3 p, vec3 normal) {
    vec3 to = l.position - p;
    return !LAMPS_SKIP || (dot(to, to) < l.range * l.range && dot(to, normal) > 0.0);
}

// As light_at.
light_ray lamp_ray(lamp l, vec3 p) {
    vec3 to = l.position - p;
    float distance = max(length(to), 1e-4);
    return light_ray(to / distance, distance, l.color * light_falls(distance, l.radius, l.range, l.linear));
}

#endif
