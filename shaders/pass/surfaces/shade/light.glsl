// The light that a surface gets and sends back, for `shade` and `forward`.
//
// The including shader has the uniforms shadow_samples and sky_samples; MANY_RAYS says whether they
// are looked at, SHAFTS whether there are lists of what may stand in the rays' way (shafts.glsl).
//@ option shadows_by = auto {auto, maps, rays, both} : how it is found out what stands before sun and lights: maps: by the maps of shadow_maps, and nothing hides lights that have none; rays: by rays, of all; both: by rays where there are no maps; auto: rays, or else both, by what is faster on the device

const float PI = 3.14159265, GOLDEN_ANGLE = 2.39996323;
const float NEGLIGIBLE = 1.0 / 4096.0; // of the light on a surface: such a light gets no shadow

// Point k of `count` that are evenly spread over the unit disc, turned by chance (Vogel 1979).
vec2 disc_point(int k, int count, vec2 chance) {
    float angle = float(k) * GOLDEN_ANGLE + 2.0 * PI * chance.x;
    return sqrt((float(k) + chance.y) / float(count)) * vec2(cos(angle), sin(angle));
}

#if HAS_SHADOW_MAPS && SHADOWS_BY == SHADOWS_BY_MAPS
#define LIGHT_RAYS 0
#else
#define LIGHT_RAYS 1
#endif

#if LIGHT_RAYS
// Part of the light's disc that no mesh hides, by rays. `index` is the light's.
float light_traced(light l, int index, light_ray ray, shaded s, vec2 chance) {
    float far = ray.distance - (l.kind == LIGHT_SUN ? 0.0 : l.radius);
    if (shadow_samples == 0 || far <= 0.0) return 1.0;
#if MANY_RAYS
#if SHAFTS
    uint list = shaft_of(index);
    if (shaft_is_clear(list)) return 1.0;
#endif
    int count = l.radius > 0.0 ? shadow_samples : 1, seen = 0;
    mat2x3 disc = across(ray.direction) * (l.kind == LIGHT_SUN ? l.radius : l.radius / ray.distance);
    for (int k = 0; k < count; k++) {
        vec2 point = count > 1 ? disc_point(k, count, chance) : vec2(0.0);
        vec3 way = normalize(ray.direction + disc * point);
#if SHAFTS
        if (!shaft_occluded(list, s.position, way, far)) seen++;
#else
        if (!bvh_occluded(s.position, way, 0.0, far)) seen++;
#endif
    }
    return float(seen) / float(count);
#else
    return bvh_occluded(s.position, ray.direction, 0.0, far) ? 0.0 : 1.0;
#endif
}
#endif

float light_seen(light l, int index, light_ray ray, shaded s, vec2 chance) {
#if HAS_SHADOW_MAPS && SHADOWS_BY != SHADOWS_BY_RAYS
    shadow_maps maps = shadow_maps_of(index);
    if (maps.count > 0) return shadow_of(maps, l.kind == LIGHT_SUN, l.position, s.position, s.normal);
#endif
#if LIGHT_RAYS
    return light_traced(l, index, ray, s, chance);
#else
    return 1.0;
#endif
}

// What a mesh that a ray has met sends back of the sky, as far as it faces up: below the horizon it
// may face anything.
vec3 sky_from_mesh(bvh_hit hit) {
    return (0.5 + 0.5 * hit.normal.z) * hit.albedo * sky_irradiance(hit.normal);
}

// Irradiance from the sky over pi. Rays that meet a mesh bring what the sky lends to that.
vec3 sky_light(shaded s, vec2 chance) {
    if (shading_is_toon(s)) return sky_mean(); // no shades between the bands
    vec3 whole = sky_irradiance(s.normal);
#if MANY_RAYS
    if (sky_samples == 0) return whole;
    mat2x3 disc = across(s.normal);
    vec3 back = vec3(0.0);
    int seen = 0;
    for (int k = 0; k < sky_samples; k++) { // by the cosine: points of the disc, lifted to the sphere
        vec2 point = disc_point(k, sky_samples, chance);
        vec3 way = disc * point + sqrt(max(1.0 - dot(point, point), 0.0)) * s.normal;
        bvh_hit hit = bvh_trace(s.position, way, 0.0, 1e9);
        if (hit.distance < 0.0) seen++;
        else back += sky_from_mesh(hit);
    }
    return (float(seen) * whole + back) / float(sky_samples);
#else
    return whole;
#endif
}

// Radiance that the surface mirrors of the sky: the rougher, the more of it is seen at once.
vec3 sky_mirrored(shaded s) {
    if (!shading_is_physical(s) || s.specular + s.metallic <= 0.0) return vec3(0.0);
    vec3 way = reflect(-s.view, s.normal), wide = sky_irradiance(way), given = sky_radiance(way);
#if MANY_RAYS
    if (sky_samples > 0) {
        bvh_hit hit = bvh_trace(s.position, way, 0.0, 1e9);
        if (hit.distance >= 0.0) given = sky_from_mesh(hit);
    }
#endif
    return shading_mirrored(s) * mix(given, wide, s.roughness);
}

#include "point_lights.glsl"

// Radiance towards the viewer, of all light but what the surface itself gives off.
vec3 surface_light(shaded s, uvec2 pixel) {
#if MANY_RAYS
    vec2 chance = random_blue2(pixel, frame.size.z);
#else
    const vec2 chance = vec2(0.5);
#endif
    reflected sum = reflected(sky_light(s, chance), sky_mirrored(s));
#if HAS_LIGHTS && HAS_SHADOW
    vec3 extinction = lighting_extinction();
    int declared = lighting_declared(); // the others are fire, which no volume hides
#endif
    int count = light_count();
    for (int i = 0; i < count; i++) {
        light l = light_get(i);
        light_ray ray = light_at(l, s.position);
        reflected given = shading_respond(s, ray.direction, ray.irradiance);
        bool matters = any(greaterThan(given.white + given.shine, NEGLIGIBLE * (sum.white + sum.shine)));
#if HAS_LIGHTS && HAS_SHADOW
        if (matters && i < declared) shading_dim(given, exp(-extinction * lighting_shadow(i, s.position).x));
#endif
        if (matters) shading_dim(given, vec3(light_seen(l, i, ray, s, chance)));
        shading_add(sum, given);
    }
#if HAS_POINT_LIGHTS && !POINT_LIGHTS_VOLUMES
    add_point_lights(sum, s, ivec2(pixel));
#endif
    return shading_total(s, sum);
}
