// Reads the pass `point_lights`: the point lights that may light what a pixel of the picture shows.
//
//     for (point_light_list list = point_lights_at(pixel); point_lights_next(list);) {
//         point_light l = point_lights_get(list);
//         light_ray ray = point_light_ray(l, p);
//         ... ray.irradiance ...
//     }
//
// What the loop goes over is made before the shader runs (src/pass/light/point_lights_lists.c): all point lights that are
// on, or (POINT_LIGHTS_TILES) those that reach what the tile of the pixel shows. Both give the same light,
// but for rounding; point lights come in the order of their numbers.
uniform sampler2D point_lights; //= input optional : many point lights (of the pass point_lights)

#ifndef LIB_POINT_LIGHTS_GLSL
#define LIB_POINT_LIGHTS_GLSL
#include "lib/light.glsl"

#ifndef HAS_POINT_LIGHTS
#define HAS_POINT_LIGHTS 0
#endif
#ifndef POINT_LIGHTS_TILES
#define POINT_LIGHTS_TILES 0
#endif
#ifndef POINT_LIGHTS_VOLUMES // 1: the reader draws spheres around them, and no lists are made
#define POINT_LIGHTS_VOLUMES 0
#endif
#ifndef POINT_LIGHTS_ACCESS // of the buffers
#define POINT_LIGHTS_ACCESS readonly
#endif
#define POINT_LIGHTS_TILE 16 // pixels along a tile
// Whether a branch leaves out point lights that do not reach a point, of those that reach its tile. Of 200 in
// effects/deferred_lights.lua a tile has 13, a pixel 7, and 5 of these are before its surface. lavapipe
// loses 0 to 3 percent by it.
const bool POINT_LIGHTS_SKIP = true;

struct point_light {
    vec3 position; // m
    float radius;  // m
    vec3 color;    // W/sr
    float range;   // m
    bool linear;   // falloff
    int index;     // its number
};

#if HAS_POINT_LIGHTS

struct point_light_record {
    vec4 place; // xyz: m; w: range (m), 0: it is off; below 0: it falls off linearly
    vec4 shine; // rgb: W/sr; w: radius (m)
};
// The head is: how many point lights, words of a tile's masks, tiles side by side. Not uniforms: a software
// driver (Mesa's lavapipe 22.3) compiles loops for the values of their ends, and crashes over this one.
layout(std430) POINT_LIGHTS_ACCESS buffer PointLightRecords {
    uvec4 point_light_head;
    point_light_record point_light_records[];
};
#if POINT_LIGHTS_TILES
layout(std430) POINT_LIGHTS_ACCESS buffer PointLightMasks { uint point_light_masks[]; }; // a bit for each point light, tile by tile
#endif

point_light point_light_of(uint index) {
    point_light_record r = point_light_records[index];
    return point_light(r.place.xyz, r.shine.w, r.shine.rgb, abs(r.place.w), r.place.w < 0.0, int(index));
}

struct point_light_list {
    uint next; // point light, or word of masks
    uint end;
    uint bits; // left of the word
    uint index;
};

#if POINT_LIGHTS_TILES
point_light_list point_lights_at(ivec2 pixel) {
    uvec2 tile = uvec2(pixel) / POINT_LIGHTS_TILE;
    uint first = (tile.y * point_light_head.z + tile.x) * point_light_head.y;
    return point_light_list(first, first + point_light_head.y, 0u, 0u - 32u);
}

bool point_lights_next(inout point_light_list list) {
    while (list.bits == 0u) {
        if (list.next == list.end) return false;
        list.bits = point_light_masks[list.next++];
        list.index = (list.index & ~31u) + 32u;
    }
    list.index = (list.index & ~31u) + uint(findLSB(list.bits));
    list.bits &= list.bits - 1u;
    return true;
}
#else
point_light_list point_lights_at(ivec2 pixel) {
    return point_light_list(0u, point_light_head.x, 0u, 0u);
}

bool point_lights_next(inout point_light_list list) {
    while (list.next < list.end && point_light_records[list.next].place.w == 0.0) list.next++;
    list.index = list.next++;
    return list.index < list.end;
}
#endif

point_light point_lights_get(point_light_list list) {
    return point_light_of(list.index);
}
#endif

// False: a surface there gets none of its light.
bool point_light_reaches(point_light l, vec3 p, vec3 normal) {
    vec3 to = l.position - p;
    return !POINT_LIGHTS_SKIP || (dot(to, to) < l.range * l.range && dot(to, normal) > 0.0);
}

// As light_at.
light_ray point_light_ray(point_light l, vec3 p) {
    vec3 to = l.position - p;
    float distance = max(length(to), 1e-4);
    return light_ray(to / distance, distance, l.color * light_falls(distance, l.radius, l.range, l.linear));
}

#endif
