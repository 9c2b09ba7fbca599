// What point lights give to points 5 m before the camera.
#include "lib/frame.glsl"
#include "lib/point_lights.glsl"
writeonly uniform image2D color; //= output rgba16f : irradiance

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec3 p = frame.eye.xyz + 5.0 * frame_ray((vec2(pixel) + 0.5) / vec2(size)), sum = vec3(0.0);
#if HAS_POINT_LIGHTS
    for (point_light_list list = point_lights_at(pixel); point_lights_next(list);) sum += point_light_ray(point_lights_get(list), p).irradiance;
#endif
    imageStore(color, pixel, vec4(sum, 1.0));
}
