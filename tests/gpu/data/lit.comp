// What the pass lighting says about the points of a square: what lies between them and a light, or
// what a medium there would scatter.
//@ option shows = shadow {shadow, scattered, irradiance} : what
uniform int index;    //= 0 [0, 100] : of the light
uniform vec3 corner;  //= 0 [-100, 100] m : where the square begins
uniform vec3 across;  //= 0 [-100, 100] m : its edge to the right
uniform vec3 down;    //= 0 [-100, 100] m : its edge downwards
uniform vec3 way;     //= 0 [-1, 1] : of scattered light, unit
uniform float g;      //= 0 [-1, 1] : mean cosine of scattering
writeonly uniform image2D color; //= output rgba32f : shadow: density times metres, part that is not hidden; the irradiance of fire
#include "lib/lighting.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 at = (vec2(pixel) + 0.5) / vec2(size);
    vec3 p = corner + at.x * across + at.y * down, shown = vec3(0.0);
#if SHOWS == SHOWS_SHADOW && HAS_SHADOW
    shown.xy = lighting_shadow(index, p);
#endif
#if SHOWS == SHOWS_SCATTERED && HAS_GLOW
    shown = lighting_scattered(p, way, g);
#endif
#if SHOWS == SHOWS_IRRADIANCE
    for (int i = lighting_declared(); i < light_count(); i++) shown += light_at(light_get(i), p).irradiance;
#endif
    imageStore(color, pixel, vec4(shown, 1.0));
}
