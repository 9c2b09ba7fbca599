// A coarser grid, half as large: sweeps there bring light far, for which it would take many more on
// the fine one (Brandt, "Multi-level adaptive solutions to boundary-value problems", 1977, section
// 4: the correction scheme).
//
// Of the scattered light s a sweep A makes first + A s. What s lacks is e = r + A e, where r = first
// + A s - s is what the sweep changed: the same equation, with darkness around and smoke without
// fire. It is smooth enough for the coarser grid, and brings no error of that into what is right.
//
// RESTRICT: the medium and r for the coarser level. PROLONG: adds what e has besides r, which the
// sweep has added itself.
#if defined(STAGE_RESTRICT)
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

// Density whose light goes a voxel's width in nothing else.
float thin() {
    vec3 size = (box_max - box_min) / float(GLOW_SIZE), all = medium_extinction();
    return 1.0 / max(max(size.x, max(size.y, size.z)) * max(all.r, max(all.g, all.b)), 1e-9);
}

// Light seeps through thick smoke by its gaps, which a mean of densities would close: it would stay
// in the coarser grid for longer than it does, and corrections would grow without end. The geometric
// mean is that of a random mixture in a plane (Matheron, "Elements pour une theorie des milieux
// poreux", 1967).
void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID), size = imageSize(medium_kept);
    if (any(greaterThanEqual(voxel, size))) return;
    vec4 dyed = vec4(0.0), changed[3] = vec4[](vec4(0.0), vec4(0.0), vec4(0.0));
    float sum = 0.0, logs = 0.0, gap = thin();
    for (int i = 0; i < 8; i++) {
        ivec3 fine = 2 * voxel + ivec3(i & 1, (i >> 1) & 1, i >> 2);
        float weight = texelFetch(medium_fine, fine, 0).a + 1e-6; // what is lit and dyed is the smoke
        sum += weight;
        logs += 0.125 * log(weight + gap);
        dyed += weight * texelFetch(scattering_fine, fine, 0);
        for (int c = 0; c < 3; c++) {
            ivec3 at = fine + ivec3(0, 0, 2 * c * size.z);
            changed[c] += weight * (texelFetch(source_fine, at, 0) - texelFetch(last_fine, at, 0));
        }
    }
    imageStore(medium_kept, voxel, vec4(vec3(0.0), max(exp(logs) - gap, 0.0)));
    imageStore(scattering_kept, voxel, dyed / sum);
    for (int c = 0; c < 3; c++) {
        imageStore(first_kept, voxel + ivec3(0, 0, c * size.z), changed[c] / sum);
        imageStore(source_kept, voxel + ivec3(0, 0, c * size.z), changed[c] / sum);
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
        vec4 wrong = textureLod(source_coarse, coarse, 0.0) - textureLod(first_coarse, coarse, 0.0);
        ivec3 own = voxel + ivec3(0, 0, c * size.z);
        vec4 source = imageLoad(source_kept, own) + wrong;
        source.x = max(source.x, 0.0); // as light is: not negative, and no more to one side than there is
        source.yzw *= min(source.x / max(length(source.yzw), 1e-20), 1.0);
        imageStore(source_kept, own, source);
        imageStore(glow, own, clamp(source - texelFetch(first_made, own, 0), -HALF_MOST, HALF_MOST));
    }
}
#endif
