// A volume as slices that face the camera, each evaluated as it is drawn, into a picture of its own
// size that is then scaled: as Krueger and Westermann 2005 render theirs (section 5.1), after Cabral,
// Cam and Foran 1994. `march` is the better picture; this is the published one, for comparison.
//
// The slices are planes of equal depth through the whole box, laid over each other front to back.
layout(local_size_x = 16, local_size_y = 16) in;
//@ option target = 256 {256, 64, 128, 512, 1024, output} : texels a side of what is drawn into, as large as the simulated slices; output: as the picture, or its `resolution`
uniform int slices;                //= 128 [1, 2048] : how many there are through the volume
uniform float early_exit;          //= 0.005 [0, 1] : nothing is laid behind when less than this shines through
uniform float ambient;             //= 1 [0, 10] : factor of the light from the sky, which is the same on all sides, without `glow`
uniform vec3 box_min;
uniform vec3 box_max;
uniform sampler2D depth;           //= input optional : depth of the scene (m)
writeonly uniform image2D color;   //= output rgba16f : premultiplied radiance and opacity
writeonly uniform image2D edge;    //= output r32f : depth of the scene that was seen (m)

#include "lib/frame.glsl"
#include "lib/grid.glsl"
#include "lib/sky.glsl"
#include "lib/medium.glsl"
#include "lib/lighting.glsl"

// Radiance that a metre of scattering coefficient 1 adds, on the way `along`.
vec3 light_in(vec3 p, vec3 along) {
#if HAS_LIGHTS && HAS_GLOW
    vec3 sum = lighting_scattered(p, -along, medium_anisotropy());
#else
    vec3 sum = ambient * sky_mean();
#endif
#if HAS_LIGHTS && HAS_SHADOW
    for (int i = 0; i < lighting_declared(); i++) {
        light_ray ray = light_at(light_get(i), p);
        vec2 shade = lighting_shadow(i, p);
        sum += ray.irradiance * shade.y * exp(-lighting_extinction() * shade.x) *
               medium_phase(dot(along, ray.direction), 1.0);
    }
#endif
    return sum;
}

// Least and greatest depth of the box.
vec2 depths(vec3 ahead) {
    vec2 range = vec2(1e30, -1e30);
    for (int i = 0; i < 8; i++) {
        vec3 corner = mix(box_min, box_max, notEqual(ivec3(i) & ivec3(1, 2, 4), ivec3(0)));
        float z = dot(corner - frame.eye.xyz, ahead);
        range = vec2(min(range.x, z), max(range.y, z));
    }
    return max(range, 0.0);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(texel, size))) return;
    vec2 uv = (vec2(texel) + 0.5) / vec2(size);
    vec3 ray = frame_ray(uv), way = normalize(ray), sum = vec3(0.0), through = vec3(1.0);
    float stop = 1e9;
#if HAS_DEPTH
    stop = texelFetch(depth, ivec2(uv * vec2(textureSize(depth, 0))), 0).r;
#endif
    vec2 range = depths(normalize(frame_ray(vec2(0.5))));
    float apart = (range.y - range.x) / float(slices), thickness = apart * length(ray);
    for (int i = 0; i < slices; i++) {
        float z = range.x + (float(i) + 0.5) * apart;
        if (z > stop || max(max(through.r, through.g), through.b) < early_exit) break;
        vec3 p = frame.eye.xyz + z * ray;
        if (any(lessThan(p, box_min)) || any(greaterThan(p, box_max))) continue;
        float density = medium_density(p);
        if (density <= 0.0) continue;
        vec3 seen = 1.0 - exp(-density * thickness * medium_extinction());
        vec3 given = medium_emission(p, density) + density * medium_scattering(p) * light_in(p, way);
        sum += through * given * thickness * seen / max(density * thickness * medium_extinction(), 1e-9);
        through *= 1.0 - seen;
    }
    imageStore(color, texel, vec4(sum, 1.0 - dot(through, vec3(1.0 / 3.0))));
    imageStore(edge, texel, vec4(stop));
}
