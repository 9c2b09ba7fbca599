// The medium on a grid over its box, each voxel the mean of eight points.
#if defined(STAGE_MEDIUM)
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(voxel, ivec3(GLOW_SIZE)))) return;
    vec3 glowing = vec3(0.0), dyed = vec3(0.0);
    float sum = 0.0;
    for (int i = 0; i < 8; i++) {
        vec3 within = vec3(i & 1, (i >> 1) & 1, i >> 2) * 0.5 + 0.25;
        vec3 p = mix(box_min, box_max, (vec3(voxel) + within) / float(GLOW_SIZE));
        float d = medium_density(p);
        if (d <= 0.0) continue;
        sum += d;
        glowing += medium_emission(p, d);
        dyed += d * medium_scattering(p);
    }
    count_samples(8);
    imageStore(medium_kept, voxel, vec4(glowing, sum) / 8.0);
    // Where nothing is, light is as if a little were: what is between voxels is interpolated.
    imageStore(scattering_kept, voxel, vec4(sum > 0.0 ? dyed / sum : extinction * albedo, 0.0));
}
#endif
