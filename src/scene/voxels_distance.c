// Signed distances. Near the surface each triangle is held against the cells around it, so that the
// nearest is known; farther away cells learn it from each other by jump flooding. The sign is that
// of the inside test. No buffer is made before somebody asks.
#include "base/error.h"
#include "scene/voxels_impl.h"

static bool make_buffers(voxels *v, gpu *g) {
    for (voxels_part_buffer i = VOXELS_KEYS; i <= VOXELS_OTHER_SEEDS; i++)
        if (!v->buffers[i] && !voxels_make_buffer(v, g, i, voxels_bytes(v, i)))
            return err_prefix("distances: ");
    return true;
}

static bool flood_once(voxels *v, gpu *g, int32_t apart, bool *other) {
    voxels_images more = {.apart = apart, .other = *other};
    *other = !*other;
    return voxels_dispatch(v, g, VOXELS_FLOOD, v->size, &more);
}

// Rounds of flooding: from half of the box down to neighbours, and these once more, which mends
// most of what the others got wrong. `other`: which of the two buffers is read next.
static bool distance_flood(voxels *v, gpu *g, bool *other) {
    int32_t longest = 1, apart = 1;
    for (int a = 0; a < 3; a++)
        longest = (int32_t)v->size[a] > longest ? (int32_t)v->size[a] : longest;
    while (2 * apart < longest) apart *= 2;
    for (; apart >= 1; apart /= 2)
        if (!flood_once(v, g, apart, other)) return false;
    return flood_once(v, g, 1, other);
}

bool voxels_write_distance(voxels *v, gpu *g, gpu_image *distance) {
    const uint32_t fours[3] = {v->size[0] / 4, v->size[1], v->size[2]};
    bool other = false;
    if (!make_buffers(v, g)) return false;
    gpu_buffer_fill(g, v->buffers[VOXELS_KEYS], UINT32_MAX);
    return voxels_dispatch_groups(v, g, VOXELS_NEAR, voxels_groups(v->number_count)) &&
           voxels_dispatch(v, g, VOXELS_START, v->size, &(voxels_images){.other = !other}) &&
           distance_flood(v, g, &other) &&
           voxels_dispatch(v, g, VOXELS_DISTANCE, fours,
                           &(voxels_images){.image = distance, .other = other});
}
