// Coarser grids, level by level half as large: a few sweeps of light there bring far what would
// take many on the finest. (Nested iteration: Brandt, "Multi-level adaptive solutions to
// boundary-value problems", 1977.)
//
// RESTRICT: the medium and its first scattering for the next coarser level. PROLONG: from there, the
// scattered light that a level's sweeps begin with.
#if defined(STAGE_RESTRICT)
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID), size = imageSize(medium_kept);
    if (any(greaterThanEqual(voxel, size))) return;
    vec4 medium = vec4(0.0), dyed = vec4(0.0), first[3] = vec4[](vec4(0.0), vec4(0.0), vec4(0.0));
    float sum = 0.0;
    for (int i = 0; i < 8; i++) {
        ivec3 fine = 2 * voxel + ivec3(i & 1, (i >> 1) & 1, i >> 2);
        vec4 one = texelFetch(medium_fine, fine, 0);
        float weight = one.a + 1e-6; // what is lit and dyed is the smoke
        sum += weight;
        medium += 0.125 * one;
        dyed += weight * texelFetch(scattering_fine, fine, 0);
        for (int c = 0; c < 3; c++)
            first[c] += weight * texelFetch(first_fine, fine + ivec3(0, 0, 2 * c * size.z), 0);
    }
    imageStore(medium_kept, voxel, medium);
    imageStore(scattering_kept, voxel, dyed / sum);
    for (int c = 0; c < 3; c++) {
        imageStore(first_kept, voxel + ivec3(0, 0, c * size.z), first[c] / sum);
        imageStore(source_kept, voxel + ivec3(0, 0, c * size.z), first[c] / sum);
    }
}
#endif

#if defined(STAGE_PROLONG)
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID), size = textureSize(medium_made, 0);
    if (any(greaterThanEqual(voxel, size))) return;
    vec3 half_texel = 1.0 / vec3(size); // of the coarser level
    vec3 at = clamp((vec3(voxel) + 0.5) / vec3(size), half_texel, 1.0 - half_texel);
    for (int c = 0; c < 3; c++) {
        vec3 coarse = vec3(at.xy, (at.z + float(c)) / 3.0);
        vec4 scattered = textureLod(source_coarse, coarse, 0.0) - textureLod(first_coarse, coarse, 0.0);
        ivec3 own = voxel + ivec3(0, 0, c * size.z);
        imageStore(source_kept, own, scattered + texelFetch(first_made, own, 0));
    }
}
#endif
