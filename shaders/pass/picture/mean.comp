// The mean of the pictures that a frame is averaged of (`roil render --samples`), so far. A frame that
// is none of such is as it is.
//@ option weighted = off {off, on} : whether the alpha is what a colour counts in the mean
#include "lib/frame.glsl"
uniform sampler2D source;         //= input : one of the pictures, scene-linear
uniform sampler2D before;         //= input history color : the mean of those before it
writeonly uniform image2D color;  //= output rgba32f : their mean, premultiplied as they are

// What is no number, or infinite, would stay in the mean.
vec4 finite(vec4 c) { return mix(clamp(c, -1e30, 1e30), vec4(0.0), isnan(c)); }

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec4 now = finite(texelFetch(source, pixel, 0));
    if (frame.time.w > 1.0) {
        vec4 old = texelFetch(before, pixel, 0);
        float part = 1.0 / frame.time.w;
#if WEIGHTED == WEIGHTED_ON
        float weight = mix(old.a, now.a, part);
        now = vec4(mix(old.rgb * old.a, now.rgb * now.a, part) / max(weight, 1e-30), weight);
#else
        now = mix(old, now, part);
#endif
    }
    imageStore(color, pixel, now);
}
