// The light of one point light on what its sphere covers, which is added up.
uniform sampler2D albedo;  //= input : of the pass shade, as all here
uniform sampler2D normal;  //= input : of the surface
uniform sampler2D depth;   //= input : of the surface (m)
uniform sampler2D surface; //= input optional : its reflection
uniform float lod;        // px
#undef HAS_LIGHTS // the reader's table of lights is not read here
#define HAS_LIGHTS 0
#include "lib/frame.glsl"
#include "lib/light.glsl"
#include "lib/bvh.glsl"
#include "lib/point_lights.glsl"
#include "lib/shadows.glsl"
#include "lib/shading.glsl"
#include "pass/surfaces/shade/surface.glsl"
#include "pass/surfaces/shade/shaded.glsl"
#include "pass/surfaces/shade/point_lights.glsl"
uniform vec2 point_light_picture; // pixels
layout(location = 0) flat in int number;
layout(location = 0) out vec4 added;

void main() {
    vec2 uv = gl_FragCoord.xy / point_light_picture;
    surface_point at = surface_at(uv);
    point_light l = point_light_of(uint(number));
    if (at.base.a == 0.0 || distance(at.p, l.position) >= l.range) discard;
    shaded s = shaded_at(at, uv);
    added = vec4(shading_total(s, point_light_reflected(l, s)), 0.0);
}
