// Reads what the pass `shadow_maps` left: whether anything solid stands between a point and a light.
//
// A point is moved off its surface by what keeps that from shading itself, then the texels about its
// place are asked whether they are as far from the light as it is. Part of the light is what part of
// a square of them says yes: a box filter, exact at fractions of texels (Reeves, Salesin and Cook,
// "Rendering antialiased shadows with depth maps", SIGGRAPH 1987).
uniform sampler2D shadow_atlas;  //= input optional : maps of what the lights see (of the pass shadow_maps)
uniform sampler2D shadow_views;  //= input optional : where in it what is (of the pass shadow_maps)

#ifndef LIB_SHADOWS_GLSL
#define LIB_SHADOWS_GLSL
#include "lib/light.glsl"
#if HAS_SHADOW_ATLAS && HAS_SHADOW_VIEWS
#define HAS_SHADOW_MAPS 1
#else
#define HAS_SHADOW_MAPS 0
#endif
#if HAS_SHADOW_MAPS

struct shadow_maps {
    int first, count; // views; count 0: it has no maps, and whatever is asked is lit
    float dark;       // 1: its shadows are whole
};

// Texels of the table: shadow_maps/views.glsl. Lights come first, then point_lights.
shadow_maps shadow_maps_at(int place, int views) {
    vec4 v = texelFetch(shadow_views, ivec2(place & 7, 1 + views + (place >> 3)), 0);
    return shadow_maps(int(v.x), int(v.y), v.z);
}

// Of the light `index` of lib/light.glsl.
shadow_maps shadow_maps_of(int index) {
    vec4 all = texelFetch(shadow_views, ivec2(0), 0);
    if (index >= int(all.z)) return shadow_maps(0, 0, 0.0);
    return shadow_maps_at(index, int(all.w));
}

// Of the point light `index` of lib/point_lights.glsl.
shadow_maps shadow_maps_of_point_light(int index) {
    vec4 all = texelFetch(shadow_views, ivec2(0), 0);
    return shadow_maps_at(int(all.z) + index, int(all.w));
}

// Part of one along which two intervals meet that begin at i and at low.
vec2 shadow_meet(float i, float low, float high) {
    return clamp(min(vec2(i + 1.0, i + 2.0), high) - max(vec2(i, i + 1.0), low), 0.0, 1.0);
}

// Part of the square of `radius` texels about `at` that is no nearer to the light than z.
float shadow_filter(vec2 at, float z, float radius) {
    vec2 low = at - radius, high = at + radius, first = floor(low), texels = vec2(textureSize(shadow_atlas, 0));
    int blocks = int(ceil(radius + 0.5));
    float sum = 0.0;
    for (int j = 0; j < blocks; j++) {
        float y = first.y + 2.0 * float(j);
        vec2 down = shadow_meet(y, low.y, high.y);
        for (int i = 0; i < blocks; i++) {
            float x = first.x + 2.0 * float(i);
            vec2 across = shadow_meet(x, low.x, high.x);
            vec4 lit = vec4(greaterThanEqual(textureGather(shadow_atlas, vec2(x + 1.0, y + 1.0) / texels), vec4(z)));
            sum += dot(vec2(dot(lit.wz, across), dot(lit.xy, across)), down);
        }
    }
    return sum / (4.0 * radius * radius);
}

struct shadow_place {
    vec3 at;      // xy: texels of the atlas; z: depth
    float within; // texels from the edge of the view; below 0: it does not show the point
};

// Neighbours of a texel are nearer to the light by what the plane of the surface rises between them:
// to lift a point by the way across times the part of the normal along that way is just enough, in
// either direction of the texels (after Holbert, "Saying goodbye to shadow acne", GDC 2011).
shadow_place shadow_place_at(int view, vec3 p, vec3 n) {
    int row = 1 + view;
    vec4 row_x = texelFetch(shadow_views, ivec2(0, row), 0), row_y = texelFetch(shadow_views, ivec2(1, row), 0);
    vec4 row_z = texelFetch(shadow_views, ivec2(2, row), 0), row_w = texelFetch(shadow_views, ivec2(3, row), 0);
    vec4 right = texelFetch(shadow_views, ivec2(4, row), 0), up = texelFetch(shadow_views, ivec2(5, row), 0);
    vec4 edge = texelFetch(shadow_views, ivec2(6, row), 0), all = texelFetch(shadow_views, ivec2(0), 0);
    float texel = right.w * (up.w > 0.0 ? 1.0 : max(dot(row_w, vec4(p, 1.0)), 0.0));
    float lift = all.y * texel * (all.x + 1.0) * (abs(dot(n, right.xyz)) + abs(dot(n, up.xyz)));
    vec4 q = vec4(p + lift * n, 1.0);
    float w = dot(row_w, q);
    vec3 at = vec3(dot(row_x, q), dot(row_y, q), dot(row_z, q)) / max(w, 1e-20);
    vec2 inside = min(at.xy - edge.xy, edge.zw - at.xy) - all.x - 1.0;
    return shadow_place(vec3(at.xy, min(at.z, 1.0)), w > 0.0 ? min(inside.x, inside.y) : -1.0);
}

float shadow_look(vec3 at) {
    return shadow_filter(at.xy, at.z, texelFetch(shadow_views, ivec2(0), 0).x);
}

// Part of a cascade's width along which it goes over into the next.
const float SHADOW_BLEND = 0.05;

// The sun's: the finest cascade that shows the point, blended with the next near its edge; the last
// with light.
float shadow_of_cascades(shadow_maps m, vec3 p, vec3 n) {
    int i = m.first, end = m.first + m.count;
    shadow_place place = shadow_place_at(i, p, n);
    for (; place.within < 0.0 && ++i < end;) place = shadow_place_at(i, p, n);
    float seen = 0.0, left = 1.0;
    for (; i < end && left > 0.0; place = shadow_place_at(min(++i, end - 1), p, n)) {
        vec4 edge = texelFetch(shadow_views, ivec2(6, 1 + i), 0);
        float here = left * clamp(place.within / (SHADOW_BLEND * (edge.z - edge.x)), 0.0, 1.0);
        seen += here * shadow_look(place.at);
        left -= here;
    }
    return seen + left;
}

// The face of a cube that a direction from its middle leaves by: +x, -x, +y, -y, +z, -z.
int shadow_face(vec3 way) {
    vec3 a = abs(way);
    int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + int(way[axis] < 0.0);
}

// Part of the light at `source` (of the sun: anything) that reaches p, where the normal is n (0:
// there is none).
float shadow_of(shadow_maps m, bool sun, vec3 source, vec3 p, vec3 n) {
    if (m.count == 0) return 1.0;
    if (sun) return shadow_of_cascades(m, p, n);
    int face = m.count > 1 ? shadow_face(p - source) : 0;
    shadow_place place = shadow_place_at(m.first + face, p, n);
    return place.within < 0.0 ? 1.0 : mix(1.0, shadow_look(place.at), m.dark);
}

// The same of the light `index` of lib/light.glsl.
float shadow_seen(int index, vec3 p, vec3 n) {
    light l = light_get(index);
    return shadow_of(shadow_maps_of(index), l.kind == LIGHT_SUN, l.position, p, n);
}
#endif
#endif
