// Keeps what is brighter than a threshold (bright pass, Raseta et al. 2025, section 3.8.1).
#include "lib/color.glsl"
//@ option mode = soft {soft, paper} : soft: a knee and no hard edge; paper: all or nothing by luminance
uniform sampler2D source;           //= input : the picture, scene-linear
uniform float threshold;            //= 1 [0, 1000] : luminance above which the picture blooms
uniform float knee;                 //= 0.5 [0, 1] : width of the soft transition, as a part of the threshold
uniform float limit;                //= 50 [0, 65000] : luminance beyond which a pixel counts no more (fireflies)
writeonly uniform image2D color;    //= output rgba16f : the bright part

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec3 c = textureLod(source, (vec2(pixel) + 0.5) / vec2(size), 0.0).rgb;
    float l = luminance(c);
#if MODE == MODE_PAPER
    vec3 kept = l > threshold ? c : vec3(0.0);
#else
    float width = max(threshold * knee, 1e-4);
    float soft = clamp(l - threshold + width, 0.0, 2.0 * width);
    float over = max(l - threshold, soft * soft / (4.0 * width));
    vec3 kept = c * (min(over, limit) / max(l, 1e-4));
#endif
    imageStore(color, pixel, vec4(kept, 1.0));
}
