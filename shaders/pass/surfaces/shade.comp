// Lights what `geometry` drew: by the sun and every other light, past the meshes and through the
// volume, and by the sky; shows the sky where nothing is.
uniform sampler2D albedo;         //= input : base colour of the surface; alpha 0 where nothing is
uniform sampler2D normal;         //= input : its normal in the world
uniform sampler2D depth;          //= input : distance along the view axis (m)
uniform sampler2D surface;        //= input optional : specular, roughness, metallic, and 1 where model toon is allowed; without: matte
uniform sampler2D emission;       //= input optional : radiance that the surface gives off
uniform int shadow_samples;       //= 1 [0, 64] : rays to each light: 1 goes to its middle, for hard shadows; more go all over its disc, for soft ones; 0: meshes cast no shadows
uniform int sky_samples;          //= 0 [0, 64] : rays to the sky, which find what stands before it; 0: all of it is seen
uniform float haze;               //= 0 [0, 10] 1/m : how fast distance fades to the colour of the horizon
//@ option point_lights_by = auto {auto, all, tiles, volumes} : which point lights light a pixel: all are asked; those that reach what 16 by 16 pixels show, which are found out first (tiles); or those whose sphere, drawn, covers it (volumes); auto: tiles, or all where they are few
uniform float lod;                //= 0 [0, 64] px : how far a simplified mesh may be off in the picture, as `geometry` has it: shadows are of meshes in full, and begin that far above the surface
uniform float sky_alpha;          //= 1 [0, 1] : opacity of the sky; 0 for pictures to be laid over others
writeonly uniform image2D color;  //= output rgba16f : the lit scene, premultiplied
#include "lib/frame.glsl"
#include "lib/across.glsl"
#include "lib/random.glsl"
#include "lib/sky.glsl"
#include "lib/night.glsl"
#include "lib/bvh.glsl"
#include "lib/lighting.glsl"
#include "lib/point_lights.glsl"
#include "lib/shadows.glsl"
#include "lib/shading.glsl"
#include "shade/surface.glsl"
#define SHAFTS MANY_RAYS
#if MANY_RAYS
#include "shade/shafts.glsl"
#include "shade/shadow.glsl"
#endif

#include "shade/light.glsl"
#include "shade/shaded.glsl"
#if POINT_LIGHTS_VOLUMES
uniform sampler2D PointLightLight; // what spheres that were drawn around the point lights have added up
#endif

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    surface_point s = surface_at(uv);
    if (s.base.a == 0.0) {
        imageStore(color, pixel, vec4(night_sky(normalize(frame_ray(uv)), 2.0 * frame.lens.y / float(size.y)), 1.0) * sky_alpha);
        return;
    }
    vec3 lit = surface_light(shaded_at(s, uv), uvec2(pixel));
#if POINT_LIGHTS_VOLUMES
    lit += texelFetch(PointLightLight, pixel, 0).rgb;
#endif
#if HAS_EMISSION
    lit += texelFetch(emission, ivec2(uv * vec2(textureSize(emission, 0))), 0).rgb;
#endif
    imageStore(color, pixel, vec4(mix(frame.sky_horizon.rgb, lit, exp(-haze * max(s.distance - frame.eye.w, 0.0))), 1.0));
}
