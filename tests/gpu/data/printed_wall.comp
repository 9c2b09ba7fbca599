// A wall at y = 0, printed with waves that move evenly, seen with noise that does not.
#include "lib/frame.glsl"
#include "lib/random.glsl"
uniform float light;               //= 1 [0, 100] : brightness
uniform float speed;               //= 0 m/s : of the print, to the right
uniform float noise;               //= 0 [0, 1] : amplitude of the noise
uniform float half_width;          //= 100 [0, 100] m : nothing is beyond
writeonly uniform image2D color;   //= output rgba16f : the wall
writeonly uniform image2D truth;   //= output rgba16f : the same without noise
writeonly uniform image2D reach;   //= output r32f : distance along the ray (m)
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec3 along = frame_ray((vec2(pixel) + 0.5) / vec2(size));
    float metres = -frame.eye.y / along.y;
    vec3 p = frame.eye.xyz + metres * along;
    bool there = abs(p.x) < half_width;
    p.x -= speed * frame.time.x;
    float waves = light * (0.5 + 0.25 * sin(4.0 * p.x) * cos(3.0 * p.z));
    float error = noise * (2.0 * random_pixel(uvec2(pixel), frame.size.z) - 1.0);
    imageStore(color, pixel, there ? vec4(vec3(waves + error), 1.0) : vec4(0.0));
    imageStore(truth, pixel, there ? vec4(vec3(waves), 1.0) : vec4(0.0));
    imageStore(reach, pixel, vec4(there ? metres * length(along) : 0.0));
}
