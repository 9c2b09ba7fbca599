// Blue noise as passes get it.
#include "lib/frame.glsl"
#include "lib/random.glsl"
writeonly uniform image2D color;   //= output rgba32f : one number, then two
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(color)))) return;
    vec2 two = random_blue2(uvec2(pixel), frame.size.z);
    imageStore(color, pixel, vec4(random_blue(uvec2(pixel), frame.size.z), two, 1.0));
}
