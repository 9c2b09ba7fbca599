// Keeps what is brighter than a threshold (bright pass, Raseta et al. 2025, section 3.8.1).
//@ option mode = soft {soft, paper} : soft: a knee and no hard edge; paper: all or nothing, by the luminance of Rec. 709
uniform sampler2D source;           //= input : the picture, scene-linear
uniform float threshold;            //= 1 [0, 1000] : luminance above which the picture blooms
uniform float knee;                 //= 0.5 [0, 1] : width of the soft transition, as a part of the threshold
uniform float limit;                //= 50 [0, 65000] : luminance beyond which a pixel counts no more (fireflies)
uniform float intensity;            //= 1 [0, 100] : factor of what is kept
writeonly uniform image2D color;    //= output rgba16f : the bright part
#include "bright/keep.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec3 c = textureLod(source, (vec2(pixel) + 0.5) / vec2(size), 0.0).rgb;
    imageStore(color, pixel, vec4(bright_keep(c, MODE == MODE_PAPER), 1.0));
}
