// Lights what `geometry` drew as diffuse surfaces: by the sun and every other light, past the meshes
// and through the volume, and by the sky; shows the sky where nothing is.
uniform sampler2D albedo;         //= input : base colour of the surface; alpha 0 where nothing is
uniform sampler2D normal;         //= input : its normal in the world
uniform sampler2D depth;          //= input : distance along the view axis (m)
uniform int shadow_samples;       //= 1 [0, 64] : rays to each light: 1 goes to its middle, for hard shadows; more go all over its disc, for soft ones; 0: meshes cast no shadows
uniform int sky_samples;          //= 0 [0, 64] : rays to the sky, which find what stands before it; 0: all of it is seen
uniform float haze;               //= 0 [0, 10] 1/m : how fast distance fades to the colour of the horizon
//@ option lamps_by = auto {auto, all, tiles} : which lamps of point_lights a pixel looks at: all of them, or (tiles) those that reach what 16 by 16 pixels show, which are found out first; auto: all where they are few
uniform float sky_alpha;          //= 1 [0, 1] : opacity of the sky; 0 for pictures to be laid over others
writeonly uniform image2D color;  //= output rgba16f : the lit scene, premultiplied
#include "lib/frame.glsl"
#include "lib/across.glsl"
#include "lib/random.glsl"
#include "lib/sky.glsl"
#include "lib/night.glsl"
#include "lib/bvh.glsl"
#include "lib/lighting.glsl"
#include "lib/lamps.glsl"
#include "shade/surface.glsl"
#if MANY_RAYS
#include "shade/shafts.glsl"
#include "shade/shadow.glsl"
#endif

const float PI = 3.14159265, GOLDEN_ANGLE = 2.39996323;
const float NEGLIGIBLE = 1.0 / 4096.0; // of the light on a surface: such a light gets no shadow

// Point k of `count` that are evenly spread over the unit disc, turned by chance (Vogel 1979).
vec2 disc_point(int k, int count, vec2 chance) {
    float angle = float(k) * GOLDEN_ANGLE + 2.0 * PI * chance.x;
    return sqrt((float(k) + chance.y) / float(count)) * vec2(cos(angle), sin(angle));
}

// Part of the light's disc that no mesh hides. `index` is the light's.
float light_seen(light l, int index, light_ray ray, vec3 p, vec2 chance) {
    float far = ray.distance - (l.kind == LIGHT_SUN ? 0.0 : l.radius);
    if (shadow_samples == 0 || far <= 0.0) return 1.0;
#if MANY_RAYS
    uint list = shaft_of(index);
    if (shaft_is_clear(list)) return 1.0;
    int count = l.radius > 0.0 ? shadow_samples : 1, seen = 0;
    mat2x3 disc = across(ray.direction) * (l.kind == LIGHT_SUN ? l.radius : l.radius / ray.distance);
    for (int k = 0; k < count; k++) {
        vec2 point = count > 1 ? disc_point(k, count, chance) : vec2(0.0);
        if (!shaft_occluded(list, p, normalize(ray.direction + disc * point), far)) seen++;
    }
    return float(seen) / float(count);
#else
    return bvh_occluded(p, ray.direction, 0.0, far) ? 0.0 : 1.0;
#endif
}

// Irradiance from the sky over pi. A ray that meets a mesh brings what the sky lends to that, as
// far as it faces up: below the horizon it may face anything.
vec3 sky_light(vec3 p, vec3 n, vec2 chance) {
    vec3 whole = sky_irradiance(n);
#if MANY_RAYS
    if (sky_samples == 0) return whole;
    mat2x3 disc = across(n);
    vec3 back = vec3(0.0);
    int seen = 0;
    for (int k = 0; k < sky_samples; k++) { // by the cosine: points of the disc, lifted to the sphere
        vec2 point = disc_point(k, sky_samples, chance);
        vec3 way = disc * point + sqrt(max(1.0 - dot(point, point), 0.0)) * n;
        bvh_hit hit = bvh_trace(p, way, 0.0, 1e9);
        if (hit.distance < 0.0) seen++;
        else back += (0.5 + 0.5 * hit.normal.z) * hit.albedo * sky_irradiance(hit.normal);
    }
    return (float(seen) * whole + back) / float(sky_samples);
#else
    return whole;
#endif
}

// Irradiance at p, on the side of the normal, over pi: what a white surface sends back.
vec3 surface_light(vec3 p, vec3 n, uvec2 pixel) {
#if MANY_RAYS
    vec2 chance = random_blue2(pixel, frame.size.z);
#else
    const vec2 chance = vec2(0.5);
#endif
    vec3 sum = sky_light(p, n, chance);
#if HAS_LIGHTS && HAS_SHADOW
    vec3 extinction = lighting_extinction();
    int declared = lighting_declared(); // the others are fire, which no volume hides
#endif
    int count = light_count();
    for (int i = 0; i < count; i++) {
        light l = light_get(i);
        light_ray ray = light_at(l, p);
        vec3 given = ray.irradiance * (max(dot(n, ray.direction), 0.0) / PI);
        bool matters = any(greaterThan(given, NEGLIGIBLE * sum));
#if HAS_LIGHTS && HAS_SHADOW
        if (matters && i < declared) given *= exp(-extinction * lighting_shadow(i, p).x);
#endif
        if (matters) given *= light_seen(l, i, ray, p, chance);
        sum += given;
    }
#if HAS_LAMPS
    for (lamp_list list = lamps_at(ivec2(pixel)); lamps_next(list);) {
        light_ray ray = lamp_ray(lamps_get(list), p);
        sum += ray.irradiance * max(dot(n, ray.direction), 0.0) / 3.14159265;
    }
#endif
    return sum;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    surface_point s = surface_at(uv);
    if (s.base.a == 0.0) {
        imageStore(color, pixel, vec4(night_sky(normalize(frame_ray(uv)), 2.0 * frame.lens.y / float(size.y)), 1.0) * sky_alpha);
        return;
    }
    vec3 lit = s.base.rgb * surface_light(s.p, s.normal, uvec2(pixel));
    imageStore(color, pixel, vec4(mix(frame.sky_horizon.rgb, lit, exp(-haze * s.distance)), 1.0));
}
