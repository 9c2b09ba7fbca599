// A coarser grid, half as large: sweeps there bring light far, for which it would take many more on
// the fine one (Brandt, "Multi-level adaptive solutions to boundary-value problems", 1977, section
// 4: the correction scheme).
//
// Of the scattered light s a sweep A makes first + A s. What s lacks is e = r + A e, where r = first
// + A s - s is what the sweep changed: the same equation, with darkness around and smoke without
// fire. It is smooth enough for the coarser grid, and brings no error of that into what is right.
//
// RESTRICT: s of the sweep that was, and r for the coarser level. REDUCE: e of a sweep there.
// PROLONG: adds what e has besides r, which the sweep has added itself.
#if defined(STAGE_RESTRICT) || defined(STAGE_REDUCE) || defined(STAGE_PROLONG)
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
layout(std430) buffer Scattered { vec4 scattered[]; };
layout(std430) readonly buffer First { vec4 first[]; };
layout(std430) readonly buffer Part { float part[]; };

// The grids of the colours lie above each other.
ivec4 voxel_and_color() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    return ivec4(at.xy, at.z % LEVEL_SIZE, at.z / LEVEL_SIZE);
}
#endif

#if defined(STAGE_RESTRICT)
layout(std430) writeonly buffer CoarseScattered { vec4 coarse_scattered[]; };
layout(std430) writeonly buffer CoarseFirst { vec4 coarse_first[]; };
layout(std430) writeonly buffer CoarseSource { uvec2 coarse_source_slices[]; };
layout(std430) readonly buffer CoarsePart { float coarse_part[]; };
shared vec4 changed[4][8][8]; // times the density
shared float weights[4][8][8];

void tell_coarse(ivec3 voxel, int color, ivec3 within) {
    const int size = LEVEL_SIZE / 2, voxels = VOXELS / 8;
    vec4 sum = vec4(0.0);
    float weight = 0.0;
    for (int i = 0; i < 8; i++) {
        ivec3 fine = within + ivec3(i & 1, (i >> 1) & 1, i >> 2);
        sum += changed[fine.z][fine.y][fine.x];
        weight += weights[fine.z][fine.y][fine.x];
    }
    vec4 mean = sum / weight;
    int at = place_in(voxel, color, size);
    coarse_first[at] = coarse_scattered[at] = mean;
    vec4 told = coarse_part[at] * vec4(mean.x, 3.0 * medium_anisotropy() * mean.yzw);
    uvec2 packed = uvec2(half_pair(told.x, told.y), half_pair(told.z, told.w));
    ivec3 along[3] = ivec3[](voxel.yzx, voxel.zxy, voxel);
    for (int axis = 0; axis < 3; axis++)
        coarse_source_slices[(axis * 3 + color) * voxels + place_in(along[axis], 0, size)] = packed;
}

void main() {
    ivec4 own = voxel_and_color();
    ivec3 within = ivec3(gl_LocalInvocationID);
    bool there = all(lessThan(own.xyz, ivec3(LEVEL_SIZE))) && own.w < 3;
    if (there) {
        int at = place_of(own.xyz, own.w);
        vec4 moments = moments_of(own.xyz, own.w), swept = moments + first[at];
        float weight = texelFetch(medium_made, own.xyz, 0).a + 1e-6; // what is lit is the smoke
        changed[within.z][within.y][within.x] = weight * (swept - scattered[at]);
        weights[within.z][within.y][within.x] = weight;
        scattered[at] = swept;
        if (sweeps == 0)
            imageStore(glow, own.xyz + ivec3(0, 0, own.w * LEVEL_SIZE), clamp(moments, -HALF_MOST, HALF_MOST));
    }
    barrier();
    if (there && ((within.x | within.y | within.z) & 1) == 0) tell_coarse(own.xyz / 2, own.w, within);
}
#endif

#if defined(STAGE_REDUCE)
layout(std430) buffer Last { vec4 last[]; }; // a sweep earlier

// Light that is scattered on and on converges slowly where little is lost. Chebyshev's combination
// of successive sweeps (Golub and Varga, "Chebyshev semi-iterative methods", 1961) makes that as
// fast as is possible for a part of at most `most` that stays in the volume at each scattering.
vec4 hasten(vec4 swept, vec4 now, int at) {
    float most = clamp(max(albedo.r, max(albedo.g, albedo.b)), 0.3, 0.98);
    float spread = most / (2.0 - most), weight = 1.0 / (1.0 - 0.5 * spread * spread);
    for (int i = 1; i < hastened; i++) weight = 1.0 / (1.0 - 0.25 * spread * spread * weight);
    vec4 ahead = now + (swept - now) * 2.0 / (2.0 - most);
    return hastened == 0 ? ahead : mix(last[at], ahead, weight);
}

void main() {
    ivec4 own = voxel_and_color();
    if (any(greaterThanEqual(own.xyz, ivec3(LEVEL_SIZE))) || own.w >= 3) return;
    int at = place_of(own.xyz, own.w);
    vec4 now = scattered[at];
    vec4 made = hasten(moments_of(own.xyz, own.w) + first[at], now, at);
    last[at] = now;
    scattered[at] = made;
    tell_source(own.xyz, own.w, part[at], made);
}
#endif

#if defined(STAGE_PROLONG)
layout(std430) readonly buffer CoarseScattered { vec4 coarse_scattered[]; };
layout(std430) readonly buffer CoarseFirst { vec4 coarse_first[]; };

// Between the eight voxels of the coarser grid around one of the finer.
vec4 coarse_at(ivec3 voxel, int color) {
    const int size = LEVEL_SIZE / 2;
    ivec3 near = voxel / 2, far = clamp(near + 2 * (voxel & 1) - 1, ivec3(0), ivec3(size - 1));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 8; i++) {
        bvec3 away = signs_of(i);
        vec3 weights = mix(vec3(0.75), vec3(0.25), away);
        int at = place_in(mix(near, far, away), color, size);
        sum += weights.x * weights.y * weights.z * (coarse_scattered[at] - coarse_first[at]);
    }
    return sum;
}

void main() {
    ivec4 own = voxel_and_color();
    if (any(greaterThanEqual(own.xyz, ivec3(LEVEL_SIZE))) || own.w >= 3) return;
    int at = place_of(own.xyz, own.w);
    vec4 made = scattered[at] + coarse_at(own.xyz, own.w);
    made.x = max(made.x, 0.0); // as light is: not negative, and no more to one side than there is
    made.yzw *= min(made.x / max(length(made.yzw), 1e-20), 1.0);
    scattered[at] = made;
    tell_source(own.xyz, own.w, part[at], made);
    if (last_sweep)
        imageStore(glow, own.xyz + ivec3(0, 0, own.w * LEVEL_SIZE), clamp(made - first[at], -HALF_MOST, HALF_MOST));
}
#endif
