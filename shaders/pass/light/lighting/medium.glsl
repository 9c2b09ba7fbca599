// The medium on a grid over its box, each voxel the mean of eight points, which have a thread each.
#if defined(STAGE_MEDIUM)
layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
shared vec4 found[2][4][8];  // emission, density
shared vec3 dyed[2][4][8];   // scattering, times the density

void look(ivec3 within) {
    vec3 p = mix(box_min, box_max, (vec3(gl_GlobalInvocationID) + 0.5) / float(2 * GLOW_SIZE));
    float d = medium_density(p);
    vec3 emission = vec3(0.0), scattering = vec3(0.0);
    if (d > 0.0) {
        emission = medium_emission(p, d);
        scattering = medium_scattering(p);
    }
    found[within.z][within.y][within.x] = vec4(emission, d);
    dyed[within.z][within.y][within.x] = d * scattering;
    count_samples(1);
}

void main() {
    ivec3 within = ivec3(gl_LocalInvocationID), voxel = ivec3(gl_GlobalInvocationID) / 2;
    look(within);
    barrier();
    if (((within.x | within.y | within.z) & 1) != 0) return;
    vec4 sum = vec4(0.0);
    vec3 dye = vec3(0.0);
    for (int i = 0; i < 8; i++) {
        ivec3 at = within + ivec3(i & 1, (i >> 1) & 1, i >> 2);
        sum += found[at.z][at.y][at.x];
        dye += dyed[at.z][at.y][at.x];
    }
    imageStore(medium_kept, voxel, sum / 8.0);
    // Where nothing is, light is as if a little were: what is between voxels is interpolated.
    imageStore(scattering_kept, voxel, vec4(sum.a > 0.0 ? dye / sum.a : medium_albedo(), 0.0));
}
#endif
