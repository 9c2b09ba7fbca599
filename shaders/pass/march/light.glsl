// The light that reaches a point of the march and is scattered there into its ray.
#if !defined(WITHOUT_RAYS)

// Density times metres along a ray from p; steps grow with distance, where detail matters less.
float depth_along(vec3 p, vec3 direction, float far, int count) {
    float sum = 0.0, from = 0.0;
    int taken = 0;
    for (int i = 0; i < count; i++) {
        float part = float(i + 1) / float(count);
        float to = far * part * part;
        vec3 middle = p + 0.5 * (from + to) * direction;
        if (may_hold(middle)) {
            sum += medium_density(middle) * (to - from);
            taken++;
        }
        from = to;
    }
    count_samples(taken);
    return sum;
}

struct obstacle {
    vec3 depth;    // optical, of the volume
    float visible; // part of the light that no mesh hides
};

#if HAS_LIGHTS && HAS_SHADOW
obstacle before_light(int index, light l, light_ray ray, vec3 p) {
    vec3 depth = vec3(0.0), from = p;
    if (near_steps > 0) {
        float texel = greatest(box_max - box_min) / float(textureSize(shadow, 0).x);
        float near = min(texel, max(ray.distance - l.radius, 0.0));
        depth = medium_extinction() * depth_along(p, ray.direction, near, near_steps);
        from += near * ray.direction;
    }
    vec2 cached = lighting_shadow(index, from);
    return obstacle(depth + lighting_extinction() * cached.x, cached.y);
}
#else
obstacle before_light(int index, light l, light_ray ray, vec3 p) {
    float far = max(ray.distance - l.radius, 0.0);
#if MESH_SHADOWS == MESH_SHADOWS_ON
    if (bvh_occluded(p, ray.direction, 1e-3, far)) return obstacle(vec3(0.0), 0.0);
#endif
    far = min(far, box_exit(p, ray.direction, box_min, box_max));
    // What the smoke takes of the light of its fire is off that light's colour already.
    bool taken = l.kind == LIGHT_FIRE;
    float density = taken ? 0.0 : depth_along(p, ray.direction, min(far, shadow_distance), shadow_steps);
    return obstacle(medium_extinction() * density, shadow_steps > 0 ? 1.0 : 0.0);
}
#endif

// Part of a light's irradiance that is scattered into a direction, 1/sr.
vec3 scattered_part(float cosine, vec3 depth) {
#if SCATTERING == SCATTERING_OCTAVES
    vec3 sum = vec3(0.0);
    float part = 1.0, through = 1.0, spread = 1.0;
    for (int i = 0; i < octaves; i++) {
        sum += part * medium_phase(cosine, spread) * exp(-through * depth);
        part *= octave_contribution;
        through *= octave_extinction;
        spread *= octave_anisotropy;
    }
#else
    vec3 sum = medium_phase(cosine, 1.0) * exp(-depth);
#endif
    return sum * mix(vec3(1.0), 1.0 - exp(-2.0 * depth), powder);
}

// Radiance that a metre of scattering coefficient 1 adds to a ray at p.
vec3 scattered_light(vec3 p, vec3 direction) {
#if GLOWS
    vec3 sum = lighting_scattered(p, -direction, medium_anisotropy());
    int count = lighting_declared();
#else
    vec3 sum = ambient * sky_mean();
    int count = light_count();
#endif
    for (int i = 0; i < count; i++) {
        light l = light_get(i);
        light_ray ray = light_at(l, p);
        if (greatest(ray.irradiance) <= 0.0) continue;
        obstacle before = before_light(i, l, ray, p);
        if (before.visible <= 0.0) continue;
        float cosine = dot(direction, ray.direction);
        sum += ray.irradiance * before.visible * scattered_part(cosine, before.depth);
    }
    return sum;
}
#endif
