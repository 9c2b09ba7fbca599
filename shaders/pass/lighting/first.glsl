// The light that each voxel scatters for the first time: what comes straight from the lights, as
// its mean over all directions and its first moment.
#if defined(STAGE_FIRST)
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

// Mean of what is left of a light within a voxel, weighted by the density: a voxel of thick smoke
// may take all of it, of which a look at its centre would tell nothing. Along a line that takes
// from t0 to t1, the mean of exp(-t) is (exp(-t0) - exp(-t1)) / (t1 - t0).
vec3 left_of_light(shadow_map m, vec3 p, vec3 way, vec3 voxel) {
    vec3 taken = medium_extinction(), lost = vec3(0.0), mean = vec3(0.0);
    float passed = 0.0;
    vec3 half_chord = 0.5 / dot(abs(way) / voxel, vec3(1.0)) * way;
    for (int i = 0; i < 4; i++) { // corners of a tetrahedron
        vec3 at = p + (vec3(i & 1, i >> 1, (i ^ (i >> 1) ^ 1) & 1) - 0.5) * 0.5 * voxel;
        vec2 before = shadow_map_read(shadow_made, m, at - half_chord);
        vec2 after = shadow_map_read(shadow_made, m, at + half_chord);
        vec3 in_ = exp(-taken * before.x), out_ = exp(-taken * after.x);
        float seen = 0.5 * (before.y + after.y);
        passed += max(after.x - before.x, 0.0);
        lost += seen * max(in_ - out_, vec3(0.0));
        mean += 0.25 * seen * sqrt(in_ * out_);
    }
    return mix(mean, lost / max(taken * passed, vec3(1e-6)), greaterThan(taken * passed, vec3(1e-2)));
}

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(voxel, ivec3(GLOW_SIZE)))) return;
    vec3 size = (box_max - box_min) / float(GLOW_SIZE), p = box_min + (vec3(voxel) + 0.5) * size;
    vec3 mean = vec3(0.0), flux[3] = vec3[](vec3(0.0), vec3(0.0), vec3(0.0));
    bool empty = texelFetch(medium_made, voxel, 0).a <= 0.0;
    int declared = empty ? 0 : int(texelFetch(lights_made, ivec2(8, 0), 0).w);
    for (int i = 0; i < declared; i++) {
        light l = light_get(i);
        // The mean of the inverse square over a voxel that the light is in.
        if (l.kind != LIGHT_SUN) l.radius = max(l.radius, 0.36 * max(size.x, max(size.y, size.z)));
        light_ray ray = light_at(l, p);
        if (max(ray.irradiance.r, max(ray.irradiance.g, ray.irradiance.b)) <= 0.0) continue;
        shadow_map m = shadow_map_of(lights_made, i);
        vec3 light = ray.irradiance * left_of_light(m, p, -ray.direction, size) / (4.0 * PI);
        mean += light;
        for (int c = 0; c < 3; c++) flux[c] -= light[c] * ray.direction;
    }
    for (int c = 0; c < 3; c++) {
        vec4 moments = vec4(mean[c], flux[c]);
        imageStore(first_kept, voxel + ivec3(0, 0, c * GLOW_SIZE), moments);
        imageStore(source_kept, voxel + ivec3(0, 0, c * GLOW_SIZE), sweeps > 0 ? moments : vec4(0.0));
    }
}
#endif
