// How the shadows of a light through the volume lie in a 3D image: two coordinates choose a ray of
// light, the third runs along it, from where it enters the volume's box to where it leaves.
//
// The light `index` has the slices from index * N on, of N x N texels. A texel holds what its ray
// has passed at the END of its slice, so that sums of midpoints are exact where they are stored
// and the last slice has the whole.
#ifndef LIB_SHADOW_MAP_GLSL
#define LIB_SHADOW_MAP_GLSL
#include "shared.h"
#include "lib/box.glsl"

#define SHADOW_MAP_NONE 0     // nothing stands between: fire, whose colour is what gets out of the smoke
#define SHADOW_MAP_PARALLEL 1 // rays of the sun, perpendicular to the picture
#define SHADOW_MAP_FRUSTUM 2  // rays from a point through a window
#define SHADOW_MAP_SPHERE 3   // rays from a point into all directions, by the octahedral map

struct shadow_map {
    int kind, index;
    vec3 position; // of the light, metres; of the sun: a point that its middle ray passes
    vec3 right, up, along;
    vec2 extent; // half sizes: parallel: metres; frustum: at 1 m
    vec3 box_min, box_max;
};

// In an image with a row a light: texels 0 to 3 are its light_entry, then follow these.
#define SHADOW_MAP_TEXELS 11

shadow_map shadow_map_of(sampler2D rows, int index) {
    vec4 place = texelFetch(rows, ivec2(4, index), 0), right = texelFetch(rows, ivec2(5, index), 0);
    vec4 up = texelFetch(rows, ivec2(6, index), 0), along = texelFetch(rows, ivec2(7, index), 0);
    return shadow_map(int(along.w), index, place.xyz, right.xyz, up.xyz, along.xyz,
                      vec2(right.w, up.w), texelFetch(rows, ivec2(8, index), 0).xyz,
                      texelFetch(rows, ivec2(9, index), 0).xyz);
}

// ---- directions on a square -------------------------------------------------------------------

// Cigolle, Donow, Evangelakos, Mara, McGuire and Meyer, "A survey of efficient representations for
// independent unit vectors", JCGT 3(2), 2014, listing 2. The square is -1..1.
vec2 octahedral_sign(vec2 v) {
    return mix(vec2(-1.0), vec2(1.0), greaterThanEqual(v, vec2(0.0)));
}

vec2 octahedral_from(vec3 direction) {
    vec3 n = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    return n.z >= 0.0 ? n.xy : (1.0 - abs(n.yx)) * octahedral_sign(n.xy);
}

// Points up to one texel outside of the square are those that lie there when it is folded.
vec3 octahedral_to(vec2 v) {
    if (abs(v.x) > 1.0) v = vec2(octahedral_sign(v).x * (2.0 - abs(v.x)), -v.y);
    if (abs(v.y) > 1.0) v = vec2(-v.x, octahedral_sign(v).y * (2.0 - abs(v.y)));
    vec3 n = vec3(v, 1.0 - abs(v.x) - abs(v.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * octahedral_sign(n.xy);
    return normalize(n);
}

// ---- between rays and texels ------------------------------------------------------------------

struct shadow_ray {
    vec3 origin, direction;
    vec2 range; // metres from the origin between which it is in the box; empty: it misses
};

// The part of a ray of light that is in the box, for a point on it `behind` metres from the light.
vec2 shadow_map_range(shadow_map m, vec3 p, vec3 direction, float behind) {
    vec2 range = box_range_unclamped(p, direction, m.box_min, m.box_max);
    if (m.kind != SHADOW_MAP_PARALLEL) range.x = max(range.x, -behind);
    return range;
}

// The ray through the centre of a texel, of an image of `size` x `size`.
shadow_ray shadow_map_ray(shadow_map m, ivec2 texel, int size) {
    vec2 at = (2.0 * vec2(texel) + 1.0) / float(size) - 1.0;
    shadow_ray ray = shadow_ray(m.position, m.along, vec2(0.0));
    if (m.kind == SHADOW_MAP_PARALLEL)
        ray.origin += at.x * m.extent.x * m.right + at.y * m.extent.y * m.up;
    else if (m.kind == SHADOW_MAP_FRUSTUM)
        ray.direction = normalize(m.along + at.x * m.extent.x * m.right + at.y * m.extent.y * m.up);
    else
        ray.direction = octahedral_to(at * float(size) / float(size - 2)); // with a border to blend
    ray.range = shadow_map_range(m, ray.origin, ray.direction, 0.0);
    return ray;
}

// x: density times metres between p and the light; y: part of the light that no mesh hides.
// Outside of the box the density is 0, and what hides is known as far as the box reaches.
vec2 shadow_map_read(sampler3D image, shadow_map m, vec3 p) {
    ivec3 texels = textureSize(image, 0);
    float size = float(texels.x);
    vec3 from = p - m.position, direction = m.along;
    float behind = 0.0;
    vec2 at;
    if (m.kind == SHADOW_MAP_NONE) return vec2(0.0, 1.0);
    if (m.kind == SHADOW_MAP_PARALLEL) {
        at = vec2(dot(from, m.right), dot(from, m.up)) / m.extent;
    } else {
        behind = max(length(from), 1e-6);
        direction = from / behind;
        if (m.kind == SHADOW_MAP_FRUSTUM) {
            float deep = dot(from, m.along);
            if (deep <= 0.0) return vec2(0.0, 1.0);
            at = vec2(dot(from, m.right), dot(from, m.up)) / (deep * m.extent);
        } else {
            at = octahedral_from(direction) * (size - 2.0) / size;
        }
    }
    vec2 range = shadow_map_range(m, p, direction, behind);
    if (range.y <= range.x) return vec2(0.0, 1.0);
    float slice = clamp(-range.x / (range.y - range.x), 0.0, 1.0) * size;
    float deep = (float(m.index) * size + max(slice - 0.5, 0.5)) / float(texels.z);
    vec2 found = textureLod(image, vec3(0.5 * at + 0.5, deep), 0.0).xy;
    return vec2(found.x * min(slice, 1.0), found.y);
}

#endif
