// The ground z = 0 up to the horizon, and before its left half, where asked, a wall.
#include "lib/frame.glsl"
uniform float wall;                //= 1e9 [0, 1e9] m : depth of the wall
writeonly uniform image2D depth;   //= output r32f : depth (m)
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(depth);
    if (any(greaterThanEqual(pixel, size))) return;
    vec3 along = frame_ray((vec2(pixel) + 0.5) / vec2(size));
    float ground = along.z < 0.0 ? min(frame.eye.z / -along.z, 1e9) : 1e9;
    imageStore(depth, pixel, vec4(pixel.x < size.x / 2 ? min(ground, wall) : ground));
}
