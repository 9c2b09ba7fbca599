// The parts that are voxelised now, and which of them a group of threads works for.
#ifndef VOXELS_WORK_GLSL
#define VOXELS_WORK_GLSL
#include "state.glsl"

// Part, its first group of prepare.comp and of cross.comp, how many of the former.
layout(std430) readonly buffer VoxelWork { uvec4 voxel_work[]; };

// The last whose first group, `column` of the list, is not beyond `group`.
uvec4 voxel_find_work(uint group, uint column) {
    uint low = 0u, high = voxel.count.y;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (voxel_work[middle][column] <= group) low = middle;
        else high = middle;
    }
    return voxel_work[low];
}

#endif
