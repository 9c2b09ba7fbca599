// Rays against the meshes of the scene (src/scene/bvh.h makes the trees).
#ifndef LIB_BVH_GLSL
#define LIB_BVH_GLSL
#include "shared.h"
layout(std430) readonly buffer BvhNodes { bvh_wide bvh_nodes[]; };
layout(std430) readonly buffer BvhTriangles { bvh_triangle bvh_triangles[]; };
layout(std430) readonly buffer BvhInstances { uvec4 bvh_count; bvh_instance bvh_instances[]; }; // count: x: of these; y: what the root of the tree over them has below it, 0: there is none

struct bvh_hit {
    float distance; // metres; negative: nothing was hit
    vec3 normal;    // unit, of the face, towards the ray's origin
    vec3 albedo;    // material colour times the mesh's, of a texture its mean
    ivec2 what;     // what is placed there, and its triangle
};

struct bvh_ray {
    vec3 origin, direction;
    vec3 inverse;    // of the direction
    vec3 enter, leave; // where it passes planes through 0, with a margin for rounding
    float near, far; // in lengths of the direction
};

bvh_ray bvh_make_ray(vec3 origin, vec3 direction, float near, float far) {
    vec3 divisor = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 inverse = 1.0 / divisor, zero = -origin * inverse, margin = 2.4e-7 * abs(zero);
    return bvh_ray(origin, direction, inverse, zero - margin, zero + margin, near, far);
}

// Where a ray enters each of four boxes, BVH_MISS: it does not. Slab test, with what rounding can do
// taken from the entry and added to the exit, so that no ray slips through between boxes that touch
// (Ize, "Robust BVH ray traversal", 2013).
const float BVH_MISS = 3e38;
vec4 bvh_enter_boxes(bvh_ray ray, vec4 low[3], vec4 high[3]) {
    vec4 enter = vec4(ray.near), leave = vec4(ray.far);
    for (int a = 0; a < 3; a++) {
        bool back = ray.inverse[a] < 0.0;
        enter = max(enter, (back ? high[a] : low[a]) * ray.inverse[a] + ray.enter[a]);
        leave = min(leave, (back ? low[a] : high[a]) * ray.inverse[a] + ray.leave[a]);
    }
    return mix(vec4(BVH_MISS), enter, lessThanEqual(enter, leave * 1.0000008));
}

bool bvh_meets_box(bvh_ray ray, vec3 low, vec3 high) {
    vec3 a = (low - ray.origin) * ray.inverse, b = (high - ray.origin) * ray.inverse;
    vec3 near = min(a, b), far = max(a, b);
    return max(max(near.x, near.y), max(near.z, ray.near)) <=
           min(min(far.x, far.y), min(far.z, ray.far)) * 1.0000008;
}

// A walk goes to the nearest of a node's children and keeps the others for later (Aila and Laine,
// "Understanding the efficiency of ray traversal on GPUs", 2009). One tree is walked inside a leaf of
// another: they share the stack.
struct bvh_walk {
    uint below;      // what to enter now, 0: what is on top of the stack
    int top, bottom; // of what is kept: the end, and where this walk began
};
uint bvh_kept[2 * BVH_KEPT];
float bvh_kept_at[2 * BVH_KEPT]; // where the ray enters it

// `below`: of the root. `outer_top`: entries that others have on the stack.
bvh_walk bvh_begin(uint below, int outer_top) {
    return bvh_walk(below, outer_top, outer_top);
}

#define BVH_ORDER(a, b)                                                                            \
    if (at.b < at.a) {                                                                             \
        at.a##b = at.b##a;                                                                         \
        below.a##b = below.b##a;                                                                   \
    }
#define BVH_KEEP(a)                                                                                \
    if (at.a < BVH_MISS) {                                                                         \
        bvh_kept[w.top] = below.a;                                                                 \
        bvh_kept_at[w.top++] = at.a;                                                               \
    }
// The nearest of a node's children that the ray enters, 0: none. The next nearest is kept last.
uint bvh_enter(bvh_ray ray, uint node, inout bvh_walk w) {
    vec4 at = bvh_enter_boxes(ray, bvh_nodes[node].low, bvh_nodes[node].high);
    uvec4 below = bvh_nodes[node].below;
    BVH_ORDER(x, y)
    BVH_ORDER(z, w)
    BVH_ORDER(x, z)
    BVH_ORDER(y, w)
    BVH_ORDER(y, z)
    BVH_KEEP(w)
    BVH_KEEP(z)
    BVH_KEEP(y)
    return at.x < BVH_MISS ? below.x : 0u;
}

