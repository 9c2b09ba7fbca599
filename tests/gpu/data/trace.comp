// Traces one ray of chance for each pixel, from within a cube around the origin.
uniform float half_width;            //= 3 [0, 100] m : of the cube
uniform float near;                  //= 0 [0, 100] m : where rays begin
uniform float far;                   //= 1e6 [0, 1e9] m : where they end
writeonly uniform image2D origin;    //= output rgba32f : where the ray begins; alpha: whether it is occluded
writeonly uniform image2D way;       //= output rgba32f : its direction; alpha: distance of the hit
writeonly uniform image2D face;      //= output rgba32f : normal of what it hits
writeonly uniform image2D color;     //= output rgba32f : colour of what it hits
#include "lib/bvh.glsl"
#include "lib/random.glsl"

vec3 chance(uvec2 pixel, uint seed) {
    return vec3(random_pixel(pixel, seed), random_pixel(pixel, seed + 1u), random_pixel(pixel, seed + 2u));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(color)))) return;
    vec3 from = (2.0 * chance(uvec2(pixel), 0u) - 1.0) * half_width;
    vec3 to = chance(uvec2(pixel), 3u) - 0.5;
    // Some lie along the axes, where directions have zeros.
    if (pixel.y % 8 == 0) to = vec3(pixel.x % 3 == 0, pixel.x % 3 == 1, pixel.x % 3 == 2) * sign(to.x);
    to = normalize(to);
    bvh_hit hit = bvh_trace(from, to, near, far);
    imageStore(origin, pixel, vec4(from, bvh_occluded(from, to, near, far)));
    imageStore(way, pixel, vec4(to, hit.distance));
    imageStore(face, pixel, vec4(hit.normal, 0.0));
    imageStore(color, pixel, vec4(hit.albedo, 0.0));
}
