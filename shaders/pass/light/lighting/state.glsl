// What the stages of the glow hand on, in buffers of each level: to itself a voxel's numbers as they
// are, and to the sweep, which asks for them in each of the directions, half floats in the order that
// it takes them in: slice by slice, along each of the axes.
#if defined(STAGE_FIRST) || defined(STAGE_SWEEP) || defined(STAGE_RESTRICT) || defined(STAGE_REDUCE) || defined(STAGE_PROLONG)
const int VOXELS = LEVEL_SIZE * LEVEL_SIZE * LEVEL_SIZE; // of the level at hand

vec3 voxel_size() {
    return (box_max - box_min) / float(LEVEL_SIZE);
}

// Metres; what the sweep reads of the medium is per so many, as this fits half floats in any unit.
float voxel_width() {
    vec3 size = voxel_size();
    return max(max(size.x, max(size.y, size.z)), 1e-9);
}

// Where a voxel is in a grid of `size` along each edge; one grid for each colour.
int place_in(ivec3 voxel, int color, int size) {
    return ((color * size + voxel.z) * size + voxel.y) * size + voxel.x;
}

int place_of(ivec3 voxel, int color) {
    return place_in(voxel, color, LEVEL_SIZE);
}

// The same where the slices follow each other on `axis`, and the axis after it is the fastest.
int place_along(int axis, ivec3 voxel) {
    ivec3 at = axis == 0 ? voxel.yzx : axis == 1 ? voxel.zxy : voxel;
    return place_of(at, 0);
}

uint half_pair(float a, float b) {
    return packHalf2x16(clamp(vec2(a, b), -HALF_MOST, HALF_MOST));
}
#endif

#if defined(STAGE_FIRST) || defined(STAGE_RESTRICT) || defined(STAGE_REDUCE) || defined(STAGE_PROLONG)
layout(std430) buffer Source { uvec2 source_slices[]; };

// Moments of the light that is scattered at a voxel, of what the medium takes there: all that the
// sweep wants, its factors included.
void tell_source(ivec3 voxel, int color, float scattered_part, vec4 moments) {
    vec4 told = scattered_part * vec4(moments.x, 3.0 * medium_anisotropy() * moments.yzw);
    uvec2 packed = uvec2(half_pair(told.x, told.y), half_pair(told.z, told.w));
    for (int axis = 0; axis < 3; axis++)
        source_slices[(axis * 3 + color) * VOXELS + place_along(axis, voxel)] = packed;
}
#endif
