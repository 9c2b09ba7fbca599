// Light through the volume in a few directions, by the method of discrete ordinates with short
// characteristics: Kunasz and Auer, "Short characteristic integration of radiative transfer
// problems", 1988; on grids for pictures: Fattal, "Participating media illumination using light
// propagation maps", 2009.
//
// SWEEP: one workgroup a direction takes slice after slice across it, each from the one before.
// REDUCE: from all directions the mean and first moment, which the next sweep scatters.

#if defined(STAGE_SWEEP) || defined(STAGE_REDUCE)
int voxels_across() { // on the level at hand
    return textureSize(medium_made, 0).x;
}

// Where the radiance of a voxel in a direction is kept.
ivec3 place_of(ivec3 voxel, int index) {
    return voxel + ivec3(index & 7, index >> 3, 0) * voxels_across();
}

#if defined(STAGE_SWEEP)
layout(local_size_x = SWEEP_SIZE * SWEEP_SIZE) in;
const bool CORRECTS = SWEEP_SIZE < GLOW_SIZE; // what it sweeps is a difference (lighting/level.glsl)

struct cell {
    vec3 light;     // where it leaves the voxel
    vec3 scattered; // per part of the light that the medium takes: the source function
    float taken;    // part of the light that half a voxel takes
};

shared cell slice[SWEEP_SIZE * SWEEP_SIZE]; // the one before

struct path { // of a direction through the grid
    vec3 way;
    ivec3 axes;   // the one slices follow each other on, and the other two
    vec2 back;    // cells sideways to where the way comes from, one slice before
    float metres; // from slice to slice
    vec3 outside; // light that enters the box
};

path make_path(int index) {
    vec3 way = way_of(index);
    vec3 cells = way * float(voxels_across()) / max(box_max - box_min, vec3(1e-6)), a = abs(cells);
    int main_axis = a.x >= max(a.y, a.z) ? 0 : a.y >= a.z ? 1 : 2;
    ivec3 axes = ivec3(main_axis, (main_axis + 1) % 3, (main_axis + 2) % 3);
    return path(way, axes, -vec2(cells[axes.y], cells[axes.z]) / a[main_axis], 1.0 / a[main_axis],
                CORRECTS ? vec3(0.0) : texelFetch(around_made, ivec3(index, 0, 0), 0).rgb);
}

// Light scattered into the way at a voxel, if the medium took light there.
vec3 source_at(ivec3 voxel, vec3 way) {
    float g = medium_anisotropy();
    vec3 sum;
    for (int c = 0; c < 3; c++) {
        vec4 moments = texelFetch(source_made, voxel + ivec3(0, 0, c * voxels_across()), 0);
        sum[c] = moments.x + 3.0 * g * dot(moments.yzw, way);
    }
    vec3 part = texelFetch(scattering_made, voxel, 0).rgb / max(medium_extinction(), vec3(1e-9));
    return part * (CORRECTS ? sum : max(sum, vec3(0.0)));
}

// What comes from the slice before, between four cells of it; cells outside are empty.
cell before(path on, ivec2 at, vec3 own_source, bool first) {
    vec2 to = vec2(at) + on.back, low = floor(to);
    cell sum = cell(vec3(0.0), vec3(0.0), 0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 c = ivec2(low) + ivec2(i & 1, i >> 1);
        vec2 near = 1.0 - abs(to - vec2(c));
        float weight = near.x * near.y;
        if (first || any(lessThan(c, ivec2(0))) || any(greaterThanEqual(c, ivec2(SWEEP_SIZE)))) {
            sum.light += weight * on.outside;
            sum.scattered += weight * own_source;
        } else {
            cell from = slice[c.y * SWEEP_SIZE + c.x];
            sum.light += weight * from.light;
            sum.scattered += weight * from.scattered;
            sum.taken += weight * from.taken;
        }
    }
    return sum;
}

// Mean of exp(-t) from 0 to t.
vec3 mean_through(vec3 t) {
    return mix((1.0 - exp(-t)) / max(t, vec3(1e-6)), 1.0 - 0.5 * t, lessThan(t, vec3(1e-2)));
}

