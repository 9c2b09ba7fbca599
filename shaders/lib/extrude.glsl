// Slices round an axis, between which what they hold is turned: samples of the images of such a
// grid. src/field/extrude.h says what lies in them, and which numbers these are:
// x, y, z: rows to where a point lies, in widths and heights; size: width, height, the one slice
// that is asked for or -1, their count.
#ifndef LIB_EXTRUDE_GLSL
#define LIB_EXTRUDE_GLSL
#include "lib/grid.glsl"

const float EXTRUDE_PI = 3.14159265358979323846;

struct extruded {
    vec3 at;  // in the images, 0..1
    vec2 arc; // what x of the slice is there, of the two directions across the axis
};

extruded extrude_place(vec4 x, vec4 y, vec4 z, vec4 size, vec3 p) {
    vec2 q = vec2(dot(x.xyz, p) + x.w, dot(y.xyz, p) + y.w);
    float up = dot(z.xyz, p) + z.w;
    if (size.z >= 0.0) {
        float angle = size.z / size.w * EXTRUDE_PI;
        vec2 plane = vec2(cos(angle), sin(angle));
        return extruded(vec3(0.5 + dot(q, plane), up, (size.z + 0.5) / (size.w + 1.0)), plane);
    }
    float radius = length(q), layer = atan(q.y, q.x) * (size.w / EXTRUDE_PI), side = 1.0;
    if (radius == 0.0) layer = 0.0;
    if (layer < 0.0) {
        side = -1.0;
        layer += size.w;
    }
    vec2 arc = radius > 0.0 ? side / radius * q : vec2(1.0, 0.0);
    return extruded(vec3(0.5 + side * radius, up, (layer + 0.5) / (size.w + 1.0)), arc);
}

// As the option SAMPLING says within a slice; along the arc always linear.
vec4 extrude_texel(sampler3D slices, vec3 at) {
#if SAMPLING == SAMPLING_QUASI_CUBIC
    vec3 size = vec3(textureSize(slices, 0));
    return textureLod(slices, vec3(grid_bend(at * size).xy / size.xy, at.z), 0.0);
#elif SAMPLING == SAMPLING_CUBIC
    vec3 size = vec3(textureSize(slices, 0)), a, b, low;
    grid_spline(at * size, a, b, low);
    a /= size;
    b /= size;
    return mix(mix(textureLod(slices, vec3(b.xy, at.z), 0.0),
                   textureLod(slices, vec3(a.x, b.y, at.z), 0.0), low.x),
               mix(textureLod(slices, vec3(b.x, a.y, at.z), 0.0),
                   textureLod(slices, vec3(a.xy, at.z), 0.0), low.x), low.y);
#elif SAMPLING == SAMPLING_NEAREST
    vec2 size = vec2(textureSize(slices, 0));
    return textureLod(slices, vec3((floor(at.xy * size) + 0.5) / size, at.z), 0.0);
#else
    return textureLod(slices, at, 0.0);
#endif
}

bool extrude_is_outside(vec3 at) {
    return any(greaterThan(abs(at.xy - 0.5), vec2(0.5)));
}

vec4 extrude_sample(sampler3D slices, vec4 x, vec4 y, vec4 z, vec4 size, vec3 p) {
    vec3 at = extrude_place(x, y, z, size, p).at;
    return extrude_is_outside(at) ? vec4(0.0) : extrude_texel(slices, at);
}

// Of vectors in the slice: as vectors in space.
vec4 extrude_vector(sampler3D slices, vec4 x, vec4 y, vec4 z, vec4 size, vec3 p) {
    extruded e = extrude_place(x, y, z, size, p);
    if (extrude_is_outside(e.at)) return vec4(0.0);
    vec4 v = extrude_texel(slices, e.at);
    vec3 outward = size.x * (e.arc.x * x.xyz + e.arc.y * y.xyz);
    return vec4(v.x * outward + v.y * size.y * z.xyz, v.w);
}

#endif