// What the next leaf holds that the ray enters, 0: there is none. ray.far may have become less.
uint bvh_next_leaf(bvh_ray ray, inout bvh_walk w) {
    uint at = w.below;
    for (;;) {
        while (at == 0u && w.top > w.bottom) {
            w.top--;
            if (bvh_kept_at[w.top] <= ray.far) at = bvh_kept[w.top];
        }
        if (at == 0u || at >> 28 != 0u) break;
        at = bvh_enter(ray, at, w);
    }
    w.below = 0u;
    return at;
}

uint bvh_first(uint leaf) { return leaf & 0xfffffffu; }
uint bvh_end(uint leaf) { return bvh_first(leaf) + (leaf >> 28); }

// Distance to a triangle, -1 if the ray misses it: Moeller and Trumbore, "Fast, minimum storage
// ray-triangle intersection", 1997.
float bvh_meet_triangle(bvh_ray ray, bvh_triangle t) {
    vec3 across = cross(ray.direction, t.second.xyz), from = ray.origin - t.corner.xyz;
    float scale = 1.0 / dot(t.first.xyz, across);
    float u = dot(from, across) * scale;
    vec3 turned = cross(from, t.first.xyz);
    float v = dot(ray.direction, turned) * scale;
    float distance = dot(t.second.xyz, turned) * scale;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance >= ray.near ? distance : -1.0;
}

// The triangle of a tree that is hit, -1: none; ray.far becomes its distance. With `any` the first
// that is met will do.
int bvh_find_triangle(inout bvh_ray ray, bvh_walk w, bool any) {
    int found = -1;
    for (uint leaf; (leaf = bvh_next_leaf(ray, w)) != 0u;) {
        for (uint i = bvh_first(leaf); i < bvh_end(leaf); i++) {
            float distance = bvh_meet_triangle(ray, bvh_triangles[i]);
            if (distance < 0.0 || distance > ray.far) continue;
            ray.far = distance;
            found = int(i);
        }
        if (any && found >= 0) break;
    }
    return found;
}

// A ray in the space of a mesh. It keeps its distances, since its direction is not made a unit
// vector again there.
bvh_ray bvh_to_mesh(bvh_ray ray, uint instance) {
    vec4 from = vec4(ray.origin, 1.0), x = bvh_instances[instance].inverse[0];
    vec4 y = bvh_instances[instance].inverse[1], z = bvh_instances[instance].inverse[2];
    vec3 way = vec3(dot(x.xyz, ray.direction), dot(y.xyz, ray.direction), dot(z.xyz, ray.direction));
    return bvh_make_ray(vec3(dot(x, from), dot(y, from), dot(z, from)), way, ray.near, ray.far);
}

// x: what is placed and hit, -1: none; y: the triangle.
ivec2 bvh_find(inout bvh_ray ray, bool any) {
    ivec2 hit = ivec2(-1);
    bvh_walk w = bvh_begin(bvh_count.y, 0);
    for (uint leaf; (leaf = bvh_next_leaf(ray, w)) != 0u;) {
        for (uint i = bvh_first(leaf); i < bvh_end(leaf); i++) {
            if (!bvh_meets_box(ray, bvh_instances[i].low, bvh_instances[i].high)) continue;
            bvh_ray inner = bvh_to_mesh(ray, i);
            int found = bvh_find_triangle(inner, bvh_begin(bvh_instances[i].below, w.top), any);
            if (found < 0) continue;
            hit = ivec2(i, found);
            ray.far = inner.far;
            if (any) break;
        }
        if (any && hit.x >= 0) break;
    }
    return hit;
}

// Nearest hit of a ray of unit direction between `near` and `far` metres.
bvh_hit bvh_trace(vec3 origin, vec3 direction, float near, float far) {
    bvh_ray ray = bvh_make_ray(origin, direction, near, far);
    ivec2 hit = bvh_find(ray, false);
    if (hit.x < 0) return bvh_hit(-1.0, vec3(0.0), vec3(0.0), ivec2(-1));
    bvh_triangle t = bvh_triangles[hit.y];
    // A normal is turned by the transpose of what turns points back.
    vec3 face = normalize(cross(normalize(t.first.xyz), normalize(t.second.xyz)));
    vec3 normal = normalize(bvh_instances[hit.x].inverse[0].xyz * face.x +
                            bvh_instances[hit.x].inverse[1].xyz * face.y +
                            bvh_instances[hit.x].inverse[2].xyz * face.z);
    vec3 albedo = vec3(t.corner.w, t.first.w, t.second.w) * bvh_instances[hit.x].color.rgb;
    return bvh_hit(ray.far, dot(normal, direction) > 0.0 ? -normal : normal, albedo, hit);
}

// Whether anything lies between `near` and `far` metres.
bool bvh_occluded(vec3 origin, vec3 direction, float near, float far) {
    bvh_ray ray = bvh_make_ray(origin, direction, near, far);
    return bvh_find(ray, true).x >= 0;
}

#endif
