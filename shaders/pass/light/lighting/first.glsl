// The light that each voxel scatters for the first time: what comes straight from the lights, as
// its mean over all directions and its first moment. And the medium as the sweeps want it, of both
// levels.
#if defined(STAGE_FIRST)
const ivec3 BLOCK = ivec3(8, 4, 2); // voxels of a group
layout(local_size_x = BLOCK.x, local_size_y = BLOCK.y, local_size_z = BLOCK.z) in;
layout(std430) writeonly buffer First { vec4 first[]; };         // moments of this light
layout(std430) writeonly buffer Scattered { vec4 scattered[]; }; // of all light that is scattered
layout(std430) writeonly buffer Part { float part[]; };          // of the light that is taken: that is scattered
layout(std430) writeonly buffer Medium { uint medium_slices[]; };
layout(std430) writeonly buffer CoarsePart { float coarse_part[]; };
layout(std430) writeonly buffer CoarseMedium { uint coarse_medium_slices[]; };
shared vec4 block[BLOCK.z][BLOCK.y][BLOCK.x]; // part, density

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

// Straight from the lights: moments of each colour.
void find_first(ivec3 voxel, out vec4 moments[3]) {
    vec3 size = voxel_size(), p = box_min + (vec3(voxel) + 0.5) * size;
    for (int c = 0; c < 3; c++) moments[c] = vec4(0.0);
    int declared = int(texelFetch(lights_made, ivec2(8, 0), 0).w);
    for (int i = 0; i < declared; i++) {
        light l = light_get(i);
        // The mean of the inverse square over a voxel that the light is in.
        if (l.kind != LIGHT_SUN) l.radius = max(l.radius, 0.36 * max(size.x, max(size.y, size.z)));
        light_ray ray = light_at(l, p);
        if (max(ray.irradiance.r, max(ray.irradiance.g, ray.irradiance.b)) <= 0.0) continue;
        shadow_map m = shadow_map_of(lights_made, i);
        vec3 light = ray.irradiance * left_of_light(m, p, -ray.direction, size) / (4.0 * PI);
        for (int c = 0; c < 3; c++) moments[c] += light[c] * vec4(1.0, -ray.direction);
    }
}

// Density whose light goes a voxel's width in nothing else.
float thin() {
    vec3 all = medium_extinction();
    return 1.0 / max(voxel_width() * max(all.r, max(all.g, all.b)), 1e-9);
}

// The medium of the coarser level; its smoke is without fire (lighting/level.glsl).
//
// Light seeps through thick smoke by its gaps, which a mean of densities would close: it would stay
// in the coarser grid for longer than it does, and corrections would grow without end. The geometric
// mean is that of a random mixture in a plane (Matheron, "Elements pour une theorie des milieux
// poreux", 1967).
void tell_coarse(ivec3 within) {
    const int size = LEVEL_SIZE / 2, voxels = VOXELS / 8;
    ivec3 voxel = ivec3(gl_WorkGroupID) * (BLOCK / 2) + within;
    vec3 parts = vec3(0.0);
    float sum = 0.0, logs = 0.0, gap = thin();
    for (int i = 0; i < 8; i++) {
        ivec3 fine = 2 * within + ivec3(i & 1, (i >> 1) & 1, i >> 2);
        vec4 found = block[fine.z][fine.y][fine.x];
        float weight = found.a + 1e-6; // what is lit and dyed is the smoke
        sum += weight;
        logs += 0.125 * log(weight + gap);
        parts += weight * found.rgb;
    }
    uint thickness = half_pair(2.0 * voxel_width() * max(exp(logs) - gap, 0.0), 0.0);
    ivec3 along[3] = ivec3[](voxel.yzx, voxel.zxy, voxel);
    for (int c = 0; c < 3; c++) {
        coarse_part[place_in(voxel, c, size)] = parts[c] / sum;
        for (int axis = 0; axis < 3; axis++)
            coarse_medium_slices[(axis * 3 + c) * voxels + place_in(along[axis], 0, size)] = thickness;
    }
}

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID), within = ivec3(gl_LocalInvocationID);
    vec4 medium = texelFetch(medium_made, voxel, 0), moments[3] = vec4[](vec4(0.0), vec4(0.0), vec4(0.0));
    vec3 parts = texelFetch(scattering_made, voxel, 0).rgb / max(medium_extinction(), vec3(1e-9));
    if (medium.a > 0.0) find_first(voxel, moments);
    for (int c = 0; c < 3; c++) {
        int at = place_of(voxel, c);
        vec4 known = sweeps > 0 ? moments[c] : vec4(0.0);
        first[at] = moments[c];
        scattered[at] = known;
        part[at] = parts[c];
        tell_source(voxel, c, parts[c], known);
        uint told = half_pair(voxel_width() * medium.a, voxel_width() * medium[c]);
        for (int axis = 0; axis < 3; axis++)
            medium_slices[(axis * 3 + c) * VOXELS + place_along(axis, voxel)] = told;
    }
    block[within.z][within.y][within.x] = vec4(parts, medium.a);
    barrier();
    if (all(lessThan(within, BLOCK / 2))) tell_coarse(within);
}
#endif
