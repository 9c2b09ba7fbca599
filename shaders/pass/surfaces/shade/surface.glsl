#include "point.glsl"

// The surface that a point of the picture shows, from what `geometry` found.
struct surface_point {
    vec4 base;      // its colour; a: 0 where nothing is
    vec3 normal, p; // p: where rays to lights begin
    float distance; // metres to the eye
};

surface_point surface_at(vec2 uv) {
    ivec2 texel = ivec2(uv * vec2(textureSize(depth, 0)));
    vec3 along = frame_ray(uv);
    float deep = texelFetch(depth, texel, 0).r, distance = deep * length(along);
    vec3 n = normalize(texelFetch(normal, texel, 0).xyz);
    return surface_point(texelFetch(albedo, texel, 0), n, lifted_point(deep, along, n, lod, float(textureSize(depth, 0).y)), distance);
}
