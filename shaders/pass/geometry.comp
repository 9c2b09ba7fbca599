// Draws what is solid, lit by sun and sky, before the sky itself (Raseta et al. 2025, section 3.3).
//
// This file declares the pass; meshes are rasterised by geometry.vert and geometry.frag, and this
// dispatch then fills the pixels that no mesh covers.
uniform float haze;               //= 0 [0, 10] 1/m : how fast distance fades to the colour of the horizon
uniform float sky_alpha;          //= 1 [0, 1] : opacity of the sky; 0 for pictures to be laid over others
uniform image2D color;            //= output rgba16f : the scene, premultiplied
uniform image2D sun;              //= output rgba16f : the part of color that the sun gives, for shadows laid over it later
uniform image2D depth;            //= output r32f : distance along the view axis (m); 1e9 where there is sky
#include "lib/frame.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    if (imageLoad(depth, pixel).r > 0.0) {
        if (haze == 0.0) return;
        // Aerial perspective, where a mesh is.
        vec3 along = frame_ray((vec2(pixel) + 0.5) / vec2(size));
        float kept = exp(-haze * imageLoad(depth, pixel).r * length(along));
        vec4 c = imageLoad(color, pixel);
        imageStore(color, pixel, vec4(mix(frame.sky_horizon.rgb, c.rgb, kept), c.a));
        imageStore(sun, pixel, imageLoad(sun, pixel) * kept);
        return;
    }
    vec3 direction = normalize(frame_ray((vec2(pixel) + 0.5) / vec2(size)));
    imageStore(color, pixel, vec4(frame_sky(direction), 1.0) * sky_alpha);
    imageStore(sun, pixel, vec4(0.0));
    imageStore(depth, pixel, vec4(1e9));
}
