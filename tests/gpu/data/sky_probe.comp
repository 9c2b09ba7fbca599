// What lib/sky.glsl and lib/night.glsl say, pixel by pixel.
//@ option show = radiance {radiance, irradiance, density, drawn, seen} : of a direction (even over the sphere); drawn: of one that sky_sample drew, radiance over density, both densities, height
writeonly uniform image2D color; //= output rgba16f : the answer
#include "lib/sky.glsl"
#include "lib/night.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    float z = 1.0 - 2.0 * uv.y, azimuth = 6.2831853 * uv.x;
    vec3 d = vec3(sqrt(1.0 - z * z) * vec2(cos(azimuth), sin(azimuth)), z);
    vec4 answer = vec4(sky_radiance(d), 1.0);
#if SHOW == SHOW_IRRADIANCE
    answer = vec4(sky_irradiance(d), sky_mean().r);
#elif SHOW == SHOW_DENSITY
    answer = vec4(sky_pdf(d));
#elif SHOW == SHOW_DRAWN
    float pdf;
    vec3 drawn = sky_sample(uv, pdf);
    answer = vec4(sky_radiance(drawn).r / pdf, pdf, sky_pdf(drawn), drawn.z);
#elif SHOW == SHOW_SEEN
    answer.rgb = night_sky(d, 0.02);
#endif
    imageStore(color, pixel, answer);
}