// From centre to centre the source changes linearly with what is taken, which keeps the limit of
// thick voxels, diffusion; emission is constant in each of the halves.
cell advance(path on, ivec3 voxel, int index, ivec2 at, bool first) {
    vec4 medium = texelFetch(medium_made, voxel, 0);
    vec3 own = source_at(voxel, on.way), factor = medium_extinction();
    cell from = before(on, at, own, first);
    float grey = max(factor.r, max(factor.g, factor.b));
    vec3 half_depth = 0.5 * on.metres * medium.a * factor, through = exp(-half_depth);
    vec3 given = 0.5 * on.metres * medium.rgb * mean_through(half_depth);
    // Of the half before only the colour that loses most is known; the others are powers of it.
    vec3 depth = half_depth - log(max(1.0 - from.taken, 1e-6)) * factor / max(grey, 1e-9);
    vec3 early = mix(mean_through(depth) - exp(-depth), 0.5 * depth, lessThan(depth, vec3(1e-2)));
    vec3 late = max(1.0 - exp(-depth) - early, vec3(0.0));
    vec3 light = from.light * through + given + from.scattered * early + own * late;
    imageStore(ways_kept, place_of(voxel, index), vec4(light, 0.0));
    return cell(light * through + given, own, 1.0 - exp(-0.5 * on.metres * medium.a * grey));
}

void main() {
    int index = int(gl_WorkGroupID.x), thread = int(gl_LocalInvocationIndex);
    path on = make_path(index);
    ivec2 at = ivec2(thread % SWEEP_SIZE, thread / SWEEP_SIZE);
    ivec3 voxel;
    voxel[on.axes.y] = at.x;
    voxel[on.axes.z] = at.y;
    for (int k = 0; k < SWEEP_SIZE; k++) {
        voxel[on.axes.x] = on.way[on.axes.x] > 0.0 ? k : SWEEP_SIZE - 1 - k;
        cell made = advance(on, voxel, index, at, k == 0);
        barrier();
        slice[thread] = made;
        barrier();
    }
}
#endif

#if defined(STAGE_REDUCE)
// Light that is scattered on and on converges slowly where little is lost. Chebyshev's combination
// of successive sweeps (Golub and Varga, "Chebyshev semi-iterative methods", 1961) makes that as
// fast as is possible for a part of at most `most` that stays in the volume at each scattering.
vec4 hasten(vec4 swept, vec4 now, vec4 last) {
    float most = clamp(max(albedo.r, max(albedo.g, albedo.b)), 0.3, 0.98);
    float spread = most / (2.0 - most), weight = 1.0 / (1.0 - 0.5 * spread * spread);
    for (int i = 1; i < hastened; i++) weight = 1.0 / (1.0 - 0.25 * spread * spread * weight);
    vec4 ahead = now + (swept - now) * 2.0 / (2.0 - most);
    return hastened == 0 ? ahead : mix(last, ahead, weight);
}

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    int size = voxels_across();
    if (any(greaterThanEqual(voxel, ivec3(size)))) return;
    vec3 mean = vec3(0.0), flux[3] = vec3[](vec3(0.0), vec3(0.0), vec3(0.0));
    for (int i = 0; i < WAYS; i++) {
        vec3 light = texelFetch(ways_made, place_of(voxel, i), 0).rgb / float(WAYS), way = way_of(i);
        mean += light;
        for (int c = 0; c < 3; c++) flux[c] += light[c] * way;
    }
    for (int c = 0; c < 3; c++) {
        ivec3 at = voxel + ivec3(0, 0, c * size);
        vec4 moments = vec4(mean[c], flux[c]);
        if (size == GLOW_SIZE) imageStore(glow, at, clamp(moments, -HALF_MOST, HALF_MOST));
        vec4 swept = moments + texelFetch(first_made, at, 0), now = imageLoad(source_kept, at);
        if (hastened >= 0) swept = hasten(swept, now, imageLoad(last_kept, at));
        imageStore(last_kept, at, now);
        imageStore(source_kept, at, swept);
    }
}
#endif
#endif
