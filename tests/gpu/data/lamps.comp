// What lamps give to points 5 m before the camera.
#include "lib/frame.glsl"
#include "lib/lamps.glsl"
writeonly uniform image2D color; //= output rgba16f : irradiance

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec3 p = frame.eye.xyz + 5.0 * frame_ray((vec2(pixel) + 0.5) / vec2(size)), sum = vec3(0.0);
#if HAS_LAMPS
    for (lamp_list list = lamps_at(pixel); lamps_next(list);) sum += lamp_ray(lamps_get(list), p).irradiance;
#endif
    imageStore(color, pixel, vec4(sum, 1.0));
}
