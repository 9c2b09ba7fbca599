// Draws meshes and lights them in one go: what `geometry` and `shade` do in two, and the same picture.
//
// forward { mesh { "data/ground.obj" }, forest, from = {lit, lamps, shadows} } takes what geometry takes
// and is lit as shade. Each triangle is lit where it is drawn, whether or not another hides it then: good
// for few lights and few layers. Numbers of its own are those of shade.
#include "lib/lighting.glsl"
#include "lib/point_lights.glsl"
#include "lib/shadows.glsl"
uniform int shadow_samples;       //= 1 [0, 64] : rays to each light: 1 goes to its middle, for hard shadows; more go all over its disc, for soft ones; 0: meshes cast no shadows
uniform int sky_samples;          //= 0 [0, 64] : rays to the sky, which find what stands before it; 0: all of it is seen
uniform float haze;               //= 0 [0, 10] 1/m : how fast distance fades to the colour of the horizon
uniform float sky_alpha;          //= 1 [0, 1] : opacity of the sky; 0 for pictures to be laid over others
uniform float max_distance;       //= 0 [0, inf] m : from the camera to the middle of an instance (of `instances`) beyond which it is left out, while its shadow stays; 0: none is
uniform float lod;                //= 0 [0, 64] px : how far a simplified mesh may be off in the picture; 0: all are in full
//@ option point_lights_by = all {all, tiles} : which point lights a pixel looks at: all of them, or (tiles) those that reach into what the eye sees of 16 by 16 pixels, which are found out first
layout(location = 0) out vec4 color;   //= output rgba16f : the lit scene, premultiplied
layout(location = 1) out vec4 normal;  //= output rgba16f : its normal in the world, towards the viewer
layout(location = 2) out vec4 depth;   //= output r32f : distance along the view axis (m); 1e9 where nothing is
uniform vec2 picture;             // pixels
#include "lib/frame.glsl"
#include "lib/across.glsl"
#include "lib/random.glsl"
#include "lib/sky.glsl"
#include "lib/bvh.glsl"
#include "lib/shading.glsl"
#include "lib/mesh_color.glsl"
#include "shade/point.glsl"
#define SHAFTS 0
#include "shade/light.glsl"

layout(location = 0) in vec3 world_normal;
layout(location = 1) in vec2 uv;
layout(location = 2) in float distance_along;
layout(location = 3) flat in vec4 tint;

// As a half float keeps it: lights are asked as they are by `shade`.
vec3 as_kept(vec3 v) {
    vec2 xy = unpackHalf2x16(packHalf2x16(v.xy));
    return vec3(xy, unpackHalf2x16(packHalf2x16(vec2(v.z, 0.0))).x);
}

void main() {
    vec4 base = mesh_color(uv, tint.rgb);
    if (base.a < 0.5) discard;
    vec3 n = normalize(gl_FrontFacing ? world_normal : -world_normal);
    vec3 along = frame_ray(gl_FragCoord.xy / picture);
    float away = distance_along * length(along);
    normal = vec4(n, 0.0);
    depth = vec4(distance_along);
    n = normalize(as_kept(n));
    vec3 p = lifted_point(distance_along, along, n, lod, picture.y);
    shaded s = shading_of(p, n, -normalize(along), as_kept(base.rgb), part.surface);
    vec3 lit = surface_light(s, uvec2(gl_FragCoord.xy)) + part.emission.rgb * tint.w;
    color = vec4(mix(frame.sky_horizon.rgb, lit, exp(-haze * max(away - frame.eye.w, 0.0))), 1.0);
}
